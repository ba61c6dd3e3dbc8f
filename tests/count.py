#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Prints how many tests of a run of ctest passed, failed and were skipped: 'passed failed skipped'.

ctest sees the unit tests as a few programs that run many tests each; here each of them counts.
usage: count.py BUILD     after ctest --test-dir BUILD --output-junit BUILD/ctest.xml
"""
import collections
import pathlib
import sys
import xml.etree.ElementTree as ElementTree


def outcome(case):
    """Of a test case, as ctest and GoogleTest write it."""
    if case.find('failure') is not None or case.get('status') == 'fail':
        return 'failed'
    if case.find('skipped') is not None or case.get('result') in ('skipped', 'suppressed') or case.get('status') in ('notrun', 'disabled'):
        return 'skipped'
    return 'passed'


def outcomes(file):
    return collections.Counter(outcome(case) for case in ElementTree.parse(file).iter('testcase'))


def of_unit_tests(case, file):
    """Of the tests in one program. A program that ends before it has written what they gave counts as one that failed."""
    counts = outcomes(file) if file.exists() else collections.Counter()
    if not counts['failed'] and (outcome(case) == 'failed' or not counts):
        counts['failed'] = 1
    return counts


def main(build):
    counts = collections.Counter()
    for case in ElementTree.parse(build / 'ctest.xml').iter('testcase'):
        if case.get('name').startswith('unit_tests.'):
            counts += of_unit_tests(case, build / 'tests' / f'{case.get("name")}.xml')
        else:
            counts[outcome(case)] += 1
    print(counts['passed'], counts['failed'], counts['skipped'])


main(pathlib.Path(sys.argv[1]))
