#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Acceptance test: the built program on real meshes, judged by an independent checker.

The meshes, their marked vertices, the reference results and the checker lie in a folder beside the repository (../shared) that
is no part of it: where it is missing, everything is skipped. Needs numpy.

  embed         every family on every mesh: verify_embedding.py and 'orbitutte verify' accept; exit 0 exactly when certified
  whole         every sphere onto the whole sphere, every disk onto the hemisphere: as embed, with angles like those of 222
  tile          the tiling of one embedding of each family is a closed surface of Euler characteristic 2, counterclockwise
  render        a picture is a PNG of the size asked for, the same bytes twice; a plot is SVG; what makes no sense is refused
  export        OBJ, GLB and VTP read back: every corner has texture coordinates of its vertex, arrays are whole
  compare       both certified, and the area distortion, its mean or sigma, is lower on the sphere
  golden        the reference's energies to 1e-9 (relative) and edge lengths to 1e-7, with the reference's weights
  weights       Delaunay and mean value weights on every mesh: as embed, and Delaunay is nearer to conformal than the clamp
  polygon       the tile of *222 as a fixed polygon: certified, and the map is more sheared than that into the orbifold
  cut-seed      20 cuts of the same mesh: no edge length changes by more than 1e-8
  polygons      meshes of polygons, made of the same meshes: certified, convex, in their order; the checker accepts the map
                divided into triangles, energy and gradient included; the tiling in polygons is a closed sphere
  repeat        two runs give the same bytes, but for times and memory in the report
  fault         'orbitutte verify' rejects, with exit code 5, embeddings and reports that were tampered with
  theorem2      'orbitutte verify --theorem2' finds both of its conditions to hold, and never changes the exit code
"""
import argparse
import base64
import collections
import json
import os
import pathlib
import struct
import sys
import tempfile
import time
import xml.etree.ElementTree

import numpy as np

from planted_faults import (claim_another_area, claim_another_energy, claim_another_group_order, claim_another_signature, cover_twice,
                            cover_twice_and_claim_it, exchange_seam_transform, mirror_map, mirror_positions, move_across_edge)
from mesh_files import PLY_TYPES, Ply, half_edges, read_off_triangles, write_off
from trials import PYTHON, REPOSITORY, expect, finish, run_command, run_tests

SPHERE_SIGNATURES = ['532', '432', '332', '222', '223', '224', '228', '2,2,12', '22', '33', '44', '88', '12,12']
DISK_SIGNATURES = ['*' + signature for signature in SPHERE_SIGNATURES]
MIXED_SIGNATURES = ['3*2', '2*2', '2*3', '2*5', '2*8', '2*', '3*', '5*', '8*']  # a cone inside a disk
CROSSED_SIGNATURES = ['1x', '2x', '3x', '5x', '8x']  # on projective planes, which the program makes itself
SAMPLES = ['boy', 'roman', 'crosscap', 'quotient']
ONE_OF_EACH_FAMILY = ['532', '432', '332', '223', '44', '*532', '*432', '*332', '*228', '*33'] + MIXED_SIGNATURES + \
    CROSSED_SIGNATURES

# The quick part: every family, each hard kind of mesh, golden runs on the smallest meshes.
QUICK_MESHES = {'my_man_maxp.off': SPHERE_SIGNATURES, 'thingi_62415.obj': SPHERE_SIGNATURES, 'itokawa.off': ['532', '22'],
                'octocat.off': ['532'], 'camelhead.off': DISK_SIGNATURES[::2] + ['*33'] + MIXED_SIGNATURES[::2],
                'fandisk.off': ['*432', '2*3', '8*'], 'boy.ply': CROSSED_SIGNATURES, 'quotient.ply': ['3x']}
QUICK_GOLDEN = ['my_man_maxp', 'fandisk_star243', 'fandisk_polygon']
QUICK_SEEDS = {('my_man_maxp.off', '532'): 6, ('camelhead.off', '3*2'): 4, ('camelhead.off', '5*'): 4,
               ('boy.ply', '3x'): 4}
ALL_SEEDS = {('my_man_maxp.off', '532'): 20, ('david_50k.off', '532'): 20, ('camelhead.off', '3*2'): 20,
             ('fandisk.off', '2*5'): 20, ('camelhead.off', '5*'): 20, ('fandisk.off', '2*'): 20,
             ('boy.ply', '1x'): 20, ('quotient.ply', '5x'): 20}

# May fail to be bijective in double precision, saying so (exit code 5).
KNOWN_HARD = {'octocat.off'}
QUICK_WEIGHTS = ['my_man_maxp.off', 'itokawa.off', 'camelhead.off', 'fandisk.off']

# Their mean angle distortion is that of a few triangles without shape.
NEEDLES = {'hippocampus.off', 'octocat.off', 'thingi_62415.obj'}

MAX_ITERATIONS_THREE_CONES = 14

MOST_POLYGONS_TILED = 300000  # the time it takes to look at them one by one

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


def spherical_distance(p, q):
    return np.arctan2(np.linalg.norm(np.cross(p, q), axis=1), (p * q).sum(1))


def edge_lengths(ply):
    """The undirected edges of the uncut mesh as keys (i * 2^32 + j, i < j), ascending, and the length of each on the sphere."""
    ends = half_edges(ply.faces)
    source = np.sort(ply.vertex['source_vertex'].astype(np.int64)[ends], axis=1)
    keys, first = np.unique((source[:, 0] << 32) + source[:, 1], return_index=True)
    return keys, spherical_distance(ply.positions[ends[first, 0]], ply.positions[ends[first, 1]])


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
    volume = (a * np.cross(b, c)).sum(1)
    expect((volume > 0).all(), 'a triangle that is clockwise seen from outside')
    area = 2 * np.arctan2(volume, 1 + (a * b).sum(1) + (b * c).sum(1) + (c * a).sum(1)).sum()
    expect(abs(area - 4 * np.pi) < 1e-8, f'an area of {area:.12g}, not 4 pi')


# Meshes of polygons: vertices and a list of faces.

def quadrangulated(vertices, faces):
    """Every triangle in three quadrilaterals around its middle; old vertices keep their numbers."""
    n, m = len(vertices), len(faces)
    ends, edge = np.unique(np.sort(half_edges(faces), axis=1), axis=0, return_inverse=True)
    edge = n + edge.reshape(3, m)
    middle = n + len(ends) + np.arange(m)
    points = np.concatenate([vertices, vertices[ends].mean(1), vertices[faces].mean(1)])
    return points, np.stack([np.stack([faces[:, k], edge[k], middle, edge[k - 1]], 1) for k in range(3)], 1).reshape(-1, 4).tolist()


def dual(vertices, faces):
    """A vertex in the middle of every triangle of a closed mesh, a face around every vertex."""
    after = {}  # vertex -> the next neighbour around it and the triangle between, by neighbour
    for f, triangle in enumerate(faces.tolist()):
        for k, v in enumerate(triangle):
            after.setdefault(v, {})[triangle[k - 2]] = (triangle[k - 1], f)
    polygons = []
    for v in sorted(after):
        first = neighbour = min(after[v])
        polygon = []
        while not polygon or neighbour != first:
            neighbour, f = after[v][neighbour]
            polygon.append(f)
        polygons.append(polygon)
    return vertices[faces].mean(1), polygons


def read_polygons(path):
    """The vertices of a PLY as the program writes it, as a structured array, and its faces as lists."""
    data = pathlib.Path(path).read_bytes()
    at = data.index(b'end_header\n') + len(b'end_header\n')
    lines = [line.split() for line in data[:at].decode().splitlines()]
    face = next(k for k, words in enumerate(lines) if words[:2] == ['element', 'face'])
    vertex = next(k for k, words in enumerate(lines) if words[:2] == ['element', 'vertex'])
    vertices = np.frombuffer(data, [(words[2], PLY_TYPES[words[1]]) for words in lines[vertex + 1:face]], int(lines[vertex][2]), at)
    at += vertices.nbytes
    further = np.dtype([(words[2], PLY_TYPES[words[1]]) for words in lines[face + 2:-1]]).itemsize
    faces = []
    for _ in range(int(lines[face][2])):
        faces.append(np.frombuffer(data, '<i4', data[at], at + 1).tolist())
        at += 1 + 4 * data[at] + further
    expect(at == len(data), f'{path}: {len(data) - at} bytes too many')
    return vertices, faces


def write_triangles(path, vertices, triangles):
    types = {'<f8': 'double', '<i4': 'int'}
    properties = ''.join(f'property {types[vertices.dtype[name].str]} {name}\n' for name in vertices.dtype.names)
    rows = np.zeros(len(triangles), [('corners', 'u1'), ('vertex_indices', '<i4', 3)])
    rows['corners'], rows['vertex_indices'] = 3, triangles
    header = (f'ply\nformat binary_little_endian 1.0\nelement vertex {len(vertices)}\n{properties}'
              f'element face {len(rows)}\nproperty list uchar int vertex_indices\nend_header\n')
    pathlib.Path(path).write_bytes(header.encode() + vertices.tobytes() + rows.tobytes())


def fans(faces):
    return [[face[0], face[k], face[k + 1]] for face in faces for k in range(1, len(face) - 1)]


def edges_of(faces):
    return {(min(a, b), max(a, b)) for face in faces for a, b in zip(face, face[1:] + face[:1])}


def check_closed_polygons(vertices, faces):
    """A closed oriented surface of Euler characteristic 2, all corners convex seen from outside up to rounding."""
    directed = [(a, b) for face in faces for a, b in zip(face, face[1:] + face[:1])]
    there = set(directed)
    expect(len(there) == len(directed) and all((b, a) in there for a, b in directed),
           'the surface is not closed and consistently oriented')
    used = len({v for face in faces for v in face})
    expect(used == len(vertices), 'a vertex in no face')
    characteristic = used - len(directed) // 2 + len(faces)
    expect(characteristic == 2, f'Euler characteristic {characteristic}')
    x = np.stack([vertices[axis] for axis in 'xyz'], 1)
    corners = np.array([corner for face in faces for corner in zip(face[-1:] + face[:-1], face, face[1:] + face[:1])])
    a, b, c = x[corners[:, 0]], x[corners[:, 1]], x[corners[:, 2]]
    expect(((a - b) * np.cross(b, c)).sum(1).min() > -1e-15, 'a face that is not convex')


class Suite:
    def __init__(self, options):
        self.options = options
        self.orbitutte = pathlib.Path(options.program)
        self.shared = pathlib.Path(options.shared)
        self.checker = self.shared / 'check' / 'verify_embedding.py'
        self.threads = max(1, (os.cpu_count() or 1) // options.jobs)
        self.rows = []
        self.meshes = self.read_cones()
        self.samples = tempfile.TemporaryDirectory()
        for shape in SAMPLES:
            mesh = f'{shape}.ply'
            self.run([], self.orbitutte, 'sample', '--shape', shape, '--faces', 6000, '-o', self.path(mesh))
            self.meshes[mesh] = ('projective-plane', [100], None)

    def path(self, mesh):
        is_sample = pathlib.Path(mesh).stem in SAMPLES
        return pathlib.Path(self.samples.name) / mesh if is_sample else self.shared / 'meshes' / mesh

    def read_cones(self):
        """mesh -> (topology, marked vertices, on the boundary of a disk; a marked vertex inside of it or None)"""
        table = {}
        for line in (self.shared / 'meshes' / 'cones.tsv').read_text().splitlines()[1:]:
            mesh, _, _, topology, marked, interior = line.split('\t')
            table[mesh] = (topology, [int(v) for v in marked.split(',')], None if interior == '-' else int(interior))
        return table

    def disks(self):
        return [mesh for mesh, (topology, _, _) in self.meshes.items() if topology == 'disk']

    # Running the program; the commands of a test are kept, to be shown where it fails.

    def run(self, commands, *command, codes=(0,)):
        return run_command(commands, *command, timeout=self.options.timeout, codes=codes)

    def embed(self, commands, folder, mesh, signature, cones, *options, name='embedding', codes=(0,)):
        ply, report = folder / f'{name}.ply', folder / f'{name}.json'
        marked = ['--cones', ','.join(map(str, cones))] if cones else []  # a polygon's are in its file
        result = self.run(commands, self.orbitutte, 'embed', self.path(mesh), '--orbifold', signature,
                          *marked, '-o', ply, '--report', report, '--threads', self.threads,
                          '--quiet', *options, codes=codes)
        return result.returncode, ply, json.loads(report.read_text())

    def marked(self, mesh, signature):
        def count(orders):
            return len(orders.split(',') if ',' in orders else orders)

        _, marked, interior = self.meshes[mesh]
        if signature in ('1', '*'):
            return []
        if signature.endswith('x'):
            return marked
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
        path = self.path(mesh)
        checked = self.run(commands, PYTHON, self.checker, path, ply, report_path(ply), codes=(0, 1))
        found = json.loads(checked.stdout)
        failures = found['failures']
        if code == 5:  # where triangles are turned over, the angles at their vertices are off too; nothing else may be
            failures = [failure for failure in failures
                        if not failure.startswith(('rotation ', 'corner ')) and 'wrong sum of angles' not in failure]
        expect(not failures, 'verify_embedding: ' + '; '.join(failures[:3]))
        expect(found['bijective'] == (code == 0), 'verify_embedding and the report disagree')
        self.run(commands, self.orbitutte, 'verify', ply, report_path(ply), path, codes=(code,))

    def test_whole(self, name, commands, folder, mesh, signature):
        """The quotient: as `embed`, and its angles and its time are near to those of the map that it was made from."""
        self.test_embed(name, commands, folder, mesh, signature)
        whole = json.loads((folder / 'embedding.json').read_text())
        base = whole['quotient_of']
        _, _, orbifold = self.embed(commands, folder, mesh, base['signature'], base['cones'], name='orbifold')
        angles = [report['distortion']['angle']['mean'] for report in (whole, orbifold)]
        expect(mesh in NEEDLES or angles[0] <= angles[1] + 0.015, f'mean angle distortion {angles[0]:.4f}, that of the orbifold map {angles[1]:.4f}')
        expect(whole['quotient'] and whole['centre'] == 'area', 'the report does not call it a centred quotient')
        area = whole['certificate']['signed_area'] * whole['orbifold']['group_order']
        expect(abs(area - 4 * np.pi) < 1e-9, f'an area of {area:.12g}, not 4 pi')

    def test_weights(self, name, commands, folder, mesh, signature):
        cones, path = self.marked(mesh, signature), self.path(mesh)
        angle = {}
        for weights in ('cotan', 'delaunay', 'mean-value'):
            codes = (0, 5) if mesh in KNOWN_HARD else (0,)
            code, ply, report = self.embed(commands, folder, mesh, signature, cones, '--weights', weights, name=weights, codes=codes)
            expect(report['weights']['kind'] == weights, f"the report has weights {report['weights']['kind']}")
            expect(report['certificate']['bijective'] == (code == 0), f'exit code {code}, but the report says otherwise')
            self.run(commands, self.orbitutte, 'verify', ply, report_path(ply), path, codes=(code,))
            if code == 0:
                self.run(commands, PYTHON, self.checker, path, ply, report_path(ply))
            angle[weights] = report['distortion']['angle']['area_mean']
        _, _, report = self.embed(commands, folder, mesh, signature, cones, name='standard')
        standard = report['distortion']['angle']['area_mean']
        expect(standard <= angle['cotan'] + 1e-3,
               f"mean angle distortion over the area {standard:.4f} with the standard weights, {angle['cotan']:.4f} with the clamp")

    def test_tile(self, name, commands, folder, mesh, signature):
        _, ply, report = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature))
        tiling = folder / 'tiling.ply'
        self.run(commands, self.orbitutte, 'tile', ply, report_path(ply), '-o', tiling)
        check_closed_sphere(Ply(tiling), report['orbifold']['group_order'], report['mesh']['faces'])

    def test_polygons(self, name, commands, folder, mesh, signature, make):
        source = folder / 'polygons.off'
        vertices, faces = make(*read_off_triangles(self.shared / 'meshes' / mesh))
        write_off(source, vertices, faces)
        info = json.loads(self.run(commands, self.orbitutte, 'info', source, '--json').stdout)
        expect(not info['weak_places'], f"weak places: {info['weak_places']}")
        for weights in ('cotan', 'uniform'):
            ply, report_file, tiling = folder / f'{weights}.ply', folder / f'{weights}.json', folder / 'tiling.ply'
            cones = ','.join(map(str, self.marked(mesh, signature))) if make is quadrangulated else 'extremities'
            self.run(commands, self.orbitutte, 'embed', source, '--orbifold', signature, '--cones', cones, '--weights', weights,
                     '-o', ply, '--report', report_file, '--threads', self.threads, '--quiet')
            report = json.loads(report_file.read_text())
            self.row(f'{name}/{weights}', mesh, signature, report)
            self.run(commands, self.orbitutte, 'verify', ply, report_file, source)
            cut, cut_faces = read_polygons(ply)
            expect([[int(cut['source_vertex'][v]) for v in face] for face in cut_faces] == faces, 'not the input faces in their order')
            if len(faces) * report['orbifold']['group_order'] > MOST_POLYGONS_TILED:
                continue
            self.run(commands, self.orbitutte, 'tile', ply, report_file, '-o', tiling)
            tiled, tiled_faces = read_polygons(tiling)
            expect(len(tiled_faces) == len(faces) * report['orbifold']['group_order'], f'{len(tiled_faces)} faces in the tiling')
            check_closed_polygons(tiled, tiled_faces)
        # The checker knows triangles only: the convex faces in fans, whose diagonals have the weight zero.
        write_off(folder / 'fans.off', vertices, fans(faces))
        write_triangles(folder / 'fans.ply', cut, fans(cut_faces))
        own = edges_of(faces)
        (folder / 'weights.txt').write_text(''.join(f'{i} {j} {int((i, j) in own)}\n' for i, j in sorted(edges_of(fans(faces)))))
        self.run(commands, PYTHON, self.checker, folder / 'fans.off', folder / 'fans.ply', report_file, '--weights-file',
                 folder / 'weights.txt')

    def test_render(self, name, commands, folder, mesh, signature):
        _, ply, _ = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature))

        def render(picture, *options, codes=(0,)):
            path = folder / picture
            self.run(commands, self.orbitutte, 'render', ply, report_path(ply), self.path(mesh), '-o', path,
                     *options, codes=codes)
            return path.read_bytes() if path.exists() else b''

        sheet = render('sheet.png', '--size', '480x400')
        expect(sheet.startswith(b'\x89PNG') and struct.unpack('>II', sheet[16:24]) == (480, 400), 'no PNG of 480 x 400 pixels')
        expect(render('again.png', '--size', '480x400') == sheet, 'two runs gave different pictures')
        root = xml.etree.ElementTree.fromstring(render('plot.svg', '--panel', 'histogram'))
        expect(root.tag.endswith('svg'), 'no SVG')
        for options in (['--panel', 'nonsense'], ['--view', 'nowhere'], ['--size', '1x1'], ['--panel', 'histogram', '--up', 'w']):
            expect(not render('refused.png', *options, codes=(2,)), f"{' '.join(options)}: a file was written")

    def test_export(self, name, commands, folder, mesh, signature):
        _, ply, report = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature))
        source_vertex = Ply(ply).vertex['source_vertex']

        def export(file, chart):
            self.run(commands, self.orbitutte, 'export', ply, report_path(ply), self.path(mesh), '-o', folder / file, '--chart', chart)
            return (folder / file).read_bytes()

        for chart in ('stereographic', 'equirectangular', 'octahedral'):
            lines = [line.split() for line in export('m.obj', chart).decode().splitlines()]
            corners = np.array([[[int(k) for k in corner.split('/')] for corner in line[1:]] for line in lines if line[0] == 'f']) - 1
            pairs = [line for line in lines if line[0] == 'vt']
            expect(corners.shape == (report['mesh']['faces'], 3, 2), 'faces are missing')
            expect(corners[:, :, 1].max() < len(pairs), 'a texture coordinate is missing')
            own = corners[:, :, 1] < len(source_vertex)  # others are further copies across the date line
            expect((source_vertex[corners[:, :, 1][own]] == corners[:, :, 0][own]).all(), 'a corner has the texture of another vertex')
        root = xml.etree.ElementTree.fromstring(export('m.vtp', 'stereographic'))
        arrays = {array.get('Name'): base64.b64decode(array.text) for array in root.iter('DataArray')}
        expect(all(len(data) == 8 + struct.unpack('<Q', data[:8])[0] for data in arrays.values()), 'an array of another length than it says')
        sphere = np.frombuffer(arrays['sphere'][8:]).reshape(-1, 3)
        expect(np.array_equal(sphere, Ply(ply).positions), 'the positions on the sphere are others')
        glb = export('m.glb', 'octahedral')
        length = struct.unpack('<I', glb[12:16])[0]
        model = json.loads(glb[20:20 + length])
        expect(struct.unpack('<I', glb[8:12])[0] == len(glb), 'a GLB of another length than it says')
        expect(set(model['meshes'][0]['primitives'][0]['attributes']) == {'POSITION', 'NORMAL', 'TEXCOORD_0', 'COLOR_0'}, 'attributes')
        self.run(commands, self.orbitutte, 'info', folder / 'm.obj')

    def test_compare(self, name, commands, folder, mesh):
        signature = '432' if self.meshes[mesh][0] == 'sphere' else '*432'
        cones = ','.join(map(str, self.marked(mesh, signature)))
        found = json.loads(self.run(commands, self.orbitutte, 'compare', self.path(mesh), '--cones', cones, '--json', '-o',
                                    folder / 'histograms.svg').stdout)
        expect(all(row['bijective'] for row in found['maps']), 'not both certified')
        means, sigmas = [row['area']['mean'] for row in found['maps']], [row['sigma'] for row in found['maps']]
        expect(means[0] < means[1] or sigmas[0] < sigmas[1],
               f'area distortion: mean {means[0]:.4g} and sigma {sigmas[0]:.4g} on the sphere, {means[1]:.4g} and {sigmas[1]:.4g} in the plane')
        xml.etree.ElementTree.parse(folder / 'histograms.svg')

    def test_golden(self, name, commands, folder, golden_folder):
        golden = json.loads((golden_folder / 'golden.json').read_text())
        mesh, signature, cones = golden['mesh'], golden['signature'], golden['cones']
        weights = golden_folder / 'edges.txt'
        options = ['--weights-file', weights]
        if signature == 'polygon':
            cones = []
            options += ['--polygon', write_corners(folder / 'corners.txt', golden['corners']), '--spread', 'equidistant']
        _, ply, report = self.embed(commands, folder, mesh, signature, cones, *options)
        self.row(name, mesh, signature, report)
        path = self.path(mesh)
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

    def test_polygon(self, name, commands, folder, mesh, spread):
        _, ply, free = self.embed(commands, folder, mesh, '*222', self.marked(mesh, '*222'), name='free')
        vertices = [cone['vertex'] for cone in free['cones']]
        positions = Ply(ply).positions[vertices]
        corners = [{'vertex': v, 'position': x.tolist()} for v, x in zip(vertices, positions)]
        if np.linalg.det(positions) < 0:  # the marked vertices run clockwise around the mesh
            corners.reverse()
        _, ply, held = self.embed(commands, folder, mesh, 'polygon', [], '--polygon', write_corners(folder / 'corners.txt', corners),
                                  '--spread', spread, name='held')
        self.row(name, mesh, 'polygon', held)
        path = self.path(mesh)
        self.run(commands, PYTHON, self.checker, path, ply, report_path(ply))
        self.run(commands, self.orbitutte, 'verify', ply, report_path(ply), path)
        worse = held['distortion']['angle']['area_mean'] / free['distortion']['angle']['area_mean']
        expect(worse > 1, f'a held boundary makes the angle distortion {worse:.3f} times that of a free one')

    def test_cut_seed(self, name, commands, folder, mesh, signature, seeds, weights='cotan'):
        cones = self.marked(mesh, signature)
        reference, cuts = None, set()
        for seed in range(seeds):
            _, ply, report = self.embed(commands, folder, mesh, signature, cones, '--cut-seed', seed, '--weights', weights)
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
        path = self.path(mesh)
        self.run(commands, self.orbitutte, 'verify', ply_path, report_path(ply_path), path)
        ply = Ply(ply_path)
        plant(ply, report)
        ply.save(folder / 'faulty.ply')
        (folder / 'faulty.json').write_text(json.dumps(report))
        self.run(commands, self.orbitutte, 'verify', folder / 'faulty.ply', folder / 'faulty.json', path, codes=(5,))

    def theorem2(self, commands, *arguments, codes=(0,)):
        done = self.run(commands, self.orbitutte, 'verify', *arguments, '--theorem2', '--json', codes=codes)
        return json.loads(done.stdout)['theorem2']

    def test_theorem2(self, name, commands, folder, mesh, signature):
        _, ply, report = self.embed(commands, folder, mesh, signature, self.marked(mesh, signature))
        files = [ply, report_path(ply), self.path(mesh)]
        found = self.theorem2(commands, *files)
        if json.loads(report_path(ply).read_text()).get('moved_vertices'):  # off the minimum, of which the theorem speaks
            expect(found['status'] == 'not run' and 'moved' in found['detail'], f"theorem 2: {found['status']} {found['detail']}")
            return
        expect(found['holds'], f"theorem 2: {found['status']} {found['detail']}, {found['negative_eigenvalues']} negative eigenvalues, "
                               f"kernel {found['kernel_dimension']}, longest edge {found['max_edge_length']}")
        weights = folder / 'weights.txt'
        keys, _ = edge_lengths(Ply(ply))
        np.savetxt(weights, np.column_stack([keys >> 32, keys & 0xffffffff, np.ones(len(keys))]), fmt='%d %d %g')
        self.embed(commands, folder, mesh, signature, self.marked(mesh, signature), '--weights-file', weights)
        found = self.theorem2(commands, *files)
        expect(found['status'] == 'not run' and '--weights-file' in found['detail'], 'theorem 2 was run without its weights')
        found = self.theorem2(commands, *files, '--weights-file', weights)
        expect(found['status'] == 'measured', f"theorem 2 with weights from a file: {found['status']} {found['detail']}")

    # All tests: name -> a function of the name, the list of commands and the folder.

    def tests(self, quick):
        result = collections.OrderedDict()

        def add(name, test, *arguments):
            result[name] = lambda commands, folder: test(name, commands, folder, *arguments)

        # Long ones first, so that none is left alone at the end.
        for (mesh, signature), seeds in (QUICK_SEEDS if quick else ALL_SEEDS).items():
            add(f'cut-seed/{stem(mesh)}/{signature}', self.test_cut_seed, mesh, signature, seeds)
            add(f'cut-seed/{stem(mesh)}/{signature}/delaunay', self.test_cut_seed, mesh, signature, seeds, 'delaunay')
        for mesh, (topology, _, _) in self.meshes.items():
            if not quick or mesh in QUICK_WEIGHTS:
                add(f'weights/{stem(mesh)}', self.test_weights, mesh, {'sphere': '432', 'disk': '*432'}.get(topology, '3x'))
        if quick:
            chosen = QUICK_MESHES
        else:
            of_topology = {'sphere': SPHERE_SIGNATURES, 'disk': DISK_SIGNATURES + MIXED_SIGNATURES,
                           'projective-plane': CROSSED_SIGNATURES}
            chosen = {mesh: of_topology[topology] for mesh, (topology, _, _) in self.meshes.items()}
        for mesh in sorted(chosen, key=lambda mesh: -self.path(mesh).stat().st_size):
            for signature in chosen[mesh]:
                add(f'embed/{stem(mesh)}/{signature}', self.test_embed, mesh, signature)
        for golden in sorted((self.shared / 'golden').glob('*/golden.json')):
            folder = golden.parent
            if quick and not folder.name.startswith(tuple(QUICK_GOLDEN)):
                continue
            add(f'golden/{folder.name}', self.test_golden, folder)
        for mesh, (topology, _, _) in self.meshes.items():
            if topology != 'projective-plane' and (not quick or mesh in QUICK_MESHES):
                signature = {'sphere': '1', 'disk': '*'}[topology]
                add(f'whole/{stem(mesh)}/{signature}', self.test_whole, mesh, signature)
        for signature in ONE_OF_EACH_FAMILY + ['1', '*']:
            mesh = 'camelhead.off' if '*' in signature else 'boy.ply' if 'x' in signature else 'my_man_maxp.off'
            add(f'tile/{signature}', self.test_tile, mesh, signature)
        for mesh, signature, make in [('my_man_maxp.off', '532', dual), ('my_man_maxp.off', '44', quadrangulated),
                                      ('itokawa.off', '432', dual), ('camelhead.off', '*432', quadrangulated),
                                      ('camelhead.off', '3*2', quadrangulated), ('camelhead.off', '5*', quadrangulated)]:
            if not quick or (mesh, signature) in [('my_man_maxp.off', '532'), ('camelhead.off', '3*2')]:
                add(f'polygons/{make.__name__}/{stem(mesh)}/{signature}', self.test_polygons, mesh, signature, make)
        for mesh in ['camelhead.off', 'fandisk.off'] if quick else self.disks():
            for spread in ['arc-length', 'equidistant']:
                add(f'polygon/{stem(mesh)}/{spread}', self.test_polygon, mesh, spread)
        for signature in ['532', '33', '*33', '5*', '3x'] if quick else ONE_OF_EACH_FAMILY:
            mesh = 'camelhead.off' if '*' in signature else 'boy.ply' if 'x' in signature else 'my_man_maxp.off'
            add(f'theorem2/{signature}', self.test_theorem2, mesh, signature)
        add('render/camelhead/*432', self.test_render, 'camelhead.off', '*432')
        for mesh, signature in [('my_man_maxp.off', '532'), ('camelhead.off', '3*2'), ('boy.ply', '2x')]:
            add(f'export/{stem(mesh)}/{signature}', self.test_export, mesh, signature)
        for mesh in ['my_man_maxp.off', 'camelhead.off'] if quick else sorted(set(self.meshes) - KNOWN_HARD - {f'{s}.ply' for s in SAMPLES}):
            add(f'compare/{stem(mesh)}', self.test_compare, mesh)
        for mesh, signature in [('my_man_maxp.off', '532'), ('my_man_maxp.off', '33'), ('camelhead.off', '*432'),
                                ('camelhead.off', '3*2'), ('camelhead.off', '5*'), ('boy.ply', '3x')]:
            add(f'repeat/{stem(mesh)}/{signature}', self.test_repeat, mesh, signature)
        for mesh, signature in [('my_man_maxp.off', '432'), ('my_man_maxp.off', '33'), ('camelhead.off', '*432'),
                                ('camelhead.off', '3*2'), ('camelhead.off', '5*'), ('boy.ply', '3x')]:
            for plant in (move_across_edge, mirror_map, mirror_positions, claim_another_group_order, claim_another_signature,
                          claim_another_energy, claim_another_area, exchange_seam_transform):
                add(f'fault/{plant.__name__}/{signature}', self.test_fault, mesh, signature, plant)
        for mesh, signature in [('my_man_maxp.off', '1'), ('camelhead.off', '*')]:
            for plant in (move_across_edge, mirror_map, mirror_positions, claim_another_group_order, claim_another_signature,
                          claim_another_energy, claim_another_area):
                add(f'fault/{plant.__name__}/{signature}', self.test_fault, mesh, signature, plant)
        for plant in (cover_twice, cover_twice_and_claim_it):
            add(f'fault/{plant.__name__}/22', self.test_fault, 'my_man_maxp.off', '22', plant)
        return result


def stem(mesh):
    return pathlib.Path(mesh).stem


def report_path(ply):
    return ply.with_suffix('.json')


def write_corners(path, corners):
    """The file for --polygon; its path."""
    path.write_text(''.join(f"{corner['vertex']} {' '.join(map(repr, corner['position']))}\n" for corner in corners))
    return path


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


def main():
    options = parse_arguments()
    if not (pathlib.Path(options.shared) / 'meshes' / 'cones.tsv').is_file():
        print(f'acceptance: skipped, for there are no meshes in {options.shared} (option --shared)')
        return finish(options.summary, 0, 0, 1)
    if not os.access(options.program, os.X_OK):
        print(f'acceptance: {options.program} is not there; build first')
        return finish(options.summary, 0, 1, 0)

    suite = Suite(options)
    chosen = {name: test for name, test in suite.tests(options.quick).items() if options.filter in name}
    if options.list:
        print('\n'.join(chosen))
        return 0
    if not chosen:
        print(f"acceptance: no test has '{options.filter}' in its name")
        return finish(options.summary, 0, 1, 0)
    failed, start = 0, time.monotonic()
    for outcome in run_tests(chosen, options.jobs):
        if outcome.failure:
            failed += 1
            print(f'FAILED {outcome.name} ({outcome.seconds:.1f} s): {outcome.failure}\n  to repeat: ' +
                  ' && '.join(outcome.commands), flush=True)
    if options.json:
        rows = sorted(suite.rows, key=lambda row: row['test'])
        pathlib.Path(options.json).write_text(''.join(json.dumps(row) + '\n' for row in rows))
    print(f'acceptance: {len(chosen)} tests in {time.monotonic() - start:.0f} s')
    return finish(options.summary, len(chosen) - failed, failed, 0)


if __name__ == '__main__':
    sys.exit(main())
