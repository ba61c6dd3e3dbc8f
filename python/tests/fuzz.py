# SPDX-License-Identifier: MIT
"""Calls with random arguments, most of them wrong: each returns, or raises one of the exceptions that it may.

By hand, for longer: python3 fuzz.py SEED CASES
"""
import contextlib
import os
import random
import sys
import tempfile
import warnings

import numpy as np
import orbitutte

DTYPES = ["?", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f2", "f4", "f8", "g", "c8", "c16", "O", "U3", "S2", "M8[s]", ">i4",
          ">f8", "V4"]
NUMBERS = [0, 1, 2, -1, 3, 7, 12, 60, 0.5, -0.0, 1e-300, 1e308, 2**31 - 1, 2**31, 2**40, 2**63, 2**64, -(2**31) - 1, float("nan"),
           float("inf"), True, 1j]
WORDS = ["", "432", "532", "*432", "2*3", "3x", "22", "polygon", "333", "5,5", "2*", "auto", "cotan", "delaunay", "mean-value", "file", "x",
         "\0", "é", "a" * 300]
ALLOWED = (orbitutte.Error, TypeError, ValueError)


class Arguments:
    """Random values, biased to those that get far."""

    def __init__(self, random_, meshes):
        self.random, self.meshes = random_, meshes
        self.numbers = np.random.default_rng(random_.getrandbits(32))

    def one_of(self, values):
        return self.random.choice(values)

    def array(self):
        shape = tuple(self.random.choice([0, 1, 2, 3, 4, 5, 30]) for _ in range(self.random.choice([0, 1, 2, 2, 2, 3])))
        values = self.numbers.integers(-3, 40, size=shape)
        try:
            array = np.asarray(values).astype(self.one_of(DTYPES))
        except (TypeError, ValueError):
            array = np.asarray(values)
        if array.size and array.dtype.kind == "f" and self.random.random() < 0.3:
            array.flat[self.random.randrange(array.size)] = self.one_of([np.nan, np.inf, -np.inf, 65504])
        return self.one_of([array, np.asfortranarray(array), array.tolist(), array[::-1] if array.ndim else array])

    def anything(self):
        return self.one_of([
            self.array, lambda: self.one_of(NUMBERS), lambda: self.one_of(WORDS), lambda: None, lambda: object(), lambda: [[1, 2], [3]],
            lambda: {},
            lambda: b"\xff", lambda: [self.one_of(NUMBERS) for _ in range(3)], lambda: (x for x in range(3)), lambda: [[0, 1, 2], "abc", None],
            lambda: lambda *_: self.one_of([True, False, None])])()

    def mesh(self):
        V, F = (array.copy() for array in self.one_of(self.meshes))
        for _ in range(self.one_of([0, 0, 0, 1, 2])):
            kind = self.random.randrange(7)
            if kind == 0:
                V = V.astype(self.one_of(["f2", "f4", "f8", "i4", "g"]))
            elif kind == 1 and F.dtype.kind == "i":
                F = F.astype(self.one_of(["i8", "u8", "u2", "f4"]))
            elif kind == 2 and V.ndim == 2 and V.size:
                V[self.random.randrange(len(V)), 0] = self.one_of([0, 1, 40])
            elif kind == 3 and F.size:
                F[self.random.randrange(len(F)), 0] = self.one_of([0, 1, 50, 60000])
            elif kind == 4:
                F = F[: self.random.randrange(len(F) + 1)]
            elif kind == 5:
                V = V[: self.random.randrange(len(V) + 1)]
            else:
                return V.tolist(), [face + [0] * self.one_of([0, 0, 0, 1]) for face in F.tolist()]
        return V, F

    def mesh_or_not(self):
        V, F = self.mesh()
        if self.random.random() < 0.15:
            V = self.anything()
        if self.random.random() < 0.15:
            F = self.anything()
        return V, F

    def signature(self):
        return self.one_of(["432", "22", "*432", "2*3", "3x", "5*", self.one_of(WORDS)]) if self.random.random() < 0.95 else self.anything()

    def cones(self):
        kind = self.random.random()
        if kind < 0.5:
            return "auto"
        return [self.random.randrange(60) for _ in range(self.one_of([1, 2, 3]))] if kind < 0.85 else self.anything()

    def options(self):
        made = {}
        for name in ("weights", "clamp", "cut_seed", "spread", "tolerance", "max_iterations", "threads", "progress", "polygon", "geometry",
                     "weights_file"):
            if self.random.random() < 0.06:
                made[name] = self.anything()
        if self.random.random() < 0.2:
            made["weights"] = self.one_of(["cotan", "uniform", "mean-value", ([0, 1], [1, 2], [1.0, 2.0])])
        made.setdefault("max_iterations", 30)
        return made


def calls(arguments, embeddings, folder):
    """The calls that are made, as names and functions without arguments."""
    a, embedding = arguments, arguments.one_of(embeddings)
    names = ["/x.obj", "/x.ply", "/x.off", "/x.stl", "/x.json", "/none/x.ply", ""]
    path = lambda: a.one_of([folder + a.one_of(names), folder + a.one_of(names), a.anything()])
    return [
        lambda: orbitutte.embed(*a.mesh_or_not(), a.signature(), a.cones(), **a.options()),
        lambda: orbitutte.embed(*a.mesh_or_not(), a.signature(), a.cones()),
        lambda: orbitutte.Solver(*a.mesh_or_not()).embed(a.signature(), a.cones()),
        lambda: orbitutte.info(*a.mesh_or_not()),
        lambda: orbitutte.choose_cones(*a.mesh_or_not(), a.signature()),
        lambda: orbitutte.verify(embedding, *a.mesh_or_not()),
        lambda: orbitutte.distortion(embedding, *a.mesh_or_not()),
        lambda: embedding.with_mesh(*a.mesh_or_not()).weights,
        lambda: embedding.with_mesh(*a.mesh_or_not()).source_points(a.anything(), a.anything()),
        lambda: orbitutte.tile(a.one_of([embedding, a.anything()])),
        lambda: embedding.map_points(a.one_of([0, [0, 1], a.anything()]), a.one_of([[1, 0, 0], a.anything()]),
                                     a.one_of([None, 0, a.anything()])),
        lambda: embedding.locate(a.anything()),
        lambda: orbitutte.write_mesh(path(), *a.mesh_or_not()),
        lambda: orbitutte.read_mesh(path()),
        lambda: embedding.save(path(), a.one_of([None, path()])),
        lambda: orbitutte.Embedding.load(path(), path(), a.one_of([None, path(), a.mesh()])),
        lambda: embedding.write_tiling(path()),
        lambda: orbitutte.sample_mesh(a.one_of(["figure", "mask", "boy", a.anything()]), a.one_of([100, 130, 50, -1, 2.5, None, True])),
        lambda: embedding.with_mesh(*a.mesh_or_not()).area_distortion,
    ]


def run_fuzz(seed, cases):
    """How many calls returned, of those that were made. Raises AssertionError with the first that ended as none may."""
    here = os.getcwd()
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(), np.errstate(all="ignore"), contextlib.ExitStack() as stack:
        stack.callback(os.chdir, here)
        os.chdir(folder)  # words may be names of files, too
        warnings.simplefilter("ignore")
        meshes = [orbitutte.sample_mesh("figure", 124), orbitutte.sample_mesh("mask", 100), orbitutte.sample_mesh("boy", 100)]
        embeddings = [orbitutte.embed(*meshes[0], "22"), orbitutte.embed(*meshes[1], "*222"), orbitutte.embed(*meshes[2], "2x")]
        returned = 0
        for case in range(cases):
            random_ = random.Random(f"{seed} {case}")
            arguments = Arguments(random_, meshes)
            call = random_.choice(calls(arguments, embeddings, folder))
            try:
                call()
                returned += 1
            except ALLOWED as error:
                assert str(error) and "incompatible function" not in str(error), f"seed {seed}, case {case}: {error}"
            except Exception as error:
                raise AssertionError(f"seed {seed}, case {case}: {type(error).__name__}: {error}") from error
    return returned


if __name__ == "__main__":
    print(run_fuzz(int(sys.argv[1]), int(sys.argv[2])), "of", sys.argv[2], "calls returned")
