#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Acceptance test: the built program on real meshes, judged by an independent checker.

The meshes, their marked vertices, the reference results and the checker lie in a folder beside the repository (../shared) that
is no part of it: where it is missing, everything is skipped. Needs numpy.

  embed         every family on every mesh: verify_embedding.py and 'orbitutte verify' accept; exit 0 exactly when certified
  tile          the tiling of one embedding of each family is a closed surface of Euler characteristic 2, counterclockwise
  render        a picture is a PNG of the size asked for, the same bytes twice; a plot is SVG; what makes no sense is refused
  golden        the reference's energies to 1e-9 (relative) and edge lengths to 1e-7, with the reference's weights
  cut-seed      20 cuts of the same mesh: no edge length changes by more than 1e-8
  repeat        two runs give the same bytes, but for times and memory in the report
  fault         'orbitutte verify' rejects, with exit code 5, embeddings and reports that were tampered with
"""
import argparse
import collections
import concurrent.futures
import json
import os
import pathlib
import shlex
import struct
import subprocess
import sys
import tempfile
import time
import xml.etree.ElementTree

import numpy as np

REPOSITORY = pathlib.Path(__file__).resolve().parent.parent
PYTHON = sys.executable or '/usr/bin/python3'

SPHERE_SIGNATURES = ['532', '432', '332', '222', '223', '224', '228', '2,2,12', '22', '33', '44', '88', '12,12']
DISK_SIGNATURES = ['*' + signature for signature in SPHERE_SIGNATURES]
MIXED_SIGNATURES = ['3*2', '2*2', '2*3', '2*5', '2*8', '2*', '3*', '5*', '8*']  # a cone inside a disk
ONE_OF_EACH_FAMILY = ['532', '432', '332', '223', '44', '*532', '*432', '*332', '*228', '*33'] + MIXED_SIGNATURES

# The quick part: every family, each hard kind of mesh, golden runs on the smallest meshes.
QUICK_MESHES = {'my_man_maxp.off': SPHERE_SIGNATURES, 'thingi_62415.obj': SPHERE_SIGNATURES, 'itokawa.off': ['532', '22'],
                'octocat.off': ['532'], 'camelhead.off': DISK_SIGNATURES[::2] + ['*33'] + MIXED_SIGNATURES[::2],
                'fandisk.off': ['*432', '2*3', '8*']}
QUICK_GOLDEN = ['my_man_maxp', 'fandisk_star243']
QUICK_SEEDS = {('my_man_maxp.off', '532'): 6, ('camelhead.off', '3*2'): 4, ('camelhead.off', '5*'): 4}
ALL_SEEDS = {('my_man_maxp.off', '532'): 20, ('david_50k.off', '532'): 20, ('camelhead.off', '3*2'): 20,
             ('fandisk.off', '2*5'): 20, ('camelhead.off', '5*'): 20, ('fandisk.off', '2*'): 20}

# May fail to be bijective in double precision, saying so (exit code 5).
KNOWN_HARD = {'octocat.off'}

MAX_ITERATIONS_THREE_CONES = 14

REPORT_KEYS = {
    '': ['schema', 'mesh', 'orbifold', 'cones', 'seams', 'weights', 'energy', 'iterations', 'evaluations', 'termination',
         'gradient_norm', 'history', 'certificate', 'distortion', 'timings', 'peak_memory_bytes', 'environment'],
    'mesh': ['path', 'vertices', 'faces', 'topology'],
    'orbifold': ['signature', 'group_order'],
    'weights': ['kind', 'clamp', 'clamped_edges'],
    'certificate': ['bijective', 'nonpositive_faces', 'signed_area', 'expected_area', 'max_edge_length', 'max_seam_residual',
                    'checks'],
    'distortion': ['area', 'angle', 'histogram'],
    'timings': ['read', 'validate', 'weights', 'cut', 'factorize', 'initialize', 'optimize', 'certify', 'write', 'total'],
    'environment': ['version', 'commit', 'backend', 'blas', 'threads', 'input_sha256'],
}


class Failure(Exception):
    """A test does not hold; the text says what."""


def expect(holds, text):
    if not holds:
        raise Failure(text)


# Binary little-endian PLY files as the program writes them: scalar vertex properties, triangles.

PLY_TYPES = {'char': 'i1', 'uchar': 'u1', 'short': '<i2', 'ushort': '<u2', 'int': '<i4', 'uint': '<u4', 'float': '<f4',
             'double': '<f8', 'int8': 'i1', 'uint8': 'u1', 'int16': '<i2', 'uint16': '<u2', 'int32': '<i4', 'uint32': '<u4',
             'float32': '<f4', 'float64': '<f8'}


class Ply:
    """The file's header as it is, and its vertices and faces as structured arrays."""

    def __init__(self, path):
        data = pathlib.Path(path).read_bytes()
        self.header = data[:data.index(b'end_header\n') + len(b'end_header\n')]
        elements = []
        for line in self.header.decode().splitlines():
            words = line.split()
            if words[0] == 'format':
                expect(words[1] == 'binary_little_endian', f'{path}: format {words[1]}')
            elif words[0] == 'element':
                elements.append((words[1], int(words[2]), []))
            elif words[:2] == ['property', 'list']:
                elements[-1][2].extend([('corners', PLY_TYPES[words[2]]), (words[4], PLY_TYPES[words[3]], 3)])
            elif words[0] == 'property':
                elements[-1][2].append((words[2], PLY_TYPES[words[1]]))
        expect([name for name, _, _ in elements] == ['vertex', 'face'], f'{path}: elements {[e[0] for e in elements]}')
        offset, arrays = len(self.header), []
        for _, count, properties in elements:
            arrays.append(np.frombuffer(data, np.dtype(properties), count, offset).copy())
            offset += arrays[-1].nbytes
        expect(offset == len(data), f'{path}: {len(data) - offset} bytes too many')
        self.vertex, self.face = arrays
        expect((self.face['corners'] == 3).all(), f'{path}: not all faces are triangles')
        self.faces = self.face['vertex_indices'].astype(np.int64)

    @property
    def positions(self):
        return np.stack([self.vertex[axis] for axis in 'xyz'], 1)

    @positions.setter
    def positions(self, values):
        for k, axis in enumerate('xyz'):
            self.vertex[axis] = values[:, k]

    def save(self, path):
        pathlib.Path(path).write_bytes(self.header + self.vertex.tobytes() + self.face.tobytes())


def half_edges(faces):
    return np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])


def spherical_distance(p, q):
    return np.arctan2(np.linalg.norm(np.cross(p, q), axis=1), (p * q).sum(1))


def edge_lengths(ply):
    """The undirected edges of the uncut mesh as keys (i * 2^32 + j, i < j), ascending, and the length of each on the sphere."""
    ends = half_edges(ply.faces)
    source = np.sort(ply.vertex['source_vertex'].astype(np.int64)[ends], axis=1)
    keys, first = np.unique((source[:, 0] << 32) + source[:, 1], return_index=True)
    return keys, spherical_distance(ply.positions[ends[first, 0]], ply.positions[ends[first, 1]])


def normalized(rows):
    return rows / np.linalg.norm(rows, axis=-1, keepdims=True)


def check_closed_sphere(ply, copies, tile_faces):
    """A closed oriented surface of Euler characteristic 2 made of so many tiles, all triangles counterclockwise seen from outside."""
    faces = ply.faces
    expect(len(faces) == copies * tile_faces, f'{len(faces)} triangles, not {copies} times {tile_faces}')
    n = len(ply.vertex)
    expect((np.bincount(faces.ravel(), minlength=n) > 0).all(), 'a vertex in no triangle')
    directed = half_edges(faces)
    there, back = np.sort(directed[:, 0] * n + directed[:, 1]), np.sort(directed[:, 1] * n + directed[:, 0])
    expect((np.diff(there) > 0).all() and (there == back).all(), 'the surface is not closed and consistently oriented')
    characteristic = n - len(directed) // 2 + len(faces)
    expect(characteristic == 2, f'Euler characteristic {characteristic}')
    a, b, c = (ply.positions[faces[:, k]] for k in range(3))
    expect(((a * np.cross(b, c)).sum(1) > 0).all(), 'a triangle that is clockwise seen from outside')


class Suite:
    def __init__(self, options):
        self.options = options
        self.orbitutte = pathlib.Path(options.program)
        self.shared = pathlib.Path(options.shared)
        self.checker = self.shared / 'check' / 'verify_embedding.py'
        self.threads = max(1, (os.cpu_count() or 1) // options.jobs)
        self.rows = []
        self.meshes = self.read_cones()

    def read_cones(self):
        """mesh -> (topology, marked vertices, on the boundary of a disk; a marked vertex inside of it or None)"""
        table = {}
        for line in (self.shared / 'meshes' / 'cones.tsv').read_text().splitlines()[1:]:
            mesh, _, _, topology, marked, interior = line.split('\t')
            table[mesh] = (topology, [int(v) for v in marked.split(',')], None if interior == '-' else int(interior))
        return table

    # Running the program; the commands of a test are kept, to be shown where it fails.

    def run(self, commands, *command, codes=(0,)):
        command = [str(word) for word in command]
        commands.append(shlex.join(command))
        try:
            result = subprocess.run(command, capture_output=True, text=True, errors='replace', timeout=self.options.timeout,
                                    stdin=subprocess.DEVNULL)
        except subprocess.TimeoutExpired:
            raise Failure(f'no end after {self.options.timeout} s') from None
        if result.returncode not in codes:
            tail = (result.stderr + result.stdout).strip().splitlines()[-6:]
            raise Failure(f"exit code {result.returncode}, not {' or '.join(map(str, codes))}: " + ' | '.join(tail))
        return result

    def embed(self, commands, folder, mesh, signature, cones, *options, name='embedding', codes=(0,)):
        ply, report = folder / f'{name}.ply', folder / f'{name}.json'
        result = self.run(commands, self.orbitutte, 'embed', self.shared / 'meshes' / mesh, '--orbifold', signature,
                          '--cones', ','.join(map(str, cones)), '-o', ply, '--report', report, '--threads', self.threads,
                          '--quiet', *options, codes=codes)
        return result.returncode, ply, json.loads(report.read_text())

    def marked(self, mesh, signature):
        def count(orders):
            return len(orders.split(',') if ',' in orders else orders)

        _, marked, interior = self.meshes[mesh]
        before, star, after = signature.partition('*')
        if not star:
            return marked[:count(before)]
        return ([interior] if before else []) + marked[:count(after)]

    def row(self, name, mesh, signature, report):
        timings = report['timings']
        self.rows.append({
            'test': name, 'mesh': mesh, 'faces': report['mesh']['faces'], 'signature': signature,
            'iterations': report['iterations'], 'evaluations': report['evaluations'], 'energy': report['energy'],
            'gradient_norm': report['gradient_norm'], 'termination': report['termination'],
            'seconds': round(timings['total'] - timings['read'] - timings['write'], 4),
            'certified': report['certificate']['bijective'], 'angle_distortion': report['distortion']['angle']['mean'],
            'area_distortion': report['distortion']['area']['mean']})

    # The tests. Each gets its own folder and the list of its commands.

    def test_embed(self, name, commands, folder, mesh, signature):
        codes = (0, 5) if mesh in KNOWN_HARD else (0,)
        code, ply, report = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature), codes=codes)
        self.row(name, mesh, signature, report)
        for group, keys in REPORT_KEYS.items():
            missing = [key for key in keys if key not in (report[group] if group else report)]
            expect(not missing, f"the report lacks {', '.join(missing)} {'in ' + group if group else ''}")
        expect(report['certificate']['bijective'] == (code == 0), f'exit code {code}, but the report says otherwise')
        path = self.shared / 'meshes' / mesh
        checked = self.run(commands, PYTHON, self.checker, path, ply, report_path(ply), codes=(0, 1))
        found = json.loads(checked.stdout)
        failures = found['failures']
        if code == 5:  # where triangles are turned over, the angles at cones are off too; nothing else may be
            failures = [failure for failure in failures if not failure.startswith(('rotation ', 'corner '))]
        expect(not failures, 'verify_embedding: ' + '; '.join(failures[:3]))
        expect(found['bijective'] == (code == 0), 'verify_embedding and the report disagree')
        self.run(commands, self.orbitutte, 'verify', ply, report_path(ply), path, codes=(code,))

    def test_tile(self, name, commands, folder, mesh, signature):
        _, ply, report = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature))
        tiling = folder / 'tiling.ply'
        self.run(commands, self.orbitutte, 'tile', ply, report_path(ply), '-o', tiling)
        check_closed_sphere(Ply(tiling), report['orbifold']['group_order'], report['mesh']['faces'])

    def test_render(self, name, commands, folder, mesh, signature):
        _, ply, _ = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature))

        def render(picture, *options, codes=(0,)):
            path = folder / picture
            self.run(commands, self.orbitutte, 'render', ply, report_path(ply), self.shared / 'meshes' / mesh, '-o', path,
                     *options, codes=codes)
            return path.read_bytes() if path.exists() else b''

        sheet = render('sheet.png', '--size', '480x400')
        expect(sheet.startswith(b'\x89PNG') and struct.unpack('>II', sheet[16:24]) == (480, 400), 'no PNG of 480 x 400 pixels')
        expect(render('again.png', '--size', '480x400') == sheet, 'two runs gave different pictures')
        root = xml.etree.ElementTree.fromstring(render('plot.svg', '--panel', 'histogram'))
        expect(root.tag.endswith('svg'), 'no SVG')
        for options in (['--panel', 'nonsense'], ['--view', 'nowhere'], ['--size', '1x1'], ['--panel', 'histogram', '--up', 'w']):
            expect(not render('refused.png', *options, codes=(2,)), f"{' '.join(options)}: a file was written")

    def test_golden(self, name, commands, folder, golden_folder):
        golden = json.loads((golden_folder / 'golden.json').read_text())
        mesh, signature, cones = golden['mesh'], golden['signature'], golden['cones']
        weights = golden_folder / 'edges.txt'
        _, ply, report = self.embed(commands, folder, mesh, signature, cones, '--weights-file', weights)
        self.row(name, mesh, signature, report)
        path = self.shared / 'meshes' / mesh
        self.run(commands, PYTHON, self.checker, path, ply, report_path(ply), '--weights-file', weights)
        difference = abs(report['energy'] / golden['energy'] - 1)
        expect(difference < 1e-9, f"energy {report['energy']:.14g}, the reference has {golden['energy']:.14g}")
        table = np.loadtxt(weights)
        ends = np.sort(table[:, :2].astype(np.int64), axis=1)
        keys = (ends[:, 0] << 32) + ends[:, 1]
        order = np.argsort(keys)
        ours, lengths = edge_lengths(Ply(ply))
        expect(np.array_equal(keys[order], ours), 'the edges are not those of the reference')
        worst = np.abs(lengths - table[order, 3]).max()
        expect(worst < 1e-7, f'an edge length differs by {worst:.2e} from the reference')
        if len(cones) == 3 and self.meshes[mesh][0] == 'sphere':
            expect(report['iterations'] <= MAX_ITERATIONS_THREE_CONES,
                   f"{report['iterations']} iterations, more than {MAX_ITERATIONS_THREE_CONES}")

    def test_cut_seed(self, name, commands, folder, mesh, signature, seeds):
        cones = self.marked(mesh, signature)
        reference, cuts = None, set()
        for seed in range(seeds):
            _, ply, report = self.embed(commands, folder, mesh, signature, cones, '--cut-seed', seed)
            cuts.add(json.dumps([seam['left'] for seam in report['seams']]))
            keys, lengths = edge_lengths(Ply(ply))
            if reference is None:
                reference = lengths
            worst = np.abs(lengths - reference).max()
            expect(worst < 1e-8, f'cut seed {seed}: an edge length differs by {worst:.2e} from that of cut seed 0')
            commands.clear()
        expect(len(cuts) > seeds // 2, f'{seeds} seeds gave {len(cuts)} cuts')

    def test_repeat(self, name, commands, folder, mesh, signature):
        results = []
        for run in ('first', 'second'):
            _, ply, report = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature), name=run)
            del report['timings'], report['peak_memory_bytes']
            results.append((ply.read_bytes(), report))
        expect(results[0][0] == results[1][0], 'two runs gave different embeddings')
        differing = [key for key in results[0][1] if results[0][1][key] != results[1][1].get(key)]
        expect(not differing, f"two runs gave different reports: {', '.join(differing)}")

    def test_fault(self, name, commands, folder, mesh, signature, plant):
        _, ply_path, report = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature))
        path = self.shared / 'meshes' / mesh
        self.run(commands, self.orbitutte, 'verify', ply_path, report_path(ply_path), path)
        ply = Ply(ply_path)
        plant(ply, report)
        ply.save(folder / 'faulty.ply')
        (folder / 'faulty.json').write_text(json.dumps(report))
        self.run(commands, self.orbitutte, 'verify', folder / 'faulty.ply', folder / 'faulty.json', path, codes=(5,))

    # All tests: name -> a function of the name, the list of commands and the folder.

    def tests(self, quick):
        result = collections.OrderedDict()

        def add(name, test, *arguments):
            result[name] = lambda commands, folder: test(name, commands, folder, *arguments)

        # Long ones first, so that none is left alone at the end.
        for (mesh, signature), seeds in (QUICK_SEEDS if quick else ALL_SEEDS).items():
            add(f'cut-seed/{stem(mesh)}/{signature}', self.test_cut_seed, mesh, signature, seeds)
        if quick:
            chosen = QUICK_MESHES
        else:
            chosen = {mesh: SPHERE_SIGNATURES if topology == 'sphere' else DISK_SIGNATURES + MIXED_SIGNATURES
                      for mesh, (topology, _, _) in self.meshes.items()}
        for mesh in sorted(chosen, key=lambda mesh: -(self.shared / 'meshes' / mesh).stat().st_size):
            for signature in chosen[mesh]:
                add(f'embed/{stem(mesh)}/{signature}', self.test_embed, mesh, signature)
        for golden in sorted((self.shared / 'golden').glob('*/golden.json')):
            folder = golden.parent
            if folder.name.endswith('polygon') or quick and not folder.name.startswith(tuple(QUICK_GOLDEN)):
                continue
            add(f'golden/{folder.name}', self.test_golden, folder)
        for signature in ONE_OF_EACH_FAMILY:
            add(f'tile/{signature}', self.test_tile, 'camelhead.off' if '*' in signature else 'my_man_maxp.off', signature)
        add('render/camelhead/*432', self.test_render, 'camelhead.off', '*432')
        for mesh, signature in [('my_man_maxp.off', '532'), ('my_man_maxp.off', '33'), ('camelhead.off', '*432'),
                                ('camelhead.off', '3*2'), ('camelhead.off', '5*')]:
            add(f'repeat/{stem(mesh)}/{signature}', self.test_repeat, mesh, signature)
        for mesh, signature in [('my_man_maxp.off', '432'), ('my_man_maxp.off', '33'), ('camelhead.off', '*432'),
                                ('camelhead.off', '3*2'), ('camelhead.off', '5*')]:
            for plant in (move_across_edge, mirror_map, mirror_positions, claim_another_group_order, claim_another_signature,
                          claim_another_energy, exchange_seam_transform):
                add(f'fault/{plant.__name__}/{signature}', self.test_fault, mesh, signature, plant)
        for plant in (cover_twice, cover_twice_and_claim_it):
            add(f'fault/{plant.__name__}/22', self.test_fault, 'my_man_maxp.off', '22', plant)
        return result


def stem(mesh):
    return pathlib.Path(mesh).stem


def report_path(ply):
    return ply.with_suffix('.json')


# Faults to plant: each changes the embedding or the report in place.

def move_across_edge(ply, report):
    """Reflects a vertex inside the tile across the opposite edge of one of its triangles."""
    held = np.zeros(len(ply.vertex), bool)
    for seam in report['seams']:
        held[seam['left']] = held[seam['right']] = True
    face = ply.faces[np.flatnonzero(~held[ply.faces].any(axis=1))[0]]
    x = ply.positions
    normal = normalized(np.cross(x[face[1]], x[face[2]]))
    moved = x[face[0]] - 2 * (x[face[0]] @ normal) * normal
    x[face[0]] = moved / np.linalg.norm(moved)
    ply.positions = x


MIRROR = np.diag([1.0, 1.0, -1.0])


def mirror_positions(ply, report):
    """The positions alone: now the seams do not match either."""
    ply.positions = ply.positions @ MIRROR


def mirror_map(ply, report):
    """Positions and seams: everything still fits, but every triangle is turned over."""
    mirror_positions(ply, report)
    for seam in report['seams']:
        seam['transform'] = (MIRROR @ np.array(seam['transform']) @ MIRROR).tolist()


def claim_another_group_order(ply, report):
    report['orbifold']['group_order'] *= 2


def claim_another_signature(ply, report):
    signature = report['orbifold']['signature']
    other = {'432': '532', '33': '44', '*432': '*532', '3*2': '2*6', '5*': '6*'}[signature]
    orders = {'532': 60, '44': 4, '*532': 120, '2*6': 24, '6*': 12}
    report['orbifold'] = {'signature': other, 'group_order': orders[other]}


def claim_another_energy(ply, report):
    report['energy'] *= 1 + 1e-6


def exchange_seam_transform(ply, report):
    """A seam with a transform that is not its own."""
    seam = report['seams'][0]
    about_x = np.array([[1, 0, 0], [0, np.cos(1), -np.sin(1)], [0, np.sin(1), np.cos(1)]])
    seam['transform'] = (about_x @ np.array(seam['transform']) @ about_x.T).tolist()


def cover_twice(ply, report):
    """Doubles the longitude of a lune onto half the sphere: it covers all of it, every triangle positively oriented."""
    x = ply.positions
    axis = x[report['cones'][0]['copies'][0]]
    right = normalized(np.cross(axis, [0.3, 0.5, 0.7]))
    front = np.cross(right, axis)
    height = x @ axis
    radius = np.sqrt(np.maximum(0, 1 - height**2))
    longitude = 2 * np.arctan2(x @ right, x @ front)
    x = height[:, None] * axis + radius[:, None] * (np.cos(longitude)[:, None] * front + np.sin(longitude)[:, None] * right)
    ply.positions = normalized(x)
    for seam in report['seams']:
        seam['transform'] = (np.array(seam['transform']) @ np.array(seam['transform'])).tolist()


def cover_twice_and_claim_it(ply, report):
    """The same, and the report claims the area that is there."""
    cover_twice(ply, report)
    certificate = report['certificate']
    certificate['signed_area'] = certificate['expected_area'] = 4 * np.pi
    report['orbifold']['group_order'] = 1


def run_test(suite, name, test):
    """(name, seconds, what failed or None, commands)"""
    commands, start, problem = [], time.monotonic(), None
    with tempfile.TemporaryDirectory(prefix='orbitutte-') as folder:
        folder = pathlib.Path(folder)
        try:
            test(commands, folder)
        except Failure as failure:
            problem = str(failure)
        except Exception as error:  # a file that is missing or malformed is a failure of this test only
            problem = f'{type(error).__name__}: {error}'
        commands = [command.replace(str(folder) + '/', 'out/') for command in commands]
    return name, time.monotonic() - start, problem, commands


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    extent = parser.add_mutually_exclusive_group()
    extent.add_argument('--quick', action='store_true', help='a part that takes about a minute on two cores')
    extent.add_argument('--all', action='store_true', help='everything (the default)')
    parser.add_argument('--filter', default='', metavar='TEXT', help='only tests with TEXT in their name, as in golden/ or /532')
    parser.add_argument('--list', action='store_true', help='print the names of the tests')
    parser.add_argument('--jobs', type=int, default=os.cpu_count() or 1, metavar='N', help='tests at the same time')
    parser.add_argument('--timeout', type=float, default=600, metavar='SECONDS', help='for one run of the program')
    parser.add_argument('--json', metavar='FILE', help='write a line of JSON per embedding: iterations, energy, seconds, ...')
    parser.add_argument('--summary', metavar='FILE', help="write 'passed failed skipped' there")
    parser.add_argument('--program', default=str(REPOSITORY / 'build' / 'orbitutte'), metavar='FILE')
    parser.add_argument('--shared', default=str(REPOSITORY.parent / 'shared'), metavar='FOLDER',
                        help='with meshes/, golden/ and check/')
    options = parser.parse_args()
    options.jobs = max(1, options.jobs)
    return options


def finish(options, passed, failed, skipped):
    if options.summary:
        pathlib.Path(options.summary).write_text(f'{passed} {failed} {skipped}\n')
    print(f'{passed} passed, {failed} failed, {skipped} skipped')
    return 1 if failed else 0


def main():
    options = parse_arguments()
    if not (pathlib.Path(options.shared) / 'meshes' / 'cones.tsv').is_file():
        print(f'acceptance: skipped, for there are no meshes in {options.shared} (option --shared)')
        return finish(options, 0, 0, 1)
    if not os.access(options.program, os.X_OK):
        print(f'acceptance: {options.program} is not there; build first')
        return finish(options, 0, 1, 0)

    suite = Suite(options)
    chosen = {name: test for name, test in suite.tests(options.quick).items() if options.filter in name}
    if options.list:
        print('\n'.join(chosen))
        return 0
    if not chosen:
        print(f"acceptance: no test has '{options.filter}' in its name")
        return finish(options, 0, 1, 0)
    failed, start, done = [], time.monotonic(), 0
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for future in concurrent.futures.as_completed([pool.submit(run_test, suite, *item) for item in chosen.items()]):
            name, seconds, problem, commands = future.result()
            done += 1
            if sys.stderr.isatty():
                print(f'\r\033[K{done}/{len(chosen)} {name}', end='\r', file=sys.stderr, flush=True)
            if problem:
                failed.append(name)
                print(f'FAILED {name} ({seconds:.1f} s): {problem}\n  to repeat: ' + ' && '.join(commands), flush=True)
    if sys.stderr.isatty():
        print('\r\033[K', end='', file=sys.stderr)
    if options.json:
        rows = sorted(suite.rows, key=lambda row: row['test'])
        pathlib.Path(options.json).write_text(''.join(json.dumps(row) + '\n' for row in rows))
    print(f'acceptance: {len(chosen)} tests in {time.monotonic() - start:.0f} s')
    return finish(options, len(chosen) - len(failed), len(failed), 0)


if __name__ == '__main__':
    sys.exit(main())
