#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures what docs/choosing-cones.md states, and writes its tables: a minute on one core, default weights.

The program makes the meshes 'figure' and 'mask'; the others are expected beside the repository (../shared).

  cones.py                  all tables
  cones.py --program FILE   the command line to run (build/orbitutte)
"""
import argparse
import itertools
import json
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / 'shared' / 'meshes'
PAGE = ROOT / 'docs' / 'choosing-cones.md'

# Vertices of the figure of 20,000 triangles.
HEAD, LEFT_HAND, RIGHT_HAND, LEFT_FOOT, RIGHT_FOOT, CHEST, BACK, BELLY = 8714, 5345, 7832, 9540, 7718, 1625, 8338, 2905
PLACES = [('head, left hand, right foot', (HEAD, LEFT_HAND, RIGHT_FOOT)), ('both feet, head', (LEFT_FOOT, RIGHT_FOOT, HEAD)),
          ('both hands, head', (LEFT_HAND, RIGHT_HAND, HEAD)), ('chest, back, belly', (CHEST, BACK, BELLY))]
SPOT, IGEA, FACE, FACE_INSIDE = (11505, 2648, 3517), (130883, 74314, 0), (11, 270, 774), 3686
TRIANGLES, LUNES = ['532', '432', '332', '222', '223', '225', '2,2,10'], ['22', '33', '55']


class Program:
    def __init__(self, path, folder):
        self.path, self.folder = path, pathlib.Path(folder)

    def sample(self, shape, faces=20000):
        path = self.folder / f'{shape}.ply'
        subprocess.run([self.path, 'sample', '--shape', shape, '--faces', str(faces), '-o', path], check=True, stderr=subprocess.DEVNULL)
        return path

    def embed(self, mesh, symbol, cones, weights='standard'):
        """The report. Exit codes 4 and 5 count as results."""
        words = ['embed', mesh, '--orbifold', symbol, '--cones', ','.join(map(str, cones)), '--weights', weights, '--json', '--quiet']
        done = subprocess.run([self.path, *map(str, words)], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, check=False)
        if done.returncode not in (0, 4, 5):
            raise SystemExit(f'{" ".join(map(str, words))}: exit code {done.returncode}: {done.stderr.strip()}')
        return json.loads(done.stdout)


def number(value):
    return f'{value:.3g}' if value < 1000 else f'{value:.2g}'


def measures(report):
    """Mean, median and largest area distortion, mean angle distortion."""
    area, angle = report['distortion']['area'], report['distortion']['angle']
    return [number(area['mean']), number(area['median']), number(area['max']), f'{angle["mean"]:.3f}']


def verdict(report):
    certificate = report['certificate']
    if certificate['bijective']:
        return 'yes'
    turned, failed = len(certificate['nonpositive_faces']), [check['name'] for check in certificate['checks'] if not check['passed']]
    return f'no ({turned} faces)' if turned else f'no ({", ".join(failed)})'


def escaped(symbol):
    return symbol.replace('*', r'\*')


def table(header, rows):
    lines = [header, ['---'] * len(header), *rows]
    return '\n'.join('| ' + ' | '.join(map(str, line)) + ' |' for line in lines)


def orders_table(program):
    meshes = [('figure', program.sample('figure'), (HEAD, LEFT_HAND, RIGHT_FOOT)), ('spot', SHARED / 'spot.obj', SPOT),
              ('igea', SHARED / 'igea.ply', IGEA)]
    rows = []
    for symbol in TRIANGLES + LUNES:
        row = [symbol]
        for _, mesh, cones in meshes:
            mean, median, _, angle = measures(program.embed(mesh, symbol, cones[:2] if symbol in LUNES else cones))
            row += [f'{mean} ({median})', angle]
        rows.append(row)
    return table(['orbifold', *(f'{name}: {what}' for name, _, _ in meshes for what in ('area', 'angle'))], rows)


def assignment_table(program):
    mesh = program.sample('figure')
    rows = [['/'.join(map(str, orders)), *measures(program.embed(mesh, ''.join(map(str, orders)), (HEAD, LEFT_HAND, RIGHT_FOOT)))]
            for orders in itertools.permutations((2, 3, 5))]
    return table(['orders at head/left hand/right foot', 'area, mean', 'median', 'max', 'angle'], rows)


def places_table(program):
    mesh = program.sample('figure')
    rows = [[name, *measures(report), verdict(report)] for name, cones in PLACES for report in [program.embed(mesh, '332', cones)]]
    return table(['cones', 'area, mean', 'median', 'max', 'angle', 'certified'], rows)


def disks_table(program):
    face = SHARED / 'face.obj'
    rows = []
    for symbol in ['*532', '*432', '*332', '*222', '*225', '*22', '*33', '3*2', '2*2', '2*5', '2*', '3*', '5*']:
        cones = FACE if len(symbol) == 4 else FACE[:2] if symbol[0] == '*' else (FACE_INSIDE,) if symbol[-1] == '*' else (FACE_INSIDE, FACE[0])
        where = {3: 'three corners', 2: 'two corners', 1: 'one inside'}[len(cones)] if '*' in symbol[::len(symbol) - 1] else 'one inside, one corner'
        rows.append([escaped(symbol), where, *measures(program.embed(face, symbol, cones))])
    return table(['orbifold', 'marked', 'area, mean', 'median', 'max', 'angle'], rows)


def resolution_table(program):
    octocat = SHARED / 'octocat.off'
    rows = [[symbol, weights, *measures(report), verdict(report)] for symbol in ('532', '432', '222') for weights in ('delaunay', 'cotan', 'uniform')
            for report in [program.embed(octocat, symbol, (2598, 1371, 118), weights)]]
    return table(['orbifold', 'weights', 'area, mean', 'median', 'max', 'angle', 'certified'], rows)


TABLES = {'orders': orders_table, 'assignment': assignment_table, 'places': places_table, 'disks': disks_table, 'resolution': resolution_table}


def write(page, name, text):
    begin, end = f'<!-- {name}: written by experiments/cones.py -->', f'<!-- end of {name} -->'
    changed, count = re.subn(f'{re.escape(begin)}\n.*?{re.escape(end)}', lambda _: f'{begin}\n{text}\n{end}', page, flags=re.DOTALL)
    if count != 1:
        raise SystemExit(f'{PAGE.name} has {count} places for the table {name}')
    return changed


def main():
    parser = argparse.ArgumentParser(description='Writes the tables of docs/choosing-cones.md.')
    parser.add_argument('--program', default=ROOT / 'build' / 'orbitutte')
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        program = Program(arguments.program, folder)
        page = PAGE.read_text(encoding='utf-8')
        for name, make in TABLES.items():
            page = write(page, name, make(program))
        PAGE.write_text(page, encoding='utf-8')


if __name__ == '__main__':
    main()
