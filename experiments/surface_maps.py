#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures what docs/surface-maps.md states: maps between the pairs of surfaces that are expected beside the repository (../shared/pairs), against
points that are known to correspond and were not landmarks.

  surface_maps.py                  all pairs and the identity
  surface_maps.py --orders N       also N random orders of the cuts for each pair, which have to end in the same map or in a warning
  surface_maps.py --only bodies    one of them
  surface_maps.py --program FILE   the command line to run (build/orbitutte)
"""
import argparse
import json
import pathlib
import random
import subprocess
import tempfile
import time

import numpy as np

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / 'shared'
# The pair, a word for the choice, and rows of its table of landmarks (None: all).
CHOICES = [('bodies', 'five', None), ('bodies', 'four', (0, 1, 3, 4)), ('bodies', 'three', (0, 1, 3)), ('hands', 'five', None),
           ('cat_horse', 'nose, tail, feet', (14, 12, 9, 3, 7, 5)), ('cat_horse', 'seven', (14, 12, 9, 3, 7, 5, 0))]
# Meshes that are mapped onto themselves, the cuts being others.
IDENTITIES = ['my_man_maxp.off', 'octocat.off', 'david_50k.off', 'itokawa.off']
WITHIN = (0.05, 0.1, 0.25)


def read_off(path):
    words = path.read_text(encoding='utf-8').split()
    n, m = int(words[1]), int(words[2])
    points = np.array(words[4:4 + 3 * n], float).reshape(n, 3)
    faces = np.array(words[4 + 3 * n:4 + 3 * n + 4 * m], int).reshape(m, 4)[:, 1:]
    return points, faces


def area(points, faces):
    a, b, c = (points[faces[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def table(path):
    return np.loadtxt(path, skiprows=1, dtype=int)


class Run:
    def __init__(self, program, a, b, landmarks, *options):
        self.folder = tempfile.TemporaryDirectory()
        out = pathlib.Path(self.folder.name)
        listed = ','.join(f'{v}:{w}' for v, w in landmarks)
        begin = time.time()
        done = subprocess.run([program, 'map', a, b, '--landmarks', listed, '-o', out, '--quiet', *map(str, options)], check=False,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        self.seconds, self.code, self.messages = time.time() - begin, done.returncode, done.stderr.strip()
        self.json = json.loads((out / 'map.json').read_text(encoding='utf-8')) if (out / 'map.json').exists() else None
        self.images = np.loadtxt(out / 'a_to_b.txt') if (out / 'a_to_b.txt').exists() else None

    def images_on(self, points, faces):
        corners = points[faces[self.images[:, 0].astype(int)]]
        return (corners * self.images[:, 1:, None]).sum(axis=1)


def describe(run):
    if run.json is None:
        return f'exit code {run.code}: {run.messages}'
    found = run.json
    target = found['target']
    text = (f'exit {run.code}, {target["signature"]} {target["tile"]}, E/2A {target["conformality"][0]:.4f} {target["conformality"][1]:.4f}, '
            f'class {target["class"]["distance"]:.3f} of {target["class"]["next_distance"]}, {target["class"]["half_twists"]} half twists, '
            f'{run.seconds:.1f} s')
    if found.get('distortion'):
        text += (f', symmetric Dirichlet median {found["distortion"]["median"]:.3f} 90 % {found["distortion"]["percentile_90"]:.3g}, '
                 f'within 4: {found["distortion"]["within_4"]:.3f}')
    return text + ''.join(f'\n    {line}' for line in run.messages.splitlines())


def measure_pair(arguments, name, word, rows):
    folder = SHARED / 'pairs' / name
    landmarks = table(folder / 'landmarks.tsv')
    chosen = landmarks if rows is None else landmarks[list(rows)]
    truth = folder / 'truth.tsv'
    held = table(truth) if truth.exists() else np.array([row for row in landmarks if row.tolist() not in chosen.tolist()], int).reshape(-1, 2)
    run = Run(arguments.program, folder / 'a.off', folder / 'b.off', chosen)
    print(f'{name}, {word}: {describe(run)}', flush=True)
    points, faces = read_off(folder / 'b.off')
    size = np.sqrt(area(points, faces))
    first = None
    if run.images is not None:
        first = run.images_on(points, faces)
        if len(held):
            errors = np.linalg.norm(first[held[:, 0]] - points[held[:, 1]], axis=1) / size
            shares = ' '.join(f'{(errors < bound).mean():.2f}' for bound in WITHIN)
            print(f'    mean distance to the truth {errors.mean():.4f}, within {WITHIN}: {shares}', flush=True)
    draw = random.Random(1)
    for _ in range(arguments.orders if len(chosen) > 3 else 0):
        order = draw.sample(range(len(chosen)), len(chosen))
        other = Run(arguments.program, folder / 'a.off', folder / 'b.off', chosen, '--tour', ','.join(map(str, order)))
        if other.images is None or first is None:
            print(f'    order {order}: {describe(other)}', flush=True)
            continue
        away = np.linalg.norm(other.images_on(points, faces) - first, axis=1).max() / size
        half_twists = other.json['target']['class']['half_twists']
        print(f'    order {order}: at most {away:.1e} away, {half_twists} half twists, exit {other.code} {other.messages}', flush=True)


def extremities(program, path, count):
    """As many as there are cones on a flat surface."""
    angle = f'{2 - 4 / count}pi'
    done = subprocess.run([program, 'embed', path, '--orbifold', 'cones', '--cones', 'extremities', '--angles', ','.join([angle] * count), '--json', '--quiet'],
                          check=False, stdout=subprocess.PIPE, text=True)
    return [cone['vertex'] for cone in json.loads(done.stdout)['cones']]


def measure_identity(arguments, mesh):
    path = SHARED / 'meshes' / mesh
    landmarks = extremities(arguments.program, path, 8)
    for count in (3, 4, 5, 8):
        run = Run(arguments.program, path, path, [(v, v) for v in landmarks[:count]], '--cut-seed-b', 7)
        print(f'{mesh} onto itself, {count} landmarks: {describe(run)}', flush=True)
        if run.images is None:
            continue
        points, faces = read_off(path)
        away = np.linalg.norm(run.images_on(points, faces) - points, axis=1).max() / np.sqrt(area(points, faces))
        print(f'    displacement at most {away:.1e}', flush=True)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('--program', default=str(ROOT / 'build' / 'orbitutte'))
    parser.add_argument('--orders', type=int, default=0)
    parser.add_argument('--only', default='')
    arguments = parser.parse_args()
    for choice in CHOICES:
        if arguments.only in ('', choice[0]):
            measure_pair(arguments, *choice)
    for mesh in IDENTITIES:
        if arguments.only in ('', mesh):
            measure_identity(arguments, mesh)


if __name__ == '__main__':
    main()
