#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What `best` is worth: against an exhaustive search, against extremities, and against its own neighbours.

  best_cones.py MESH ... [--families 432,223,...] [--solved 50] [--candidates 40] -o TABLE.md     (PYTHONPATH=build/python)

A row for each mesh and family:
  best         sigma of the embedding that `orbitutte.embed(V, F, family, "best")` gives
  exhaustive   the least sigma of the embeddings of the `solved` best choices among all of the farthest-point candidates, every
               arrangement of the orders, as the closed form ranks them (here in NumPy, on its own)
  neighbours   the least sigma when one cone is moved by one, two, four or eight rings and the surface embedded again
  extremities  sigma of the family at extremities, and of 432 (*432) there
A limb that doubles do not resolve has no place in the closed form here: its samples are left out of the ranking, not of the embeddings.
"""
import argparse
import itertools
import math
import pathlib

import numpy as np

import orbitutte

SPHERES = ['532', '432', '332', '222', '223', '22']
DISKS = ['*532', '*432', '*332', '*222', '*223', '3*2', '2*2', '2*3', '2*', '3*']
SAMPLES = 300


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


def series(p, q, c, terms=24):
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


def three_cones(metric, samples, cones):
    k = [bracket(cones[(i + 1) % 3], cones[(i + 2) % 3]) for i in range(3)]
    return metric.log_scale(np.stack([bracket(samples, cones[i]) * k[i] for i in range(3)], axis=1))


def two_cones(angle, samples, cones, shift):
    to = [np.log(np.abs(bracket(samples, cone))) for cone in cones]
    return -to[0] - to[1] - np.log(np.cosh(angle * (to[0] - to[1]) + shift))


class Surface:
    def __init__(self, path, candidates):
        self.V, self.F = orbitutte.read_mesh(path)
        self.solver = orbitutte.Solver(self.V, self.F)
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

    def rank(self, family):
        """The choices, those of least sigma first, by the closed form."""
        star, orders = family.find('*'), [int(n) for n in family if n != '*']
        angles = [1 / n for k, n in enumerate(orders) for _ in range(2 if k < star else 1)]
        metric = Metric(tuple(angles)) if len(angles) == 3 else None
        found, seen = [], set()
        for cones in self.choices(family):
            key = tuple(sorted(zip(orders, cones)))
            if key in seen:
                continue
            seen.add(key)
            places = [Z for k, v in enumerate(cones) for Z in ((self.Z[v], self.Z[v].conj()) if k < star else (self.Z[v],))]
            with np.errstate(all='ignore'):
                if metric:
                    sigma = (self.base + three_cones(metric, self.samples, places)).std()
                else:
                    shifts = [0] if star > 0 else np.linspace(-4, 4, 17)
                    sigma = min((self.base + two_cones(angles[0], self.samples, places, shift)).std() for shift in shifts)
            found.append((sigma if np.isfinite(sigma) else np.inf, cones))
        return [cones for _, cones in sorted(found)]

    def sigma(self, family, cones):
        try:
            embedding = self.solver.embed(family, list(cones))
        except orbitutte.MeshError:
            return math.inf
        return embedding.distortion['sigma'] if embedding.bijective else math.inf

    def neighbours(self, family, cones):
        """The least sigma when a cone moves by one, two, four or eight rings: four vertices of each."""
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
                for v in sorted(ring)[::max(1, len(ring) // 4)]:
                    moved = list(cones)
                    moved[k] = v
                    if len(set(moved)) == len(moved):
                        least = min(least, self.sigma(family, moved))
        return least


def row(surface, family, arguments):
    best = surface.solver.embed(family, 'best')
    cones = [cone.vertex for cone in best.cones]
    exhaustive = min(surface.sigma(family, choice) for choice in surface.rank(family)[:arguments.solved])
    usual = '*432' if surface.is_disk else '432'
    at_extremities = [surface.solver.embed(symbol, 'extremities').distortion for symbol in (family, usual)]
    return [family, f"{best.distortion['sigma']:.4f}", f'{exhaustive:.4f}', f'{surface.neighbours(family, cones):.4f}',
            *(f"{distortion['sigma']:.4f}" for distortion in at_extremities), f"{best.distortion['below_64']:.2%}",
            f"{at_extremities[1]['below_64']:.2%}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('meshes', nargs='+', type=pathlib.Path)
    parser.add_argument('--families', help='separated by commas; all if not given')
    parser.add_argument('--solved', type=int, default=50)
    parser.add_argument('--candidates', type=int, default=40)
    parser.add_argument('-o', '--output', type=pathlib.Path, required=True)
    arguments = parser.parse_args()
    head = ['mesh', 'family', 'best', 'exhaustive', 'neighbours', 'extremities', '432 there', 'below 1/64', '432: below 1/64']
    lines = ['| ' + ' | '.join(head) + ' |', '| ' + ' | '.join(['---'] * len(head)) + ' |']
    for path in arguments.meshes:
        surface = Surface(path, arguments.candidates)
        families = arguments.families.split(',') if arguments.families else DISKS if surface.is_disk else SPHERES
        for family in families:
            lines.append('| ' + ' | '.join([path.stem, *row(surface, family, arguments)]) + ' |')
            print(lines[-1], flush=True)
            arguments.output.write_text('\n'.join(lines) + '\n', encoding='utf-8')


main()
