#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What `best` is worth: against an exhaustive search, against extremities, and against its own neighbours.

  best_cones.py MESH ... [--families 432,223,...] [--solved 50] [--candidates 40] [--around 4] -o TABLE.md   (PYTHONPATH=build/python)

Two tables, by one thread. A row for each mesh and family:
  best         sigma of the embedding that `orbitutte.embed(V, F, family, "best")` gives
  exhaustive   the least sigma of the embeddings of the `solved` best choices among all of the farthest-point candidates, every
               arrangement of the orders, as the closed form ranks them (here in NumPy, on its own)
  neighbours   the least sigma when one cone is moved by one, two, four or eight rings and the surface embedded again, `around`
               vertices of each ring
  extremities  sigma of the family at extremities
A row for each mesh: what `orbitutte.embed(V, F)` takes, its sigma, that of 432 (*432) at extremities, and the shares of the surface
that shrink by more than 64.
A limb that doubles do not resolve has no place in the closed form here: its samples are left out of the ranking, not of the embeddings.
--known TABLE.md ... takes the exhaustive search from earlier tables, since it does not depend on what `best` takes.
--join TABLE.md ... writes the tables of several runs as one: a row for each mesh, as in docs/choosing-cones.md, and all rows below.
"""
import argparse
import itertools
import math
import pathlib
import warnings

import numpy as np

import orbitutte

SPHERES = ['532', '432', '332', '222', '223', '22']
DISKS = ['*532', '*432', '*332', '*222', '*223', '3*2', '2*2', '2*3', '2*', '3*']
SAMPLES, COARSE = 300, 100
ROWS_HEAD = ['mesh', 'family', 'best', 'exhaustive', 'neighbours', 'extremities']
WHOLE_HEAD = ['mesh', 'taken', 'sigma', '432 at extremities', 'below 1/64', '432: below 1/64']


def chart(map222):
    """Z of every input vertex, as numerator and denominator, from positions in the canonical frame."""
    positions = map222.canonical_positions
    x, y, z = positions.T
    upper = z >= 0
    a = np.where(upper, x + 1j * y, 1 - z + 0j)
    b = np.where(upper, 1 + z + 0j, x - 1j * y)
    Z = np.stack([(a * a + b * b) ** 2, 4 * (a * b) ** 2], axis=1)
    return Z / np.abs(Z).max(axis=1, keepdims=True)


def bracket(p, q):
    return p[..., 0] * q[..., 1] - q[..., 0] * p[..., 1]


def series(p, q, c, terms=16):
    """Coefficients of 2F1(p, q; c; z) in powers of w, z = 4 w/(1 + w)^2, from those in powers of z."""
    from fractions import Fraction as Q
    h, f = [Q(1)], [Q(0)] * terms
    p, q, c = (Q(value).limit_denominator(10**6) for value in (p, q, c))
    for n in range(terms - 1):
        h.append(h[-1] * (p + n) * (q + n) / ((c + n) * (n + 1)))
    for n, coefficient in enumerate(h):  # z^n = (4 w)^n (1 + w)^(-2 n)
        term = Q(4) ** n
        for k in range(terms - n):
            f[n + k] += coefficient * term
            term *= Q(-(2 * n + k), k + 1)
    return np.array([float(value) for value in f])


def gauss(p, q, c):
    return math.gamma(c) * math.gamma(c - p - q) / (math.gamma(c - p) * math.gamma(c - q))


class Metric:
    """The spherical metric with three cones, for coordinates P whose sum is zero."""

    def __init__(self, angles):
        self.angles, self.numberings = angles, {}
        for i, j, k in itertools.permutations(range(3)):
            a, b, g = angles[i], angles[j], angles[k]
            p, q = (1 - a - b - g) / 2, (1 - a - b + g) / 2
            cosine = (math.cos(math.pi * g) + math.cos(math.pi * a) * math.cos(math.pi * b)) / (math.sin(math.pi * a) * math.sin(math.pi * b))
            C = math.tan(math.acos(max(-1, min(1, cosine))) / 2) * gauss(p, q, 1 - a) / gauss(p + a, q + a, 1 + a)
            self.numberings[i, j, k] = a, b, C, series(p, q, 1 - a), series(p + a, q + a, 1 + a)

    def log_scale(self, P):
        result, order = np.empty(P.shape[0]), np.argsort(np.abs(P), axis=1)
        for (i, j, k), (a, b, C, F1, F2) in self.numberings.items():
            rows = (order == (i, j, k)).all(axis=1)
            z = -P[rows, i] / P[rows, k]
            w = z / (1 + np.sqrt(1 - z)) ** 2
            F1, F2 = np.polyval(F1[::-1], w), np.polyval(F2[::-1], w)
            result[rows] = (np.log(2 * C * a) + (a - 1) * np.log(np.abs(z)) + (b - 1) * np.log(np.abs(1 - z)) - 2 * np.log(np.abs(P[rows, k]))
                            - np.log(np.abs(F1) ** 2 + C**2 * np.abs(z) ** (2 * a) * np.abs(F2) ** 2))
        return result


class Ranking:
    """sigma of many choices at once, by the closed form."""

    def __init__(self, base, samples, places):
        """base: the part of u that no choice changes; places: the chart's points of all cones that may be chosen."""
        self.base = base
        self.to_samples = bracket(places[:, None], samples[None, :])
        self.between = bracket(places[:, None], places[None, :])

    def three_cones(self, metric, cones):
        """cones: m x 3, rows of places."""
        P = [self.to_samples[cones[:, i]] * self.between[cones[:, (i + 1) % 3], cones[:, (i + 2) % 3]][:, None] for i in range(3)]
        u = metric.log_scale(np.stack(P, axis=-1).reshape(-1, 3)).reshape(len(cones), -1)
        return (self.base + u).std(axis=1)

    def two_cones(self, angle, cones, shifts):
        to = [np.log(np.abs(self.to_samples[cones[:, i]])) for i in range(2)]
        return np.min([(self.base - to[0] - to[1] - np.log(np.cosh(angle * (to[0] - to[1]) + shift))).std(axis=1) for shift in shifts], axis=0)


class Surface:
    def __init__(self, path, candidates):
        self.V, self.F = orbitutte.read_mesh(path)
        self.solver = orbitutte.Solver(self.V, self.F, threads=1)
        self.is_disk = orbitutte.info(self.V, self.F)['topology'] == 'disk'
        base = self.solver.embed('*222' if self.is_disk else '222', 'extremities')
        Z = chart(base)
        self.Z = Z[:len(self.V)]
        share, ratio = self.shares(), base.area_distortion
        with np.errstate(divide='ignore', invalid='ignore'):
            middle = Z[base.faces].mean(axis=1)
            known = np.isfinite(middle).all(axis=1) & (ratio > 0) & (np.abs(middle).min(axis=1) > 1e-12)
        kept = np.flatnonzero(known)
        level = np.searchsorted(np.cumsum(share[kept]) / share[kept].sum(), (np.arange(SAMPLES) + 0.5) / SAMPLES)
        faces = kept[level]
        self.faces, self.samples = faces, middle[faces]
        old = np.stack([self.samples[:, 1], self.samples[:, 0] - self.samples[:, 1], -self.samples[:, 0]], axis=1)
        self.base = 0.5 * np.log(ratio[faces]) - Metric((0.5, 0.5, 0.5)).log_scale(old)
        self.inside, self.outside = self.farthest_points(candidates)

    def shares(self):
        a, b, c = (self.V[self.F[:, k]] for k in range(3))
        area = np.linalg.norm(np.cross(b - a, c - a), axis=1)
        return area / area.sum()

    def farthest_points(self, count):
        edges = np.concatenate([self.F[:, [k, (k + 1) % 3]] for k in range(3)])
        n = len(self.V)
        there, back = set((edges[:, 0] * n + edges[:, 1]).tolist()), edges[:, 1] * n + edges[:, 0]
        lonely = edges[[code not in there for code in back.tolist()]]
        boundary = np.zeros(n, bool)
        boundary[lonely.ravel()] = True
        used = np.zeros(n, bool)
        used[self.F.ravel()] = True
        self.is_outer = boundary
        return [self.spread(np.flatnonzero(used & side), count) for side in (~boundary, boundary)]

    def spread(self, among, count):
        if not len(among):
            return []
        chosen, distance = [among[0]], np.full(len(among), np.inf)
        while len(chosen) < count:
            distance = np.minimum(distance, np.linalg.norm(self.V[among] - self.V[chosen[-1]], axis=1))
            chosen.append(among[np.argmax(distance)])
        return [int(v) for v in chosen]

    def choices(self, family):
        """Every way to mark candidates."""
        star = family.find('*')
        if star < 0:
            return itertools.permutations(self.inside, len(family))
        kinds = [self.inside] * star + [self.outside] * (len(family) - star - 1)
        return (cones for cones in itertools.product(*kinds) if len(set(cones)) == len(cones))

    def rank(self, family, count):
        """The `count` choices of least sigma by the closed form, the best first: by few samples and then by more."""
        star, orders = family.find('*'), [int(n) for n in family if n != '*']
        angles = [1 / n for k, n in enumerate(orders) for _ in range(2 if k < star else 1)]
        metric = Metric(tuple(angles)) if len(angles) == 3 else None
        different = {tuple(sorted(zip(orders, cones))): cones for cones in self.choices(family)}
        choices = np.array(list(different.values()))
        used, number = np.unique(choices, return_inverse=True)
        number = number.reshape(choices.shape)
        Z = self.Z[used]
        doubled = np.concatenate([Z, Z.conj()])
        cones = np.stack([column + (len(used) if mirrored else 0) for k, column in enumerate(number.T)
                          for mirrored in ((False, True) if k < star else (False,))], axis=1)

        def sigmas(rows, samples):
            ranking = Ranking(self.base[samples], self.samples[samples], doubled)
            result = []
            for part in np.array_split(cones[rows], 1 + len(rows) // 2000):
                with np.errstate(all='ignore'):
                    result.append(ranking.three_cones(metric, part) if metric else
                                  ranking.two_cones(angles[0], part, [0] if star > 0 else np.linspace(-4, 4, 17)))
            return np.nan_to_num(np.concatenate(result), nan=np.inf)

        every = np.arange(len(cones))
        coarse = every[np.argsort(sigmas(every, slice(None, None, SAMPLES // COARSE)), kind='stable')[:20 * count]]
        return choices[coarse[np.argsort(sigmas(coarse, slice(None)), kind='stable')[:count]]].tolist()

    def sigma(self, family, cones):
        try:
            embedding = self.solver.embed(family, list(cones))
        except orbitutte.MeshError:
            return math.inf
        return embedding.distortion['sigma'] if embedding.bijective else math.inf

    def neighbours(self, family, cones, around):
        """The least sigma when a cone moves by one, two, four or eight rings: `around` vertices of each."""
        graph = {}
        for k in range(3):
            for v, w in zip(self.F[:, k].tolist(), self.F[:, (k + 1) % 3].tolist()):
                graph.setdefault(v, set()).add(w)
                graph.setdefault(w, set()).add(v)
        least = math.inf
        for k, cone in enumerate(cones):
            ring, seen = {cone}, {cone}
            for distance in range(1, 9):
                ring = set().union(*(graph[v] for v in ring)) - seen
                seen |= ring
                if distance not in (1, 2, 4, 8):
                    continue
                like = sorted(v for v in ring if self.is_outer[v] == self.is_outer[cone])
                for v in like[::max(1, -(-len(like) // around))]:
                    moved = list(cones)
                    moved[k] = v
                    if len(set(moved)) == len(moved):
                        least = min(least, self.sigma(family, moved))
        return least


def family_row(name, surface, family, arguments, known):
    best = orbitutte.embed(surface.V, surface.F, family, 'best', threads=1)
    cones = [cone.vertex for cone in best.cones]
    exhaustive = known.get((name, family)) or min(surface.sigma(family, choice) for choice in surface.rank(family, arguments.solved))
    values = [best.distortion['sigma'], exhaustive, surface.neighbours(family, cones, arguments.around),
              surface.solver.embed(family, 'extremities').distortion['sigma']]
    return [name, family, *(f'{value:.4f}' for value in values)]


def whole_row(name, surface):
    best = orbitutte.embed(surface.V, surface.F, threads=1)
    usual = surface.solver.embed('*432' if surface.is_disk else '432', 'extremities').distortion
    return [name, best.signature, f"{best.distortion['sigma']:.4f}", f"{usual['sigma']:.4f}",
            f"{best.distortion['below_64']:.2%}", f"{usual['below_64']:.2%}"]


def said(rows, whole):
    """What the tables say, a line each."""
    numbers = [[float(text) for text in row[2:]] for row in rows]
    gains = [1 - float(row[2]) / float(row[3]) for row in whole]
    lost = [(float(row[4][:-1]), float(row[5][:-1])) for row in whole if float(row[5][:-1]) > 1]
    return [f'within 2 % of the exhaustive search: {sum(r[0] <= 1.02 * r[1] for r in numbers)} of {len(rows)} rows',
            f'no neighbour more than 2 % better: {sum(r[2] >= 0.98 * r[0] for r in numbers)} of {len(rows)} rows',
            f'against 432 at extremities: {min(gains):.1%} to {max(gains):.1%} less, {np.median(gains):.1%} in the median of {len(whole)} meshes',
            f'below 1/64 at least halved: {sum(2 * now <= before for now, before in lost)} of {len(lost)} meshes above 1 %']


def table(head, rows):
    return ['| ' + ' | '.join(row) + ' |' for row in (head, ['---'] * len(head), *rows)]


def summary(rows, whole):
    """A row for each mesh: the least and the greatest quotient among its families."""
    head = ['mesh', 'families', 'best / exhaustive', 'neighbours / best', *WHOLE_HEAD[1:]]
    result = []
    for row in whole:
        numbers = [[float(text) for text in other[2:5]] for other in rows if other[0] == row[0]]
        quotients = [f'{min(values):.3f} to {max(values):.3f}' for values in zip(*((b / e, n / b) for b, e, n in numbers))]
        result.append([row[0].replace('_', '\\_'), str(len(numbers)), *quotients, row[1].replace('*', '\\*'), *row[2:]])
    return table(head, result)


def write(path, rows, whole):
    text = (summary(rows, whole) + [''] if whole else []) + table(ROWS_HEAD, [[cell.replace('*', '\\*') for cell in row] for row in rows]) + ['']
    if whole:
        text += table(WHOLE_HEAD, [[cell.replace('*', '\\*') for cell in row] for row in whole]) + ['']
    path.write_text('\n'.join(text), encoding='utf-8')


def read(path):
    cells = [[cell.strip().replace('\\*', '*') for cell in line.strip('|').split('|')] for line in path.read_text().splitlines() if line]
    first = cells.index(ROWS_HEAD)
    second = cells.index(WHOLE_HEAD) if WHOLE_HEAD in cells else len(cells)
    return cells[first + 2:second], cells[second + 2:]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('meshes', nargs='*', type=pathlib.Path)
    parser.add_argument('--families', help='separated by commas; all if not given')
    parser.add_argument('--solved', type=int, default=50)
    parser.add_argument('--candidates', type=int, default=40)
    parser.add_argument('--around', type=int, default=4)
    parser.add_argument('--join', nargs='+', type=pathlib.Path, default=[])
    parser.add_argument('--known', nargs='+', type=pathlib.Path, default=[])
    parser.add_argument('-o', '--output', type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    warnings.simplefilter('ignore', orbitutte.EmbeddingWarning)
    rows, whole = [], []
    known = {(row[0], row[1]): float(row[3]) for path in arguments.known for row in read(path)[0]}
    for path in arguments.join:
        rows, whole = (old + new for old, new in zip((rows, whole), read(path)))
    for path in arguments.meshes:
        surface = Surface(path, arguments.candidates)
        whole.append(whole_row(path.stem, surface))
        families = arguments.families.split(',') if arguments.families else DISKS if surface.is_disk else SPHERES
        for family in families:
            rows.append(family_row(path.stem, surface, family, arguments, known))
            print('| ' + ' | '.join(rows[-1]) + ' |', flush=True)
            write(arguments.output, rows, whole)
    write(arguments.output, rows, whole)
    print('\n'.join(said(rows, whole)))


main()
