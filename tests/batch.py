#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Batches as their users meet them: manifests, limits, processes that are killed, and what is left to run after that.

usage: tests/batch.py PROGRAM [UNITTEST OPTION ...]

Needs nothing but the built program, which makes the meshes itself.
"""
import csv
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

PROGRAM = ''
IS_A_FILE, IS_WRONG, IS_UNSUITABLE, IS_NOT_CONVERGED = 1, 2, 3, 4


def children_of(process):
    return [int(child) for child in pathlib.Path(f'/proc/{process}/task/{process}/children').read_text().split()]


class Batch(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.meshes_scratch = tempfile.TemporaryDirectory(prefix='orbitutte-batch-meshes-')
        cls.meshes = pathlib.Path(cls.meshes_scratch.name)
        for name, faces in [('small', 300), ('large', 60000)]:
            subprocess.run([PROGRAM, 'sample', '--faces', str(faces), '-o', f'{name}.off'], cwd=cls.meshes, check=True, stderr=subprocess.DEVNULL)
        (cls.meshes / 'open.obj').write_text('v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 1 2 4\nf 1 2 4\n')

    @classmethod
    def tearDownClass(cls):
        cls.meshes_scratch.cleanup()

    def setUp(self):
        self.scratch = tempfile.TemporaryDirectory(prefix='orbitutte-batch-')
        self.folder = pathlib.Path(self.scratch.name)

    def tearDown(self):
        self.scratch.cleanup()

    def manifest(self, header, *rows, name='jobs.csv'):
        (self.folder / name).write_text('\n'.join([header, *rows]) + '\n')
        return name

    def many(self, count, mesh='small', **options):
        rows = [f'{self.meshes}/{mesh}.off,job{k:03},extremities,{k}' for k in range(count)]
        return self.manifest('mesh,name,cones,cut-seed', *rows, **options)

    def run_batch(self, *arguments):
        return subprocess.run([PROGRAM, 'batch', *map(str, arguments)], cwd=self.folder, text=True, stdin=subprocess.DEVNULL, capture_output=True)

    def expect(self, code, *arguments, says=()):
        done = self.run_batch(*arguments)
        self.assertEqual(done.returncode, code, f'{arguments}: {done.stderr}')
        for pattern in [says] if isinstance(says, str) else says:
            self.assertRegex(done.stderr, pattern)
        return done

    def records(self, folder='out', log='jobs.jsonl'):
        return [json.loads(line) for line in (self.folder / folder / log).read_text().splitlines()]

    def by_name(self, folder='out'):
        return {record['name']: record for record in self.records(folder)}


class Results(Batch):
    def test_every_job_has_a_record_its_files_and_a_row(self):
        self.manifest('mesh,orbifold,cones,name', f'{self.meshes}/small.off,432,extremities,', f'{self.meshes}/small.off,222,,other', f'{self.meshes}/open.obj,,,')
        done = self.expect(IS_UNSUITABLE, 'jobs.csv', '-o', 'out', says=['open: unsuitable_mesh: ', '3 jobs: 2 certified, 1 unsuitable_mesh; see out/summary.html'])
        self.assertEqual(done.stdout, '')
        records = self.by_name()
        self.assertEqual({name: record['outcome'] for name, record in records.items()}, {'small': 'certified', 'other': 'certified', 'open': 'unsuitable_mesh'})
        self.assertEqual(records['open']['exit_code'], IS_UNSUITABLE)
        self.assertEqual(records['open']['attempts'], 1, 'a result is not tried again')
        self.assertEqual(records['other']['numbers']['orbifold'], '222')
        for name in ('small', 'other'):
            report = json.loads((self.folder / f'out/{name}.json').read_text())
            self.assertTrue(report['certificate']['bijective'])
            self.assertEqual(report['environment']['threads'], 1)
            self.assertEqual(records[name]['numbers']['sigma'], report['distortion']['sigma'])
            verified = subprocess.run([PROGRAM, 'verify', f'out/{name}.ply', f'out/{name}.json', self.meshes / 'small.off'], cwd=self.folder, capture_output=True)
            self.assertEqual(verified.returncode, 0)
        with open(self.folder / 'out/summary.csv', newline='') as table:
            rows = list(csv.DictReader(table))
        self.assertEqual([row['name'] for row in rows], ['small', 'other', 'open'], 'in the order of the manifest')
        self.assertEqual([row['exit_code'] for row in rows], ['0', '0', '3'])
        page = (self.folder / 'out/summary.html').read_text()
        self.assertIn('href="other.ply"', page)
        self.assertNotIn('href="open.ply"', page)
        self.assertEqual(sorted(path.name for path in (self.folder / 'out').iterdir()),
                         ['jobs.jsonl', 'other.json', 'other.ply', 'small.json', 'small.ply', 'summary.csv', 'summary.html'])

    def test_results_are_the_same_bytes_for_any_number_of_processes(self):
        self.many(6)
        for jobs in (1, 3):
            self.expect(0, 'jobs.csv', '-o', f'out{jobs}', '--jobs', jobs)
        for k in range(6):
            one, three = ((self.folder / f'out{jobs}/job{k:03}.ply').read_bytes() for jobs in (1, 3))
            self.assertEqual(one, three)
            reports = [json.loads((self.folder / f'out{jobs}/job{k:03}.json').read_text()) for jobs in (1, 3)]
            for report in reports:
                del report['timings'], report['peak_memory_bytes']
            self.assertEqual(*reports)

    def test_meshes_and_patterns_take_common_options(self):
        for name in ('a', 'b'):
            (self.folder / f'{name}.off').write_bytes((self.meshes / 'small.off').read_bytes())
        self.expect(0, '*.off', '-o', 'out', '--orbifold', '332', '--cones', 'extremities')
        self.assertEqual({record['numbers']['orbifold'] for record in self.records()}, {'332'})
        self.expect(0, 'a.off', 'b.off', 'b.off', '-o', 'other', '--cones=extremities')
        self.assertEqual(sorted(self.by_name('other')), ['a', 'b', 'b-2'])

    def test_a_row_goes_before_common_options(self):
        self.manifest('mesh,orbifold', f'{self.meshes}/small.off,222', f'{self.meshes}/small.off,')
        self.expect(0, 'jobs.csv', '-o', 'out', '--orbifold', '332', '--cones', 'extremities')
        records = self.by_name()
        self.assertEqual([records[name]['numbers']['orbifold'] for name in ('small', 'small-2')], ['222', '332'])

    def test_paths_are_relative_to_the_manifest(self):
        (self.folder / 'data').mkdir()
        (self.folder / 'data/x.off').write_bytes((self.meshes / 'small.off').read_bytes())
        self.manifest('mesh', 'x.off', name='data/jobs.csv')
        self.expect(0, 'data/jobs.csv', '-o', 'out')
        # started elsewhere it is the same batch
        done = subprocess.run([PROGRAM, 'batch', '../data/jobs.csv', '-o', '.'], cwd=self.folder / 'out', capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)
        self.assertIn('1 of 1 jobs are done already', done.stderr)


class Faults(Batch):
    def assert_nothing_ran(self):
        self.assertFalse((self.folder / 'out').exists())

    def test_a_bad_manifest_names_row_and_column(self):
        mesh = self.meshes / 'small.off'
        for header, rows, pattern in [
                ('mesh,clamp', [f'{mesh},1', f'{mesh},much'], r"jobs\.csv: line 3 \(job 1\), column 'clamp': .*much"),
                ('mesh,cones', [f'{mesh},1;2'], r"jobs\.csv: line 2 \(job 0\), --cones is '1;2'"),
                ('mesh,orbifold', [f'{mesh},77777777x'], r'jobs\.csv: line 2 \(job 0\), .*77777777x'),
                ('mesh,weights', [f'{mesh},heavy'], r"jobs\.csv: line 2 \(job 0\), --weights is 'heavy'"),
                ('mesh,angles', [f'{mesh},pi'], r"jobs\.csv: line 2 \(job 0\), --angles"),
                ('mesh,output', [f'{mesh},x'], r"jobs\.csv: line 1: 'output' is no column"),
                ('mesh,name', [f'{mesh},a', f'{mesh},a'], r"line 3 \(job 1\), column 'name': line 2 \(job 0\) has the name 'a'")]:
            with self.subTest(header):
                self.manifest(header, *rows)
                done = self.expect(IS_WRONG, 'jobs.csv', '-o', 'out', says=pattern)
                self.assertEqual(done.stderr.count('\n'), 1)
                self.assert_nothing_ran()

    def test_missing_files_are_named_before_anything_runs(self):
        self.manifest('mesh,weights-file', f'{self.meshes}/small.off,', 'gone.off,', f'{self.meshes}/small.off,gone.txt')
        self.expect(IS_A_FILE, 'jobs.csv', '-o', 'out', says=[r'2 of the files cannot be read, so nothing was run: .*line 3 \(job 1\): gone\.off: No such file', r'line 4 \(job 2\): gone\.txt'])
        self.assert_nothing_ran()
        self.expect(IS_WRONG, '*.nothing', '-o', 'out', says="no file is named as in '\\*.nothing'")
        self.expect(IS_WRONG, self.meshes / 'small.off', '-o', 'out', '--shard', '3/3', says="--shard is '3/3'")
        self.expect(IS_WRONG, self.meshes / 'small.off', '-o', 'out', '--memory-limit', '2', says="--memory-limit is '2'")
        self.expect(IS_WRONG, self.meshes / 'small.off', '-o', 'out', '--job', '1', says='--job is 1, but there are 1 jobs')
        self.assert_nothing_ran()

    def test_another_job_of_the_same_name_is_refused(self):
        mesh = self.meshes / 'small.off'
        self.expect(0, mesh, '-o', 'out', '--cones', 'extremities')
        self.expect(IS_WRONG, mesh, '-o', 'out', '--cones', 'best', says="results of a job 'small' with another mesh or other options .*--cones=extremities")


class Limits(Batch):
    def test_a_job_out_of_time_is_tried_twice_and_takes_no_other_with_it(self):
        self.manifest('mesh,cones', f'{self.meshes}/large.off,best', f'{self.meshes}/small.off,extremities')
        self.expect(IS_A_FILE, 'jobs.csv', '-o', 'out', '--time-limit', '0.15', says='out_of_time')
        records = self.by_name()
        self.assertEqual(records['large']['outcome'], 'out_of_time')
        self.assertEqual(records['large']['attempts'], 2)
        self.assertEqual([path.name for path in (self.folder / 'out').iterdir() if path.name.startswith(('large', '.'))], [])
        self.expect(0, 'jobs.csv', '-o', 'out', '--again')
        self.assertEqual(self.by_name()['large']['outcome'], 'certified')

    @unittest.skipUnless(sys.platform == 'linux', 'only there memory is looked at')
    def test_a_job_out_of_memory_is_named_so(self):
        self.manifest('mesh,cones', f'{self.meshes}/large.off,best', f'{self.meshes}/small.off,extremities')
        self.expect(IS_A_FILE, 'jobs.csv', '-o', 'out', '--memory-limit', '10M', '--jobs', 1, says='memory')
        self.assertEqual(self.by_name()['large']['outcome'], 'out_of_memory')
        self.expect(0, 'jobs.csv', '-o', 'out', '--memory-limit', '1G', '--again')
        self.assertEqual({record['outcome'] for record in self.by_name().values()}, {'certified'})

    @unittest.skipUnless(sys.platform == 'linux', 'finds the processes in /proc')
    def test_a_process_has_one_thread(self):
        self.many(2, 'large')
        threads, seen = set(), set()
        with subprocess.Popen([PROGRAM, 'batch', 'jobs.csv', '-o', 'out', '--jobs', '2'], cwd=self.folder, stderr=subprocess.DEVNULL) as batch:
            while batch.poll() is None:
                for child in children_of(batch.pid):
                    try:
                        threads.add(len(list(pathlib.Path(f'/proc/{child}/task').iterdir())))
                        seen.add(child)
                    except OSError:
                        continue  # it has just ended
                time.sleep(0.005)
        self.assertEqual((batch.returncode, len(seen)), (0, 2))
        self.assertEqual(threads, {1})

    @unittest.skipUnless(sys.platform == 'linux', 'finds the processes in /proc')
    def test_a_process_that_is_killed_takes_only_its_job_with_it(self):
        self.many(2, 'large')
        with subprocess.Popen([PROGRAM, 'batch', 'jobs.csv', '-o', 'out', '--jobs', '1'], cwd=self.folder, stderr=subprocess.DEVNULL) as batch:
            killed = set()
            while batch.poll() is None and len(killed) < 3:
                for child in children_of(batch.pid):
                    if child not in killed:
                        os.kill(child, signal.SIGKILL)
                        killed.add(child)
            batch.wait()
        records = self.by_name()
        # job 0, job 1, then job 0 again, which is left with its record; job 1 succeeds at its second try
        self.assertEqual(records['job000']['outcome'], 'crashed')
        self.assertEqual(records['job000']['signal'], signal.SIGKILL)
        self.assertEqual([records[name]['attempts'] for name in ('job000', 'job001')], [2, 2])
        self.assertEqual(records['job001']['outcome'], 'certified')
        self.assertEqual(batch.returncode, IS_A_FILE)


class Resuming(Batch):
    def assert_complete(self, count, folder='out'):
        self.assertEqual(sorted(record['name'] for record in self.records(folder)), [f'job{k:03}' for k in range(count)])

    @unittest.skipUnless(sys.platform == 'linux', 'only there do jobs end with the batch')
    def test_a_batch_that_was_killed_goes_on_where_it_was(self):
        count = 40
        self.many(count)
        log = self.folder / 'out/jobs.jsonl'
        killed = 0
        for wanted in (5, 15):
            with subprocess.Popen([PROGRAM, 'batch', 'jobs.csv', '-o', 'out'], cwd=self.folder, stderr=subprocess.DEVNULL) as batch:
                while batch.poll() is None and not (log.exists() and log.read_bytes().count(b'\n') >= wanted):
                    time.sleep(0.002)
                children = children_of(batch.pid) if batch.poll() is None else []
                killed += batch.poll() is None
                batch.kill()
            for child in children:  # they end with it
                for _ in range(500):
                    if not pathlib.Path(f'/proc/{child}').exists():
                        break
                    time.sleep(0.01)
                self.assertFalse(pathlib.Path(f'/proc/{child}').exists())
        self.assertEqual(killed, 2)
        before = self.records()
        self.assertLess(len(before), count)
        with open(log, 'a') as file:
            file.write('{"job": 39, "na')  # as if it had been killed while it wrote
        (self.folder / 'out/.orbitutte-1-0.tmp').write_text('half')
        self.expect(0, 'jobs.csv', '-o', 'out', says=f'{len(before)} of {count} jobs are done already')
        self.assert_complete(count)
        self.assertEqual(self.records()[:len(before)], before, 'what was done was not done again')
        self.assertFalse((self.folder / 'out/.orbitutte-1-0.tmp').exists())
        self.expect(0, 'jobs.csv', '-o', 'whole', '--jobs', 1)
        for k in range(count):
            self.assertEqual(*((self.folder / folder / f'job{k:03}.ply').read_bytes() for folder in ('out', 'whole')))

    def test_a_second_batch_in_the_same_folder_is_refused_while_the_first_is_at_work(self):
        self.many(2, 'large')
        with subprocess.Popen([PROGRAM, 'batch', 'jobs.csv', '-o', 'out', '--jobs', '1'], cwd=self.folder, stderr=subprocess.DEVNULL) as batch:
            while not (self.folder / 'out/jobs.jsonl').exists():
                time.sleep(0.002)
            time.sleep(0.05)
            self.expect(IS_A_FILE, 'jobs.csv', '-o', 'out', says='at work')
            self.assertEqual(batch.wait(), 0)
        self.assert_complete(2)

    def test_parts_make_one_batch(self):
        self.many(7)
        for part in range(3):
            self.expect(0, 'jobs.csv', '-o', 'out', '--shard', f'{part}/3')
        self.assertEqual([len(self.records(log=f'jobs-{part}-of-3.jsonl')) for part in range(3)], [3, 2, 2])
        self.assertFalse((self.folder / 'out/summary.csv').exists())
        self.expect(0, 'jobs.csv', '-o', 'out', '--summary', says=['7 of 7 jobs are done', '7 jobs: 7 certified'])
        self.assertEqual((self.folder / 'out/summary.csv').read_text().count('\n'), 8)

    def test_a_summary_of_an_unfinished_batch_says_so(self):
        self.many(4)
        self.expect(0, 'jobs.csv', '-o', 'out', '--shard', '0/2')
        self.expect(IS_A_FILE, 'jobs.csv', '-o', 'out', '--summary')
        self.assertIn('2 have not run yet', (self.folder / 'out/summary.html').read_text())

    def test_jobs_can_be_listed_and_run_one_by_one(self):
        self.many(2)
        listed = [json.loads(line) for line in self.expect(0, 'jobs.csv', '-o', 'out', '--list').stdout.splitlines()]
        self.assertEqual([(job['job'], job['name'], job['done']) for job in listed], [(0, 'job000', False), (1, 'job001', False)])
        record = json.loads(self.expect(0, 'jobs.csv', '-o', 'out', '--job', 1).stdout)
        self.assertEqual((record['name'], record['outcome']), ('job001', 'certified'))
        self.assertTrue((self.folder / 'out/job001.ply').exists())
        self.assertFalse((self.folder / 'out/jobs.jsonl').exists())


if __name__ == '__main__':
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    PROGRAM = os.path.abspath(sys.argv.pop(1))
    unittest.main()
