# SPDX-License-Identifier: MIT
"""What arguments may be, and what is said of those that may not."""
import re

import numpy as np
import orbitutte
import pytest
from fuzz import run_fuzz


@pytest.fixture(scope="module")
def reference(figure):
    return orbitutte.embed(*figure, "332", [5, 100, 200]).positions


@pytest.mark.parametrize("dtype", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", ">i4", ">u8"])
def test_faces_of_any_integer_type(dtype):
    V, F = orbitutte.sample_mesh("figure", 124)
    expected = orbitutte.embed(V, F, "222").positions
    assert np.array_equal(orbitutte.embed(V, F.astype(dtype), "222").positions, expected)


@pytest.mark.parametrize("dtype", ["f2", "f4", "f8", ">f8", "g", "i4", "u2"])
def test_positions_of_any_real_type(dtype, figure):
    V = np.round((figure[0] + 4) * 100).astype(dtype)  # exact in all of them
    expected = orbitutte.embed(V.astype("f8"), figure[1], "222").positions
    assert np.array_equal(orbitutte.embed(V, figure[1], "222").positions, expected)


def test_arrays_in_any_order_of_memory(figure, reference):
    V, F = figure
    wide = np.zeros((2 * len(V), 7))
    wide[::2, 1:7:2] = V
    unaligned = np.zeros(V.nbytes + 1, dtype="u1")[1:].view("f8").reshape(V.shape)
    unaligned[:] = V
    frozen = V.copy()
    frozen.setflags(write=False)
    for positions in (np.asfortranarray(V), wide[::2, 1:7:2], V[::-1].copy()[::-1], unaligned, frozen, V.tolist(), tuple(map(tuple, V))):
        for faces in (F, np.asfortranarray(F), F.tolist(), F.astype("i8")[::-1][::-1]):
            assert np.array_equal(orbitutte.embed(positions, faces, "332", [5, 100, 200]).positions, reference)


def test_cones_of_any_kind(figure, reference):
    for cones in ((5, 100, 200), np.array([5, 100, 200], dtype="u1"), [np.int64(5), 100, 200], range(5, 200, 95)):
        expected = reference if cones[2] == 200 else orbitutte.embed(*figure, "332", [5, 100, 195]).positions
        assert np.array_equal(orbitutte.embed(*figure, "332", cones).positions, expected)


def changed(array, index, value):
    array = array.copy()
    array[index] = value
    return array


BAD = [
    (lambda V, F: (changed(V, (7, 1), np.nan), F), ValueError, r"vertex 7\b"),
    (lambda V, F: (changed(V, (7, 1), np.inf), F), ValueError, r"vertex 7\b"),
    (lambda V, F: (V, changed(F, (9, 0), -1)), ValueError, r"face 9\b.*-1"),
    (lambda V, F: (V, changed(F, (9, 0), len(V))), ValueError, rf"face 9\b"),
    (lambda V, F: (V, changed(F.astype("i8"), (9, 0), 2**40)), ValueError, rf"face 9 names the vertex {2**40}"),
    (lambda V, F: (V, changed(F.astype("u8"), (9, 2), 2**63 + 5)), ValueError, rf"face 9 names the vertex {2**63 + 5}"),
    (lambda V, F: (V, changed(F, 9, [4, 4, 5])), ValueError, r"face 9\b"),
    (lambda V, F: (V[:, :2], F), ValueError, r"n x 3"),
    (lambda V, F: (V.ravel(), F), ValueError, r"n x 3"),
    (lambda V, F: (V, F[:, :2]), ValueError, r"m x 3"),
    (lambda V, F: (V, F.ravel()), ValueError, r"m x 3"),
    (lambda V, F: (V.astype(complex), F), TypeError, r"complex"),
    (lambda V, F: (V.astype(bool), F), TypeError, r"bool"),
    (lambda V, F: (V.astype(object), F), TypeError, r"objects"),
    (lambda V, F: (V, F.astype(float)), TypeError, r"float64"),
    (lambda V, F: (V, F.astype(bool)), TypeError, r"bool"),
    (lambda V, F: (V, F.astype(object)), TypeError, r"objects"),
    (lambda V, F: (V.astype(str), F), TypeError, r"V has the type"),
    (lambda V, F: ([*V.tolist()[:5], [1.0, 2.0], *V.tolist()[5:]], F), ValueError, r"vertex 5 has 2 entries"),
    (lambda V, F: ([*V.tolist()[:5], [1.0, 2.0, "x"], *V.tolist()[5:]], F), TypeError, r"V"),
    (lambda V, F: ([*V.tolist()[:5], [1.0, 2.0, None], *V.tolist()[5:]], F), TypeError, r"vertex 5"),
    (lambda V, F: (V, [*F.tolist()[:5], [0, 1], *F.tolist()[5:]]), ValueError, r"face 5\b"),
    (lambda V, F: (V, [*F.tolist()[:5], 3, *F.tolist()[5:]]), (TypeError, ValueError), r"face 5\b"),
    (lambda V, F: (V, [*F.tolist()[:5], [0, 1, 2, 2**40], *F.tolist()[5:]]), ValueError, r"face 5 names the vertex"),
    (lambda V, F: (V, [*F.tolist()[:5], [0, 1, 2.5, 3], *F.tolist()[5:]]), TypeError, r"face 5\b"),
    (lambda V, F: ([], []), ValueError, r"vert"),
    (lambda V, F: (None, F), TypeError, r"V"),
    (lambda V, F: (V, None), TypeError, r"F"),
    (lambda V, F: (np.ma.masked_less(V, 0), F), TypeError, r"masked"),
]


@pytest.mark.parametrize("case", range(len(BAD)))
def test_bad_meshes_are_refused_in_a_sentence(case, figure):
    make, kind, pattern = BAD[case]
    with pytest.raises(kind) as caught:
        orbitutte.embed(*make(*figure), "332", [5, 100, 200])
    assert re.search(pattern, str(caught.value)) and "incompatible function" not in str(caught.value)


@pytest.mark.parametrize("arguments, options, kind, pattern", [
    (("2,3x", "auto"), {}, orbitutte.ArgumentError, "hyperbolic"),
    (("*432", "auto"), {}, orbitutte.MeshError, "disk"),
    ((432, "auto"), {}, TypeError, "signature"),
    (("432", [1, 2]), {}, orbitutte.MeshError, "needs 3"),
    (("432", [1, 1, 2]), {}, orbitutte.MeshError, "vertex 1 "),
    (("432", [1, 2, 10**6]), {}, orbitutte.MeshError, "1000000"),
    (("432", [1, 2, -1]), {}, orbitutte.MeshError, "-1"),
    (("432", [1, 2, 2**40]), {}, orbitutte.MeshError, str(2**40)),
    (("432", [1.0, 2.0, 3.0]), {}, TypeError, "cones"),
    (("432", [[1, 2, 3]]), {}, orbitutte.ArgumentError, "cones"),
    (("432", "some"), {}, orbitutte.ArgumentError, "best"),
    (("432", None), {}, orbitutte.ArgumentError, "cones"),
    (("432", "auto"), {"weights": "other"}, orbitutte.ArgumentError, "delaunay"),
    (("432", "auto"), {"weights": 3}, TypeError, "weights"),
    (("432", "auto"), {"weights": ([0], [1], [1.0])}, orbitutte.MeshError, "edge"),
    (("432", "auto"), {"weights": ([0], [1], [-1.0])}, orbitutte.MeshError, "negative"),
    (("432", "auto"), {"weights": ([0], [1, 2], [1.0])}, orbitutte.ArgumentError, "lengths"),
    (("432", "auto"), {"weights_file": "missing.txt"}, orbitutte.FileError, "missing.txt"),
    (("432", "auto"), {"clamp": -1}, orbitutte.ArgumentError, "clamp"),
    (("432", "auto"), {"clamp": True}, TypeError, "clamp"),
    (("432", "auto"), {"tolerance": "small"}, TypeError, "tolerance"),
    (("432", "auto"), {"tolerance": np.nan}, orbitutte.ArgumentError, "tolerance"),
    (("432", "auto"), {"max_iterations": 1.5}, TypeError, "max_iterations"),
    (("432", "auto"), {"threads": -1}, orbitutte.ArgumentError, "threads"),
    (("432", "auto"), {"cut_seed": 2**64}, orbitutte.ArgumentError, "cut_seed"),
    (("432", "auto"), {"iterations": 3}, TypeError, "iterations"),
    (("432", "auto"), {"progress": 3}, TypeError, "progress"),
    (("432", "auto"), {"polygon": [[0, 0, 1]]}, orbitutte.ArgumentError, "polygon"),
    (("polygon", None), {}, orbitutte.ArgumentError, "polygon is missing"),
    (("polygon", [1, 2, 3]), {"polygon": [[0, 0, 1], [0, 1, 0]]}, orbitutte.ArgumentError, "2 corners"),
    (("polygon", [1, 2, 3]), {"polygon": [[0, 0, 2], [0, 1, 0], [1, 0, 0]]}, orbitutte.ArgumentError, "vertex 1 "),
])
def test_bad_arguments_are_refused_in_a_sentence(arguments, options, kind, pattern, figure):
    with pytest.raises(kind, match=pattern):
        orbitutte.embed(*figure, *arguments, **options)


def test_errors_are_the_ones_that_python_knows():
    assert issubclass(orbitutte.MeshError, ValueError) and issubclass(orbitutte.ArgumentError, ValueError)
    assert issubclass(orbitutte.FileError, OSError) and issubclass(orbitutte.Cancelled, orbitutte.Error)
    with pytest.raises(FileExistsError.__mro__[1]):  # OSError
        orbitutte.read_mesh("no such.obj")
    with pytest.raises(orbitutte.FileError, match="no"):
        orbitutte.read_mesh(b"no\xff.obj")


def test_wrong_calls_raise_and_never_crash():
    assert 200 < run_fuzz(seed=1, cases=3000) < 2500  # many of both kinds
