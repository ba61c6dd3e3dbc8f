#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Files that the program writes, opened by the real programs that people open them with.

  blender       models (OBJ, GLB, PLY) and a tiling, imported in the background: geometry in order, texture coordinates, colours
  paraview      VTP and PLY through pvpython: arrays, cells, values
  meshlab       PLY and STL through meshlabserver: sizes, the quality. (That of Debian 12 ends with an assertion on every OBJ.)
  meshio        meshes, embeddings and tilings (OBJ, PLY, STL) read by the Python package, and its PLY read back. (Version 5
                refuses an OBJ with other texture coordinates than one for every vertex, and so every model with seams; it misreads
                binary PLY whose faces have further properties, such as the quality of models.)
  open3d        models (OBJ, PLY) read by the Python package

Not part of ./test.sh, since these programs are large: on Debian 12, 'apt-get install --no-install-recommends blender
python3-paraview meshlab xvfb python3-meshio python3-open3d'. Whatever is missing is skipped, saying so. Needs numpy.
"""
import argparse
import json
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent
REPOSITORY = FOLDER.parent.parent


class Skipped(Exception):
    """What is needed is not installed."""


def require(program):
    path = shutil.which(program)
    if not path:
        raise Skipped(f'{program} is not installed')
    return path


def run(*command, **options):
    environment = dict(os.environ, **options)
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment, timeout=600)
    if done.returncode != 0:
        raise AssertionError(f'{command[0]} ended with {done.returncode}: {(done.stdout + done.stderr)[-1500:]}')
    return done.stdout


def answers(text):
    """What a script under another program printed as JSON, among that program's own lines."""
    lines = [line for line in text.splitlines() if line.startswith('ANSWER ')]
    if len(lines) != 1:
        raise AssertionError(f'no answer in: {text[-1500:]}')
    return json.loads(lines[0][len('ANSWER '):])


def quad_sphere(n):
    """The cube's surface, n x n quadrilaterals on each side, blown up to a sphere."""
    index, V, F = {}, [], []

    def vertex(corner):
        if corner not in index:
            index[corner] = len(V)
            V.append(np.array(corner) / np.linalg.norm(corner))
        return index[corner]

    for axis in range(3):
        for sign in (-1, 1):
            for i in range(n):
                for j in range(n):
                    quad = []
                    for a, b in ((i, j), (i + 1, j), (i + 1, j + 1), (i, j + 1)):
                        corner = [0, 0, 0]
                        corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = sign * n, 2 * a - n, 2 * b - n
                        quad.append(vertex(tuple(corner)))
                    F.append(quad if sign > 0 else quad[::-1])
    return np.array(V), F


def write_obj(path, V, F):
    lines = [f'v {x!r} {y!r} {z!r}' for x, y, z in V.tolist()] + ['f ' + ' '.join(str(v + 1) for v in face) for face in F]
    path.write_text('\n'.join(lines) + '\n')


def read_obj(path):
    """Positions, and for every face its vertices and the texture coordinates of its corners."""
    V, T, faces, corners = [], [], [], []
    for line in path.read_text().splitlines():
        word, *rest = line.split() or ['']
        if word == 'v':
            V.append([float(x) for x in rest[:3]])
        elif word == 'vt':
            T.append([float(x) for x in rest[:2]])
        elif word == 'f':
            pairs = [corner.split('/') for corner in rest]
            faces.append([int(pair[0]) - 1 for pair in pairs])
            corners.append([int(pair[1]) - 1 for pair in pairs if len(pair) > 1])
    return np.array(V), faces, [[T[t] for t in face] for face in corners]


class Files:
    """Two meshes, one of triangles and one of quadrilaterals, with their models and tilings."""

    def __init__(self, program, folder):
        self.folder, self.program = folder, program
        run(program, 'sample', '--faces', 3000, '-o', folder / 'triangles.obj')
        write_obj(folder / 'quads.obj', *quad_sphere(12))
        for name in ('triangles', 'quads'):
            mesh, embedding, report = folder / f'{name}.obj', folder / f'{name}-map.ply', folder / f'{name}.json'
            run(program, 'embed', mesh, '--orbifold', '332', '--cones', 'extremities', '-o', embedding, '--report', report, '--quiet')
            for ending in ('obj', 'glb', 'ply', 'vtp'):
                run(program, 'export', embedding, report, mesh, '-o', folder / f'{name}-model.{ending}')
            for ending in ('obj', 'glb', 'ply', 'stl'):
                run(program, 'tile', embedding, report, '-o', folder / f'{name}-tiling.{ending}')
        self.sizes = {}
        for name in ('triangles', 'quads'):
            V, faces, _ = read_obj(folder / f'{name}.obj')
            self.sizes[name] = (len(V), len(faces))

    def mesh(self, name):
        return read_obj(self.folder / f'{name}.obj')

    def model(self, name):
        return read_obj(self.folder / f'{name}-model.obj')


def same(a, b, tolerance, what):
    a, b = np.asarray(a, float), np.asarray(b, float)
    assert a.shape == b.shape, f'{what}: {a.shape} instead of {b.shape}'
    worst = float(np.abs(a - b).max()) if a.size else 0.0
    assert worst <= tolerance, f'{what}: off by {worst}'


def blender(files):
    require('blender')
    seen = answers(run('blender', '-b', '--factory-startup', '--python-exit-code', 1, '--python', FOLDER / 'in_blender.py', '--',
                       files.folder))
    for name in ('triangles', 'quads'):
        V, faces, _ = files.mesh(name)
        corners = files.model(name)[2]
        obj, ply, glb, tiling = (seen[f'{name}-model.obj'], seen[f'{name}-model.ply'], seen[f'{name}-model.glb'],
                                 seen[f'{name}-tiling.glb'])
        same(obj['positions'], V, 1e-6, f'{name}: positions in the OBJ')
        assert obj['faces'] == faces, f'{name}: other faces in the OBJ'
        same(obj['uv'], [uv for face in corners for uv in face], 1e-6, f'{name}: texture coordinates in the OBJ')
        same(ply['positions'], V, 1e-6, f'{name}: positions in the PLY')
        assert ply['faces'] == faces, f'{name}: other faces in the PLY'
        assert glb['colours'] and glb['triangles'] == sum(len(face) - 2 for face in faces), f'{name}: the GLB is not whole'
        assert len(glb['uv']) == 3 * glb['triangles'], f'{name}: the GLB has corners without texture coordinates'
        assert tiling['triangles'] == 12 * glb['triangles'], f'{name}: the tiling has {tiling["triangles"]} triangles'
    return '8 files'


def paraview(files):
    seen = answers(run(require('pvpython'), '--force-offscreen-rendering', FOLDER / 'in_paraview.py', files.folder))
    for name in ('triangles', 'quads'):
        vertices, faces = files.sizes[name]
        vtp, ply = seen[f'{name}-model.vtp'], seen[f'{name}-model.ply']
        assert vtp['cells'] == ply['cells'] == faces and ply['points'] == vertices, f'{name}: other sizes'
        assert {'sphere', 'texture', 'source_vertex'} <= set(vtp['point_arrays']), vtp['point_arrays']
        assert {'log2_area', 'angle'} <= set(vtp['cell_arrays']), vtp['cell_arrays']
        assert abs(vtp['radius'][0] - 1) < 1e-12 and abs(vtp['radius'][1] - 1) < 1e-12, vtp['radius']
        assert vtp['source_vertices'] == [0, vertices - 1], vtp['source_vertices']
    return '4 files'


def meshlab(files):
    program, screen = require('meshlabserver'), require('xvfb-run')
    def convert(model):
        out = files.folder / f'{model}-meshlab.ply'
        run(screen, '-a', program, '-i', files.folder / model, '-o', out, '-m', 'vq')
        return ply_sizes(out)

    for name in ('triangles', 'quads'):
        triangles = sum(len(face) - 2 for face in files.mesh(name)[1])
        vertices, faces, has_quality = convert(f'{name}-model.ply')
        assert (vertices, faces) in ((files.sizes[name][0], n) for n in (triangles, files.sizes[name][1])), (vertices, faces)
        assert has_quality, f'{name}: no quality'
        vertices, faces, _ = convert(f'{name}-tiling.stl')
        assert faces == 12 * triangles and 2 * vertices == faces + 4, f'{name}: the tiling is no sphere: {vertices}, {faces}'
    return '4 files'


def ply_sizes(path):
    header = path.read_bytes().split(b'end_header')[0].decode().splitlines()
    sizes = {line.split()[1]: int(line.split()[2]) for line in header if line.startswith('element')}
    return sizes['vertex'], sizes['face'], any(line.endswith(' quality') for line in header)


def meshio(files):
    try:
        import meshio as package
        package.read
    except (ImportError, AttributeError):
        raise Skipped('the Python package meshio is not installed')
    for name in ('triangles', 'quads'):
        V, faces, _ = files.mesh(name)
        mesh = package.read(files.folder / f'{name}.obj')
        same(mesh.points, V, 1e-15, f'{name}: positions')
        assert [list(face) for cells in mesh.cells for face in cells.data.tolist()] == faces, f'{name}: other faces'
        embedding = package.read(files.folder / f'{name}-map.ply')
        same(np.linalg.norm(embedding.points, axis=1), np.ones(len(embedding.points)), 1e-12, f'{name}: the embedding')
        source = np.asarray(embedding.point_data['source_vertex'])
        assert [source[cell].tolist() for cell in embedding.cells[0].data] == faces, f'{name}: other faces in the embedding'
        tiling = package.read(files.folder / f'{name}-tiling.stl')
        assert len(tiling.cells[0].data) == 12 * sum(len(face) - 2 for face in faces), f'{name}: the tiling is not whole'
        back = files.folder / f'{name}-meshio.ply'
        package.write(back, package.Mesh(V, [('quad' if len(faces[0]) == 4 else 'triangle', np.array(faces))]))
        told = json.loads(run(files.program, 'info', back, '--json'))
        assert told['topology'] == 'sphere' and told['faces'] == len(faces), told
    return '6 files, and 2 of its own read back'


def open3d(files):
    try:
        from open3d import io as package
    except ImportError:
        raise Skipped('the Python package open3d is not installed')
    V, faces, _ = files.mesh('triangles')
    ply = package.read_triangle_mesh(str(files.folder / 'triangles-model.ply'))
    same(ply.vertices, V, 1e-15, 'positions in the PLY')
    assert np.asarray(ply.triangles).tolist() == faces, 'other faces in the PLY'
    obj = package.read_triangle_mesh(str(files.folder / 'triangles-model.obj'))  # with vertices of its own along the seams
    same(np.asarray(obj.vertices)[np.asarray(obj.triangles)], V[faces], 1e-6, 'corners in the OBJ')
    same(obj.triangle_uvs, [uv for face in files.model('triangles')[2] for uv in face], 1e-6, 'texture coordinates in the OBJ')
    return '2 files'


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--program', type=pathlib.Path, default=REPOSITORY / 'build/orbitutte')
    arguments = parser.parse_args()
    counts = {'passed': 0, 'failed': 0, 'skipped': 0}
    with tempfile.TemporaryDirectory() as folder:
        files = Files(arguments.program.resolve(), pathlib.Path(folder))
        for test in (blender, paraview, meshlab, meshio, open3d):
            try:
                kind, words = 'passed', test(files)
            except Skipped as reason:
                kind, words = 'skipped', str(reason)
            except AssertionError as fault:
                kind, words = 'failed', str(fault)
            counts[kind] += 1
            print(f'{kind:8}{test.__name__}: {words}', flush=True)
    print(', '.join(f'{count} {kind}' for kind, count in counts.items()))
    return counts['failed'] > 0


if __name__ == '__main__':
    sys.exit(main())
