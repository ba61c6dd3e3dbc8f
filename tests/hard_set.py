#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The hard set: generated meshes on which maps into orbifolds have failed, and faults planted in their embeddings.

  KIND/VARIANT        'embed' and 'verify' end with 0 and the independent checker accepts; or, if faces must become arcs, with 5 and
                      the message says how many and that the mesh is not 3-connected
  octocat/CONES       the same of a real mesh with six limbs, for its own and twelve random choices of cones
  fault/KIND/VARIANT  triangles turned over at every scale that is there, seam vertices exchanged or moved, double covers, offsets that
                      are wrong: 'verify' ends with 5 and the checker refuses
  offsets/KIND/...    the same embedding with the positions of its limb rounded and the rest in offsets is accepted, and every fault refused
  conformality/N      flat faces, one in every N, leave the mean angle distortion above 1 within a quarter of that of the mesh without them

The kinds are the functions of hard_meshes.py. The checker and octocat lie in a folder beside the repository (../shared); what needs them
is left out if it is missing, with a message. Needs numpy.

  hard_set.py --write out --only limb/432    writes the meshes of that name into a folder and prints how to embed them
"""
import argparse
import collections
import fnmatch
import json
import os
import pathlib
import re
import shlex
import sys
import time

import numpy as np

import hard_meshes
import planted_faults
from mesh_files import Ply, read_off_triangles, write_off
from trials import PYTHON, REPOSITORY, Skip, expect, finish, run_command, run_tests

# The quick part: every kind's first, middle and last mesh that is not too large, faults in four embeddings.
QUICK_FACES = 3000

# The meshes in whose embeddings faults are planted: limbs of every length, with and without a seam along them.
FAULT_MESHES = ['limb/532,6', 'limb/225,14', 'limb/44,22', 'limb/532,30', 'limb/532,50', 'several_limbs/432,4,24',
                'several_limbs/2222,4,24', 'branching_limb/55,8,8', 'branching_limb/432,24,20', 'cone_at_tip/22,12', 'cone_at_tip/22,36',
                'cone_at_tip/532,72', 'cone_at_tip/442,36', 'cone_on_branch/432,8,10', 'cone_on_branch/432,24,30',
                'cone_on_branch/2222,24,30', 'cones_in_limb/432,32', 'disk_limb/*432,20', 'disk_limb/3*2,44', 'cone_at_disk_tip/3*2,30',
                'strip/*432,2,10', 'strip/*432,2,30', 'octocat/0']
QUICK_FAULT_MESHES = ['limb/532,6', 'cone_at_tip/22,12', 'cone_on_branch/432,8,10', 'strip/*432,2,10']
# Those whose positions are rounded: the program itself writes offsets for long limbs only.
OFFSET_MESHES = ['limb/532,14', 'cone_at_tip/22,24', 'cone_on_branch/2222,8,10', 'disk_limb/3*2,10', 'strip/*432,2,10']
QUICK_OFFSET_MESHES = ['cone_at_tip/22,24']
ROUNDING, SHORT = 2.0**-43, 1e-2
MALFORMED = {'offset_that_is_no_number', 'offset_of_no_vertex'}  # for which 'verify' may say that the file cannot be read
# The checker uses offsets for the signs of triangles alone, and leaves out seams and angles there: it need not refuse these.
UNSEEN_IN_OFFSETS = {'part_seam', 'lift_off_sphere', 'offset_that_is_no_number', 'offset_of_no_vertex', 'cover_twice_and_claim_it'}


class Suite:
    def __init__(self, options):
        self.options = options
        self.program = pathlib.Path(options.program)
        self.checker = pathlib.Path(options.shared) / 'check' / 'verify_embedding.py'
        self.octocat = pathlib.Path(options.shared) / 'meshes' / 'octocat.off'
        self.threads = max(1, (os.cpu_count() or 1) // options.jobs)
        self.rows = []

    def run(self, commands, *command, codes=None):
        return run_command(commands, *command, timeout=self.options.timeout, codes=codes)

    def meshes(self):
        """What is embedded: name -> a function that makes the mesh."""
        found = hard_meshes.generated()
        if self.octocat.is_file():
            vertices, faces = read_off_triangles(self.octocat)
            faces = [tuple(face) for face in faces.tolist()]
            for k, cones in enumerate(hard_meshes.octocat_choices(faces)):
                found[f'octocat/{k}'] = lambda cones=cones: hard_meshes.HardMesh(vertices, faces, '532', cones)
        return found

    def embed(self, commands, folder, mesh):
        """What the run printed, and the paths of mesh, embedding and report."""
        source, ply, report = folder / 'mesh.off', folder / 'embedding.ply', folder / 'report.json'
        write_off(source, mesh.vertices, mesh.faces)
        done = self.run(commands, self.program, 'embed', source, *embed_options(mesh), '-o', ply, '--report', report, '--threads',
                        self.threads, '--quiet')
        return done, source, ply, report

    # The tests.

    def test_mesh(self, name, make, commands, folder):
        mesh, start = make(), time.monotonic()
        row = {'test': name, 'faces': len(mesh.faces), 'orbifold': mesh.orbifold, 'arcs': mesh.arcs, 'outcome': 'failed'}
        self.rows.append(row)
        try:
            done, source, ply, report_path = self.embed(commands, folder, mesh)
            row.update(exit=done.returncode, seconds=round(time.monotonic() - start, 3))
            report = json.loads(report_path.read_text()) if report_path.is_file() else None
            if report:
                row.update(measured(report))
            self.judge(commands, mesh, done, (source, ply, report_path), report)
            row['outcome'] = 'certified' if done.returncode == 0 else 'named'
            if done.returncode == 0:
                row['shortest_edge'] = shortest_edge(Ply(ply))
        except Exception as error:
            row['reason'] = str(error)
            raise

    def judge(self, commands, mesh, done, paths, report):
        source, ply, report_path = paths
        said = done.stderr.strip()
        expect(done.returncode in ((0, 5) if mesh.arcs else (0,)), f'exit code {done.returncode}: {first_lines(said)}')
        expect(report['certificate']['bijective'] == (done.returncode == 0), f'exit code {done.returncode}, but the report says otherwise')
        if done.returncode == 5:
            expect(mesh.arcs in arcs_named(said), f'{mesh.arcs} faces must become arcs, but the message is: {first_lines(said)}')
            expect('3-connected' in said, f"the message does not say 'not 3-connected': {first_lines(said)}")
        self.run(commands, self.program, 'verify', ply, report_path, source, codes=(done.returncode,))
        if self.checker.is_file():
            checked = self.run(commands, PYTHON, self.checker, source, ply, report_path, codes=(0, 1))
            found = json.loads(checked.stdout)
            expect(found['bijective'] == (done.returncode == 0), f"verify_embedding says bijective: {found['bijective']}; " +
                   '; '.join(found['failures'][:3]))
            expect(done.returncode or not found['failures'], 'verify_embedding: ' + '; '.join(found['failures'][:3]))

    def test_faults(self, name, make, commands, folder):
        mesh = make()
        paths = self.certified(commands, folder, mesh)
        self.plant_faults(name, mesh, paths, folder)

    def test_offsets(self, name, make, commands, folder):
        mesh = make()
        source, ply_path, report_path = self.certified(commands, folder, mesh)
        ply = Ply(ply_path)
        round_with_offsets(ply)
        ply.save(ply_path)
        self.run(commands, self.program, 'verify', ply_path, report_path, source, codes=(0,))
        if self.checker.is_file():
            self.run(commands, PYTHON, self.checker, source, ply_path, report_path, codes=(0,))
        self.plant_faults(name, mesh, (source, ply_path, report_path), folder)

    def test_conformality(self, name, every, commands, folder):
        excess = []
        for mesh in (hard_meshes.smooth_ball('432'), hard_meshes.flat_faces_mesh('432', every)):
            done, _, _, report = self.embed(commands, folder, mesh)
            expect(done.returncode == 0, f'exit code {done.returncode}: {first_lines(done.stderr.strip())}')
            excess.append(json.loads(report.read_text())['distortion']['angle']['mean'] - 1)
        self.rows.append({'test': name, 'excess': excess, 'outcome': 'measured'})
        expect(excess[1] < 1.25 * excess[0], f'mean angle distortion {1 + excess[1]:.4g}, without flat faces {1 + excess[0]:.4g}')

    def certified(self, commands, folder, mesh):
        """Mesh, embedding and report."""
        done, *paths = self.embed(commands, folder, mesh)
        if done.returncode != 0:
            raise Skip(f'not certified (exit code {done.returncode}), so that no fault can be planted')
        return paths

    def plant_faults(self, name, mesh, paths, folder):
        source, ply_path, report_path = paths
        faults = list(planted_faults.LIMB_FAULTS)
        if mesh.orbifold == '22':
            faults += [planted_faults.cover_twice, planted_faults.cover_twice_and_claim_it]
        planted, accepted = [], []
        for fault in faults:
            ply, report = Ply(ply_path), json.loads(report_path.read_text())
            try:
                fault(ply, report)
            except Skip:
                continue
            planted.append(fault.__name__)
            accepted += [f'{fault.__name__} is accepted by {judge}' for judge in self.accepting(fault, ply, report, source, folder)]
        self.rows.append({'test': name, 'planted': planted, 'accepted': accepted, 'outcome': 'failed' if accepted else 'refused'})
        expect(planted, 'no fault could be planted')
        expect(not accepted, '; '.join(accepted))

    def accepting(self, fault, ply, report, source, folder):
        """The judges that accept the faulty embedding, with their exit codes."""
        faulty, faulty_report = folder / 'faulty.ply', folder / 'faulty.json'
        ply.save(faulty)
        faulty_report.write_text(json.dumps(report))
        code = self.run([], self.program, 'verify', faulty, faulty_report, source).returncode
        if code not in ((1, 3, 5) if fault.__name__ in MALFORMED else (5,)):
            yield f'verify (exit code {code})'
        unseen = len(ply.offset) and fault.__name__ in UNSEEN_IN_OFFSETS
        if self.checker.is_file() and not unseen:
            code = self.run([], PYTHON, self.checker, source, faulty, faulty_report).returncode
            if code != 1:
                yield f'verify_embedding (exit code {code})'

    def tests(self, quick):
        meshes = self.meshes()
        found = {}
        for prefix, test, names in (('fault', self.test_faults, QUICK_FAULT_MESHES if quick else FAULT_MESHES),
                                    ('offsets', self.test_offsets, QUICK_OFFSET_MESHES if quick else OFFSET_MESHES)):
            found.update((f'{prefix}/{name}', bound(test, f'{prefix}/{name}', meshes[name])) for name in names if name in meshes)
        for every in hard_meshes.EVERY[::5 if quick else 1]:
            found[f'conformality/{every}'] = bound(self.test_conformality, f'conformality/{every}', every)
        for name in quick_names(meshes) if quick else meshes:
            found[name] = bound(self.test_mesh, name, meshes[name])
        return found


def round_with_offsets(ply):
    """The same positions: near short edges doubles that are multiples of ROUNDING, and the rest in a row of offsets."""
    source = ply.vertex['source_vertex']
    short = planted_faults.longest_edges(ply) < SHORT
    rounded = np.flatnonzero(np.isin(source, source[ply.faces[short]]))
    positions = ply.positions
    stored = positions.copy()
    stored[rounded] = np.round(positions[rounded] / ROUNDING) * ROUNDING
    ply.positions = stored
    ply.offset = np.zeros(len(rounded), ply.offset.dtype)
    ply.offset['vertex'] = rounded
    for k, axis in enumerate(('dx', 'dy', 'dz')):
        ply.offset[axis] = (positions - stored)[rounded, k]


def bound(test, *arguments):
    return lambda commands, folder: test(*arguments, commands, folder)


def quick_names(meshes):
    """Of every kind the first, the middle and the last mesh; octocat with its own cones."""
    of_kind = collections.OrderedDict()
    for name, make in meshes.items():
        if name.startswith('octocat/') or len(make().faces) <= QUICK_FACES:
            of_kind.setdefault(name.split('/')[0], []).append(name)
    for names in of_kind.values():
        chosen = names[:1] if names[0].startswith('octocat/') else {names[k]: None for k in (0, len(names) // 2, len(names) - 1)}
        yield from chosen


def embed_options(mesh):
    return ['--orbifold', mesh.orbifold, '--cones', mesh.cones]


def first_lines(text):
    return ' | '.join(text.splitlines()[:3]) or '(nothing)'


def arcs_named(said):
    """The numbers of faces of which lines of a message say that they must become arcs."""
    return {int(number) for number in re.findall(r'(\d+)(?: of (?:the )?\d+)? faces?\b[^\n]*?\barcs?\b', said)}


def measured(report):
    weights = report['weights']
    return {'iterations': report['iterations'], 'termination': report['termination'], 'certified': report['certificate']['bijective'],
            'nonpositive_faces': len(report['certificate']['nonpositive_faces']), 'weights': weights['kind'],
            'kept_faces': len(weights.get('kept_faces') or []), 'moved_vertices': len(report.get('moved_vertices') or []),
            'angle_distortion': report['distortion']['angle']['mean']}


def shortest_edge(ply):
    """The longest edge of the smallest face, roughly the root of its area."""
    return float(planted_faults.longest_edges(ply).min())


def write_meshes(folder, chosen):
    """Writes generated meshes, functions by name, as OFF files; (path, orbifold, cones) of each."""
    folder = pathlib.Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in chosen.items():
        mesh, path = make(), folder / (re.sub(r'[/,]', '_', name).replace('*', 'star') + '.off')
        write_off(path, mesh.vertices, mesh.faces)
        yield path, mesh.orbifold, mesh.cones


def print_kinds(rows):
    kinds = collections.OrderedDict()
    for row in rows:
        kinds.setdefault(row['test'].rsplit('/', 1)[0] if not row['test'].startswith('fault/') else 'fault', collections.Counter())[
            row['outcome']] += 1
    for name, outcomes in sorted(kinds.items()):
        print(f"{name}: {', '.join(f'{count} {outcome}' for outcome, count in sorted(outcomes.items()))}")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    extent = parser.add_mutually_exclusive_group()
    extent.add_argument('--quick', action='store_true', help='a part that takes less than a minute on two cores')
    extent.add_argument('--all', action='store_true', help='everything (the default)')
    parser.add_argument('--only', default='*', metavar='PATTERN', help='only tests whose name has this in it or matches it')
    parser.add_argument('--list', action='store_true', help='print the names of the tests')
    parser.add_argument('--write', metavar='FOLDER', help='write the meshes there and run nothing')
    parser.add_argument('--kinds', action='store_true', help='print at the end how many of each kind are certified')
    parser.add_argument('--jobs', type=int, default=os.cpu_count() or 1, metavar='N', help='tests at the same time')
    parser.add_argument('--timeout', type=float, default=120, metavar='SECONDS', help='for one run of a command')
    parser.add_argument('--json', metavar='FILE', help='write a line of JSON per test: exit code, outcome, seconds, ...')
    parser.add_argument('--summary', metavar='FILE', help="write 'passed failed skipped' there")
    parser.add_argument('--program', default=str(REPOSITORY / 'build' / 'orbitutte'), metavar='FILE')
    parser.add_argument('--shared', default=str(REPOSITORY.parent / 'shared'), metavar='FOLDER', help='with meshes/ and check/')
    options = parser.parse_args()
    options.jobs = max(1, options.jobs)
    return options


def matching(named, pattern):
    """The items whose name has the pattern in it, stars as they are, for symbols have them; or whose name matches it."""
    return {name: item for name, item in named.items() if pattern in name or fnmatch.fnmatchcase(name, pattern)}


def report_outcome(outcome):
    if outcome.skip:
        print(f'skipped {outcome.name}: {outcome.skip}', flush=True)
    if outcome.failure:
        print(f'FAILED {outcome.name} ({outcome.seconds:.1f} s): {outcome.failure}', flush=True)


def main():
    options = parse_arguments()
    suite = Suite(options)
    if options.write:
        for path, orbifold, cones in write_meshes(options.write, matching(suite.meshes(), options.only)):
            print(shlex.join(['orbitutte', 'embed', str(path), '--orbifold', orbifold, '--cones', cones]))
        return 0
    chosen = matching(suite.tests(options.quick), options.only)
    if options.list:
        print('\n'.join(chosen))
        return 0
    if not chosen or not os.access(options.program, os.X_OK):
        print('hard_set: ' + ('no such test' if not chosen else f'{options.program} is not there; build first'))
        return finish(options.summary, 0, 1, 0)
    if not suite.checker.is_file():
        print(f'hard_set: without the independent checker and octocat, for they are not in {options.shared} (option --shared)')
    start, failed, skipped = time.monotonic(), 0, 0
    for outcome in run_tests(chosen, options.jobs):
        report_outcome(outcome)
        failed += bool(outcome.failure)
        skipped += bool(outcome.skip)
    if options.json:
        rows = sorted(suite.rows, key=lambda row: row['test'])
        pathlib.Path(options.json).write_text(''.join(json.dumps(row) + '\n' for row in rows))
    if options.kinds:
        print_kinds(suite.rows)
    print(f'hard_set: {len(chosen)} tests in {time.monotonic() - start:.0f} s')
    return finish(options.summary, len(chosen) - failed - skipped, failed, skipped)


if __name__ == '__main__':
    sys.exit(main())
