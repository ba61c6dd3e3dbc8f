# SPDX-License-Identifier: MIT
"""Named tests that run the program's commands, several at a time; a test that fails shows the commands that repeat it.

A test is a function of a list, which collects its commands, and of a folder of its own. It raises Failure or Skip.
"""
import collections
import concurrent.futures
import pathlib
import shlex
import subprocess
import sys
import tempfile
import time

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
PYTHON = sys.executable or '/usr/bin/python3'

Outcome = collections.namedtuple('Outcome', 'name seconds failure skip commands')


class Failure(Exception):
    """A test does not hold; the text says what."""


class Skip(Exception):
    """A test cannot be run; the text says why."""


def expect(holds, text):
    if not holds:
        raise Failure(text)


def run_command(commands, *command, timeout, codes=(0,)):
    """Runs the command, adds it to `commands`, and fails unless it ends with one of the codes (any code if that is None)."""
    command = [str(word) for word in command]
    commands.append(shlex.join(command))
    try:
        result = subprocess.run(command, capture_output=True, text=True, errors='replace', timeout=timeout,
                                stdin=subprocess.DEVNULL)
    except subprocess.TimeoutExpired:
        raise Failure(f'no end after {timeout} s') from None
    if codes is not None and result.returncode not in codes:
        tail = (result.stderr + result.stdout).strip().splitlines()[-6:]
        raise Failure(f"exit code {result.returncode}, not {' or '.join(map(str, codes))}: " + ' | '.join(tail))
    return result


def run_test(name, test):
    commands, start, failure, skip = [], time.monotonic(), None, None
    with tempfile.TemporaryDirectory(prefix='orbitutte-') as folder:
        folder = pathlib.Path(folder)
        try:
            test(commands, folder)
        except Skip as reason:
            skip = str(reason)
        except Failure as reason:
            failure = str(reason)
        except Exception as error:  # a file that is missing or malformed is a failure of this test only
            failure = f'{type(error).__name__}: {error}'
        commands = [command.replace(str(folder) + '/', 'out/') for command in commands]
    return Outcome(name, time.monotonic() - start, failure, skip, commands)


def run_tests(tests, jobs):
    """Runs tests, a dictionary from names, and yields each Outcome as it comes."""
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        futures = [pool.submit(run_test, name, test) for name, test in tests.items()]
        for done, future in enumerate(concurrent.futures.as_completed(futures), 1):
            if sys.stderr.isatty():
                print(f'\r\033[K{done}/{len(tests)} {future.result().name}', end='\r', file=sys.stderr, flush=True)
            yield future.result()
    if sys.stderr.isatty():
        print('\r\033[K', end='', file=sys.stderr)


def finish(summary, passed, failed, skipped):
    """Prints the closing line, writes the three numbers to the file `summary` if one is named, and returns the exit code."""
    if summary:
        pathlib.Path(summary).write_text(f'{passed} {failed} {skipped}\n')
    print(f'{passed} passed, {failed} failed, {skipped} skipped')
    return 1 if failed else 0
