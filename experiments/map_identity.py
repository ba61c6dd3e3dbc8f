#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Measures what docs/surface-maps.md states about maps that are known: every shared mesh that is a sphere or a disk onto itself, with two
different cuts; the pairs of surfaces there and back again; and the pairs with other cuts. Distances are in square roots of the area.

  map_identity.py                       all of it
  map_identity.py identity|back|cuts    one part
  map_identity.py identity --only spot --counts 3,5

Needs the package on PYTHONPATH (build/python), and the meshes and pairs that are expected beside the repository (../shared): without them it
says so and does nothing.
"""
import argparse
import pathlib
import time
import warnings

import numpy as np

import orbitutte

ROOT = pathlib.Path(__file__).resolve().parent.parent
SHARED = ROOT.parent / 'shared'
BOUND_OF_IDENTITY, BOUND_OF_RETURN, BOUND_OF_CUTS = 1e-7, 1e-9, 1e-6
COUNTS = (3, 4, 5, 8)
# On disks: landmarks inside and on the boundary.
KINDS = ((0, 3), (0, 4), (1, 1), (0, 5), (2, 3))
CHOICES = (('bodies', 'four', (0, 1, 3, 4)), ('bodies', 'five', None), ('hands', 'five', None), ('cat_horse', 'six', (14, 12, 9, 3, 7, 5)),
           ('cat_horse', 'eight', (14, 12, 9, 3, 7, 5, 15, 16)))
RETURNING = ('spot.obj', 'david_50k.off')  # onto themselves, there and back


def area(V, F):
    a, b, c = (V[F[:, k]] for k in range(3))
    return np.linalg.norm(np.cross(b - a, c - a), axis=1).sum() / 2


def triangles_of(F):
    """Faces as an array, or nothing if some are no triangles."""
    array = np.asarray(F)
    return array if array.ndim == 2 and array.shape[1] == 3 else None


def placed(V, F, points):
    triangle, weights = points
    return (V[F[triangle]] * weights[:, :, None]).sum(axis=1)


def used_vertices(V, F):
    used = np.zeros(len(V), bool)
    used[F] = True
    return used


def map_of(A, B, landmarks, seeds):
    """The map, the sentences that it comes with, and the seconds that it took."""
    begin = time.time()
    with warnings.catch_warnings(record=True) as told:
        warnings.simplefilter('always')
        found = orbitutte.map_between(A, B, landmarks, cut_seeds=seeds)
    return found, [str(one.message) for one in told], time.time() - begin


def boundary_loop(F):
    """The vertices of the boundary, in order."""
    edges = {(int(f[k]), int(f[(k + 1) % 3])) for f in F for k in range(3)}
    following = {a: b for a, b in edges if (b, a) not in edges}
    loop = [next(iter(following))]
    while following[loop[-1]] != loop[0]:
        loop.append(following[loop[-1]])
    return loop


def spread_on_disk(V, F, inside, on_boundary):
    """Landmarks in equal steps along the boundary, and inside where it is far from these, the boundary and each other."""
    loop = boundary_loop(F)
    steps = np.linalg.norm(V[np.roll(loop, -1)] - V[loop], axis=1)
    along = np.concatenate([[0], np.cumsum(steps)[:-1]]) / steps.sum()
    chosen = [loop[int(np.abs(along - (k + 0.1) / on_boundary).argmin())] for k in range(on_boundary)]
    far = np.full(len(V), np.inf)
    for v in loop[::max(1, len(loop) // 200)]:
        far = np.minimum(far, np.linalg.norm(V - V[v], axis=1))
    far[loop] = -1
    far[~used_vertices(V, F)] = -1
    for _ in range(inside):
        v = int(far.argmax())
        chosen.insert(0, v)
        far = np.minimum(far, np.linalg.norm(V - V[v], axis=1))
    return chosen


def landmarks_of(V, F, topology):
    """Pairs of a word and vertices."""
    if topology == 'sphere':
        far = orbitutte.choose_cones(V, F, '2,2,2,2,2,2,2,2')
        return [(str(count), far[:count]) for count in COUNTS]
    return [(f'{inside} inside, {outside} on the boundary', spread_on_disk(V, F, inside, outside)) for inside, outside in KINDS]


def show(name, word, value, bound, rest):
    print(f'| {name} | {word} | {value:.0e} | {"" if value <= bound else "above " + format(bound, ".0e")} | {rest} |', flush=True)


def measure_identity(name, counts):
    V, F = orbitutte.read_mesh(SHARED / 'meshes' / name)
    F = triangles_of(F)
    if F is None:
        return
    topology = orbitutte.info(V, F)['topology']
    if topology not in ('sphere', 'disk'):
        print(f'| {name} | a {topology} | | | |')
        return
    used = used_vertices(V, F)
    for word, vertices in landmarks_of(V, F, topology):
        if counts and word not in counts:
            continue
        try:
            found, told, seconds = map_of((V, F), (V, F), [(v, v) for v in vertices], (0, 7))
            away = np.linalg.norm(placed(V, F, found.to_b()) - V, axis=1)[used]
        except orbitutte.Error as error:
            print(f'| {name} | {word} | | {error} | |', flush=True)
            continue
        rest = f'{found.a.signature}, {int((away / np.sqrt(area(V, F)) > BOUND_OF_IDENTITY).sum())} vertices above, {seconds:.1f} s'
        show(name, word, away.max() / np.sqrt(area(V, F)), BOUND_OF_IDENTITY, '; '.join([rest, *told]))


def read_pair(name, rows):
    folder = SHARED / 'pairs' / name
    landmarks = np.loadtxt(folder / 'landmarks.tsv', skiprows=1, dtype=int)
    sides = [orbitutte.read_mesh(folder / f'{side}.off') for side in 'ab']
    return [(V, triangles_of(F)) for V, F in sides], landmarks if rows is None else landmarks[list(rows)]


def measure_return(name, word, sides, landmarks):
    (V, F), _ = sides
    found, told, seconds = map_of(*sides, landmarks, (0, 7))
    for of, there, back, (X, G) in (('A', found.to_b, found.to_a, sides[0]), ('B', found.to_a, found.to_b, sides[1])):
        away = np.linalg.norm(placed(X, G, back(there())) - X, axis=1)[used_vertices(X, G)] / np.sqrt(area(X, G))
        rest = f'{int((away > BOUND_OF_RETURN).sum())} vertices above, {seconds:.1f} s'
        show(name, f'{word}, from {of}', away.max(), BOUND_OF_RETURN, '; '.join([rest, *told]))


def measure_cuts(name, word, sides, landmarks):
    (V, F), (W, G) = sides
    first, _, _ = map_of(*sides, landmarks, (0, 0))
    images = placed(W, G, first.to_b())
    for seeds in ((0, 7), (3, 11), (5, 2)):
        other, told, seconds = map_of(*sides, landmarks, seeds)
        away = np.linalg.norm(placed(W, G, other.to_b()) - images, axis=1)[used_vertices(V, F)] / np.sqrt(area(W, G))
        show(name, f'{word}, cuts {seeds[0]} and {seeds[1]}', away.max(), BOUND_OF_CUTS, '; '.join([f'{seconds:.1f} s', *told]))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('part', nargs='?', default='')
    parser.add_argument('--only', default='')
    parser.add_argument('--counts', default='')
    arguments = parser.parse_args()
    if not (SHARED / 'meshes').is_dir():
        print(f'{SHARED} is not there: nothing to measure')
        return
    if arguments.part in ('', 'identity'):
        counts = [word for word in arguments.counts.split(',') if word]
        for path in sorted((SHARED / 'meshes').iterdir()):
            if path.suffix in ('.off', '.obj', '.ply') and arguments.only in path.name:
                measure_identity(path.name, counts)
    for part, measure in (('back', measure_return), ('cuts', measure_cuts)):
        if arguments.part not in ('', part):
            continue
        for name, word, rows in CHOICES:
            if arguments.only in name:
                measure(name, word, *read_pair(name, rows))
    if arguments.part in ('', 'back'):
        for name in RETURNING:
            if arguments.only in name:
                V, F = orbitutte.read_mesh(SHARED / 'meshes' / name)
                far = orbitutte.choose_cones(V, F, '2,2,2,2,2')
                measure_return(name, 'five', [(V, F)] * 2, [(v, v) for v in far])


if __name__ == '__main__':
    main()
