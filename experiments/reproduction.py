#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Measures what docs/reproduction.md states and writes its tables, with the paper's weights throughout. Needs numpy.

The program makes some of the meshes; the others are expected beside the repository (../shared). If they are missing, only the first
table can be made.

  reproduction.py                  all tables, a minute or two on two cores
  reproduction.py --table cuts     only this one: families, meshes, areas, cuts, convergence
  reproduction.py --program FILE   the command line to run (build/orbitutte)
"""
import argparse
import json
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
MESHES = ROOT.parent / 'shared' / 'meshes'
PAGE = ROOT / 'docs' / 'reproduction.md'

SAMPLES = {'figure': 20000, 'mask': 8000, 'boy': 20000}  # shape and number of faces
FAMILIES = [('532', 'figure'), ('432', 'figure'), ('332', 'figure'), ('225', 'figure'), ('55', 'figure'),
            ('*532', 'mask'), ('*432', 'mask'), ('*332', 'mask'), ('*225', 'mask'), ('*33', 'mask'),
            ('3*2', 'mask'), ('2*5', 'mask'), ('5*', 'mask'), ('3x', 'boy')]
SEEDS = range(6)  # of the compared cuts
CUT_FAMILIES = [(symbol, shape) for symbol, shape in FAMILIES if not symbol.startswith('*')]  # an orbifold with mirrors only needs no cut
CONVERGENCE = ('spot.obj', '432')


# Running


class Program:
    """The command line, and a folder for its output."""

    def __init__(self, path, folder):
        self.path, self.folder = path, pathlib.Path(folder)

    def run(self, *arguments, codes=(0,)):
        done = subprocess.run([self.path, *map(str, arguments)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode not in codes:
            raise SystemExit(f"orbitutte {' '.join(map(str, arguments))}: exit code {done.returncode}: {done.stderr.strip()}")
        return done.stdout

    def sample(self, shape):
        path = self.folder / f'{shape}.ply'
        if not path.exists():
            self.run('sample', '--shape', shape, '--faces', SAMPLES[shape], '-o', path)
        return path

    def embed(self, mesh, symbol, cones='extremities', seed=0):
        """The report and the file of the embedding. Exit codes 4 and 5 count as results."""
        embedding = self.folder / 'map.ply'
        output = self.run('embed', mesh, '--orbifold', symbol, '--cones', cones, '--weights', 'cotan', '--cut-seed', seed, '--quiet',
                          '--json', '-o', embedding, codes=(0, 4, 5))
        return json.loads(output), embedding


def shared_meshes():
    """Name, path, symbol (432 or *432) and marked vertices of each shared mesh, the smallest first."""
    rows = [line.split('\t') for line in (MESHES / 'cones.tsv').read_text(encoding='utf-8').splitlines()[1:]]
    return [(name, MESHES / name, '432' if topology == 'sphere' else '*432', marked)
            for name, _, faces, topology, marked, _ in sorted(rows, key=lambda row: int(row[2]))]


def cones_of(name):
    return next(marked for mesh, _, _, marked in shared_meshes() if mesh == name)


# Two embeddings of one mesh


def read_embedding(path):
    """Positions (n x 3), source vertices (n) and triangles (m x 3)."""
    data = path.read_bytes()
    start = data.index(b'end_header\n') + len(b'end_header\n')
    header = data[:start].decode()
    vertices, faces = (int(re.search(rf'element {name} (\d+)', header)[1]) for name in ('vertex', 'face'))
    vertex = np.frombuffer(data, [('position', '<f8', 3), ('source', '<i4')], vertices, start)
    face = np.frombuffer(data, [('count', 'u1'), ('corners', '<i4', 3)], faces, start + vertex.nbytes)
    return vertex['position'], vertex['source'], face['corners']


def generated_group(report):
    """All elements (|G| x 3 x 3) of the group that the seams generate."""
    elements = [np.eye(3)]
    generators = [np.array(seam['transform']) for seam in report['seams']]
    for element in elements:  # the list grows during the loop
        for generator in generators:
            product = element @ generator
            if min(np.abs(product - other).max() for other in elements) > 1e-6:
                elements.append(product)
    return np.array(elements)


def isometry_between(points, images):
    """The element R of O(3), rotation or reflection, that brings R * point nearest to the images (Kabsch 1976). Points and images are n x 3."""
    left, values, right = np.linalg.svd(images.T @ points)
    candidates = [left @ np.diag([1, 1, sign]) @ right for sign in (1, -1)]
    return min(candidates, key=lambda R: np.linalg.norm(points @ R.T - images))


def of_sources(positions, sources):
    """The position of one copy of every source vertex, the same copy in all embeddings of a mesh."""
    result = np.zeros((sources.max() + 1, 3))
    result[sources[::-1]] = positions[::-1]
    return result


def difference(first, second, group):
    """The largest distance over all source vertices from the first position to the orbit of the second. The isometry between the two
    embeddings is removed first: it is estimated on one triangle, then on all vertices."""
    (P, sources, faces), (Q, other_sources, other_faces) = first, second
    corners = P[faces]
    widest = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1).argmax()
    R = isometry_between(Q[other_faces[widest]], corners[widest])
    P, Q = of_sources(P, sources), of_sources(Q, other_sources)
    orbits = np.einsum('gij,nj->gni', group, P)
    for _ in range(2):
        distances = np.linalg.norm(orbits - Q @ R.T, axis=2)
        nearest = orbits[distances.argmin(axis=0), np.arange(len(P))]
        R = isometry_between(Q, nearest)
    return np.linalg.norm(nearest - Q @ R.T, axis=1).max()


# Tables


def table(header, rows):
    return '\n'.join(['| ' + ' | '.join(header) + ' |', '|' + '---|' * len(header)] + ['| ' + ' | '.join(map(str, r)) + ' |' for r in rows])


def escaped(symbol):
    return symbol.replace('*', '\\*')


def verdict(report):
    certificate = report['certificate']
    return 'yes' if certificate['bijective'] else f"no ({len(certificate['nonpositive_faces'])} faces)"


def conformality(report):
    """E over twice the tile's area: one for a conformal map."""
    return report['energy'] / (8 * math.pi / report['orbifold']['group_order'])


def numbers_of(report):
    return [f'{conformality(report):.4f}', f"{report['distortion']['angle']['mean']:.4g}", report['iterations'], report['evaluations'],
            f"{report['gradient_norm']:.1e}", verdict(report)]


NUMBERS = ['E / (2 area)', 'angle, mean', 'iterations', 'evaluations', 'gradient', 'certified']


def families_table(program):
    rows = []
    for symbol, shape in FAMILIES:
        report, _ = program.embed(program.sample(shape), symbol)
        rows.append([escaped(symbol), report['orbifold']['group_order'], shape] + numbers_of(report))
    return table(['orbifold', 'tiles', 'mesh'] + NUMBERS, rows)


def meshes_table(program):
    rows = []
    for name, path, symbol, marked in shared_meshes():
        report, _ = program.embed(path, symbol, marked)
        rows.append([name, f"{report['mesh']['faces']:,}", escaped(symbol)] + numbers_of(report))
    return table(['mesh', 'faces', 'orbifold'] + NUMBERS, rows)


def where_lower(pairs):
    """Counts the meshes on which each measure of area distortion is lower on the sphere."""
    counts = [f"{key} on {sum(sphere['area'][key] < plane['area'][key] for sphere, plane in pairs)}"
              for key in ('mean', 'std', 'median', 'max')]
    return f"Of the {len(pairs)} meshes the sphere has the lower {', '.join(counts)}."


def areas_table(program):
    meshes = [(f'{shape}, generated', program.sample(shape), 'extremities') for shape in ('figure', 'mask')]
    meshes += [(name, path, marked) for name, path, _, marked in shared_meshes()]
    rows, pairs = [], []
    for name, path, marked in meshes:
        result = json.loads(program.run('compare', path, '--cones', marked, '--weights', 'cotan', '--json', codes=(0, 5)))
        sides = result['maps']
        pairs.append(sides)
        rows.append([name] + [f'{side["area"][key]:.4g}' for key in ('mean', 'std', 'median', 'max') for side in sides] +
                    [f'{side["angle"]["mean"]:.4g}' for side in sides] + [', '.join('yes' if side['bijective'] else 'no' for side in sides)])
    columns = [f'{key}, {side}' for key in ('mean', 'std', 'median', 'max', 'angle') for side in ('S', 'E')]
    return table(['mesh'] + columns + ['certified'], rows) + '\n\n' + where_lower(pairs)


def cuts_row(program, name, path, symbol, marked):
    lengths, energies, embeddings, cuts = [], [], [], set()
    for seed in SEEDS:
        report, file = program.embed(path, symbol, marked, seed)
        banks = [seam['left'] for seam in report['seams'] if seam['left'] != seam['right']]
        cuts.add(json.dumps(banks))
        lengths.append(sum(len(bank) - 1 for bank in banks))
        energies.append(report['energy'])
        embeddings.append(read_embedding(file))
        if seed == 0:
            group = generated_group(report)
    worst = max(difference(embeddings[0], other, group) for other in embeddings[1:])
    return [name, escaped(symbol), len(cuts), f'{min(lengths)} to {max(lengths)}', f'{(max(energies) - min(energies)) / energies[0]:.1e}',
            f'{worst:.1e}']


def cuts_table(program):
    rows = [cuts_row(program, shape, program.sample(shape), symbol, 'extremities') for symbol, shape in CUT_FAMILIES]
    rows += [cuts_row(program, name, path, symbol, marked) for name, path, symbol, marked in shared_meshes() if symbol == '432']
    return table(['mesh', 'orbifold', 'different cuts', 'their edges', 'E, relative difference', 'positions, largest difference'], rows)


def convergence_table(program):
    name, symbol = CONVERGENCE
    history = program.embed(MESHES / name, symbol, cones_of(name))[0]['history']
    last = history[-1]['energy']
    rows = [[k, f"{entry['energy']:.12f}", f"{(entry['energy'] - last) / last:.1e}", f"{entry['gradient_norm']:.1e}", f"{entry['step']:.1e}"]
            for k, entry in enumerate(history)]
    return table(['iteration', 'E', '(E - last) / last', 'gradient', 'step'], rows)


TABLES = {'families': families_table, 'meshes': meshes_table, 'areas': areas_table, 'cuts': cuts_table, 'convergence': convergence_table}


def replace_section(text, name, content):
    begin, end = f'<!-- {name}: written by experiments/reproduction.py -->', f'<!-- end of {name} -->'
    pattern = re.compile(re.escape(begin) + '.*?' + re.escape(end), re.S)
    if not pattern.search(text):
        raise SystemExit(f'{PAGE.name} has no place for "{name}"')
    return pattern.sub(lambda _: f'{begin}\n{content}\n{end}', text)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('--table', choices=TABLES)
    parser.add_argument('--program', type=pathlib.Path, default=ROOT / 'build' / 'orbitutte')
    arguments = parser.parse_args()
    chosen = [arguments.table] if arguments.table else list(TABLES)
    if not MESHES.exists() and chosen != ['families']:
        raise SystemExit(f'the meshes are missing: {MESHES}; without them: --table families')
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.program, folder)
        for name in chosen:
            print(name, file=sys.stderr)
            content = TABLES[name](program)
            PAGE.write_text(replace_section(PAGE.read_text(encoding='utf-8'), name, content), encoding='utf-8')


if __name__ == '__main__':
    main()
