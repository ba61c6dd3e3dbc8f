#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Compares the weights on real meshes, as given and subdivided once at the midpoints, and writes the tables of docs/weights.md.

The meshes and their marked vertices are those of the acceptance test (../shared); if they are missing, it does nothing. Needs numpy and
a built program. Takes some minutes.

  weights_table.py --program build/orbitutte
"""
import argparse
import importlib.util
import json
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
PAGE = ROOT / 'docs' / 'weights.md'
WEIGHTS = ['cotan', 'delaunay', 'mean-value', 'uniform']


def mesh_reader(shared):
    """read_mesh of the acceptance test's checker."""
    spec = importlib.util.spec_from_file_location('verify_embedding', shared / 'check' / 'verify_embedding.py')
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module.read_mesh


def subdivided(vertices, faces):
    """Divides every triangle into four at the midpoints of its edges. The midpoints follow the old vertices."""
    n, m = len(vertices), len(faces)
    ends = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]).astype(np.int64), axis=1)
    edges, middle = np.unique(ends[:, 0] * n + ends[:, 1], return_inverse=True)
    midpoints = (vertices[edges // n] + vertices[edges % n]) / 2
    ab, bc, ca = (middle[k * m:(k + 1) * m] + n for k in range(3))
    a, b, c = faces.T
    corners = [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
    return np.concatenate([vertices, midpoints]), np.concatenate([np.stack(corner, 1) for corner in corners])


def write_obj(path, vertices, faces):
    lines = ['v %.17g %.17g %.17g' % tuple(point) for point in vertices]
    lines += ['f %d %d %d' % tuple(face) for face in faces + 1]
    path.write_text('\n'.join(lines) + '\n')


def embed(options, mesh, signature, cones, weights):
    command = [options.program, 'embed', str(mesh), '--orbifold', signature, '--cones', cones, '--weights', weights, '--json', '--quiet']
    result = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=False)
    if result.returncode not in (0, 4, 5):
        raise RuntimeError(f'exit code {result.returncode}: {command}')
    return json.loads(result.stdout)


def certified(report):
    if report['certificate']['bijective']:
        return 'yes'
    turned = len(report['certificate']['nonpositive_faces'])
    intrinsic = report.get('intrinsic_certificate', {}).get('bijective', False)
    return f'no ({turned})' + (', but intrinsically' if intrinsic else '')


def edges_changed(report):
    weights = report['weights']
    flips = f"{weights['flips']} flipped, " if 'flips' in weights else ''
    kept = f", {len(weights['kept_faces'])} faces kept" if weights.get('kept_faces') else ''
    return f"{flips}{weights['clamped_edges']} clamped{kept}"


def rows_of(options, name, mesh, signature, cones):
    reports = {weights: embed(options, mesh, signature, cones, weights) for weights in WEIGHTS}
    for weights, report in reports.items():
        distortion = report['distortion']
        yield [name if weights == WEIGHTS[0] else '', signature if weights == WEIGHTS[0] else '', weights, str(report['iterations']),
               f"{distortion['angle']['mean']:.4g}", f"{distortion['area']['mean']:.4g}", certified(report), edges_changed(report)]


def table(rows):
    head = ['mesh', 'orbifold', 'weights', 'iterations', 'angle', 'area', 'certified', 'edges']
    return '\n'.join('| ' + ' | '.join(row) + ' |' for row in [head, ['---'] * len(head), *rows])


def replace_section(text, name, content):
    begin, end = f'<!-- {name}: written by benchmarks/weights_table.py -->', f'<!-- end of {name} -->'
    pattern = re.compile(re.escape(begin) + '.*?' + re.escape(end), re.S)
    assert pattern.search(text), f'{PAGE} has no section {name}'
    return pattern.sub(lambda _: f'{begin}\n{content}\n{end}', text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--program', default=str(ROOT / 'build' / 'orbitutte'), metavar='FILE')
    parser.add_argument('--shared', default=str(ROOT.parent / 'shared'), metavar='FOLDER', help='with meshes/ and check/')
    options = parser.parse_args()
    shared = pathlib.Path(options.shared)
    if not (shared / 'meshes' / 'cones.tsv').is_file():
        print(f'weights_table: skipped, for there are no meshes in {shared} (option --shared)')
        return
    read_mesh = mesh_reader(shared)
    given, refined = [], []
    for line in (shared / 'meshes' / 'cones.tsv').read_text().splitlines()[1:]:
        mesh, _, _, topology, cones, _ = line.split('\t')
        print(mesh, file=sys.stderr)
        signature = '432' if topology == 'sphere' else '*432'
        given += rows_of(options, mesh, shared / 'meshes' / mesh, signature, cones)
        with tempfile.TemporaryDirectory() as folder:
            fine = pathlib.Path(folder) / 'fine.obj'
            vertices, faces = read_mesh(str(shared / 'meshes' / mesh))
            write_obj(fine, *subdivided(vertices, np.asarray(faces)))
            refined += rows_of(options, mesh, fine, signature, cones)
    page = replace_section(PAGE.read_text(encoding='utf-8'), 'as given', table(given))
    PAGE.write_text(replace_section(page, 'subdivided once', table(refined)), encoding='utf-8')


if __name__ == '__main__':
    main()
