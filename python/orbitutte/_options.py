# SPDX-License-Identifier: MIT
"""Options and targets of an embedding, checked."""
from __future__ import annotations

import numbers
import operator
import os
import warnings
from typing import Any, NamedTuple

import numpy as np

from . import _arrays, _orbitutte
from .errors import ArgumentError

#: Every option of `embed` but `progress` and those that say what the target is.
NAMES = ("weights", "weights_file", "clamp", "cut_seed", "spread", "tolerance", "max_iterations", "threads", "quotient", "centre", "points")


#: Stands for an orbifold or cones that are to be chosen.
BEST = "best"

#: Stands for a vertex that is to be chosen, in the compiled module.
BEST_VERTEX = -1


def options(**given: Any) -> _orbitutte.Options:
    """The options of the compiled module. Raises TypeError for an unknown name."""
    for name in given:
        if name not in NAMES:
            meant = "the symbol of an orbifold is 'signature'; the options" if name == "orbifold" else "there"
            raise TypeError(f"there is no option '{name}'; {meant} are {', '.join(NAMES)}, progress, polygon and geometry")
    result = _orbitutte.Options()
    for name in ("clamp", "tolerance"):
        if name in given:
            setattr(result, name, real(given[name], name))
    for name, bits in (("cut_seed", 64), ("max_iterations", 31), ("threads", 31)):
        if name in given:
            setattr(result, name, whole(given[name], name, bits))
    if "spread" in given:
        result.set_spread(text(given["spread"], "spread"))
    if "quotient" in given:
        result.quotient = flag(given["quotient"], "quotient")
    if given.get("centre") is not None:
        result.set_centre(text(given["centre"], "centre"))
    if given.get("points") is not None:
        result.set_points(*_points(given["points"]))
    if given.get("weights_file") is not None:
        if given.get("weights") is not None:
            raise ArgumentError("give weights or weights_file, not both")
        result.weights_file = _arrays.path(given["weights_file"])
    if given.get("weights") is not None:
        _set_weights(result, given["weights"])
    return result


def target(signature: str, cones: Any, polygon: Any = None, geometry: str | None = None, angles: Any = None) -> _orbitutte.Target | None:
    """The target: an orbifold by its symbol, or a polygon by its corners; None for "best", and for cones of any angles."""
    signature = text(signature, "signature")
    if (angles is not None) != (signature in ANGLED):
        raise ArgumentError(f"angles is missing; give an angle for each cone of {signature}" if angles is None
                            else f"angles gives the angles of cones or *cones, but {signature} has its own")
    if geometry is not None:
        warnings.warn("geometry is deprecated: the signature decides the space", DeprecationWarning, stacklevel=3)
    if signature == "polygon":
        return _polygon(polygon, cones)
    if polygon is not None:
        raise ArgumentError(f"polygon gives the corners of a fixed boundary, but {signature} has no such boundary; take the signature 'polygon'")
    if signature == BEST or signature in ANGLED:
        return None
    known = _orbitutte.Target.parse(signature)
    if geometry is not None and known.space != geometry:
        raise ArgumentError(f"geometry is '{geometry}', but {signature} is {known.space}; leave geometry out")
    return known


#: The signatures whose angles stand apart from them.
ANGLED = ("cones", "*cones")


class Wish(NamedTuple):
    """What is to be embedded into, and the marked vertices."""

    target: _orbitutte.Target | None
    vertices: list[int]
    is_choice: bool


def wish(mesh: _orbitutte.Mesh, known: _orbitutte.Target | None, signature: str, cones: Any, angles: Any) -> Wish:
    """The target, made of the angles for `ANGLED` signatures, and its vertices."""
    if signature not in ANGLED:
        return Wish(known, *marks(mesh, known, cones))
    sizes = _angles(angles)
    if isinstance(cones, str) and cones == "extremities":
        return Wish(*mesh.cones(signature, None, sizes), False)
    if cones is None or isinstance(cones, str) or any(isinstance(cone, str) for cone in cones):
        raise ArgumentError(f"cones is missing; give the vertices of {signature}, or 'extremities'")
    return Wish(*mesh.cones(signature, _arrays.indices(cones, "cones").tolist(), sizes), False)


def _angles(angles: Any) -> list[float]:
    values = np.asarray(angles)
    if values.dtype.kind not in "fiu" or values.ndim != 1:
        raise TypeError("angles must be a sequence of numbers, in radians, one for each cone")
    return values.astype(np.float64).tolist()


def cone_wishes(count: Any, kept: Any, sigma: Any, area: Any, orders: Any, greatest: Any) -> _orbitutte.ConeWishes:
    """How many cones of fitted angles are wanted, and what of their angles."""
    result = _orbitutte.ConeWishes()
    result.kept = _arrays.indices(kept, "kept").tolist() if len(kept) else []
    result.count = len(result.kept) if count is None else whole(count, "count")
    result.sigma = None if sigma is None else real(sigma, "sigma")
    result.area = None if area is None else real(area, "area")
    result.are_orders = flag(orders, "orders")
    result.greatest = None if greatest is None else real(greatest, "greatest")
    if result.count == 0 and result.sigma is None:
        raise ArgumentError("count is missing; give the number of cones, or sigma for as few as reach it")
    if result.count < len(result.kept):
        raise ArgumentError(f"count is {result.count}, but kept has {len(result.kept)} vertices; give a larger count, or leave it out")
    return result


class Marks(NamedTuple):
    """The marked vertices, `BEST_VERTEX` for those that are to be chosen; none if all are."""

    vertices: list[int]
    is_choice: bool


def marks(mesh: _orbitutte.Mesh, target: _orbitutte.Target | None, cones: Any) -> Marks:
    """The vertices that `cones` names, or leaves to the program."""
    if target is not None and target.signature == "polygon":
        return Marks(target.corner_vertices, False)
    if target is not None and target.mark_count == 0:
        if cones is not None and not isinstance(cones, str) and len(cones):
            raise ArgumentError(f"leave out cones: {target.signature} marks no vertex; points puts vertices at given points")
        return Marks([], False)
    if cones is None:
        raise ArgumentError("cones is missing; give the vertices to be marked, as in [12, 40, 7], 'best' or 'extremities'")
    if isinstance(cones, str):
        if cones in (BEST, "auto"):
            return Marks([], True)
        if cones != "extremities":
            raise ArgumentError(f"cones is '{cones}'; give vertices, as in [12, 40, 7], 'best' or 'extremities'")
        return Marks(mesh.extremities(target), target is None)
    if isinstance(cones, (list, tuple)) and any(isinstance(cone, str) for cone in cones):
        return Marks([_best_or_vertex(cone) for cone in cones], True)
    return Marks(_arrays.indices(cones, "cones").tolist(), target is None)


def _best_or_vertex(cone: Any) -> int:
    if isinstance(cone, str):
        if cone != BEST:
            raise ArgumentError(f"cones has the entry '{cone}'; give vertices, and 'best' for those that are to be chosen")
        return BEST_VERTEX
    return whole(cone, "an entry of cones")


def real(value: Any, name: str) -> float:
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (numbers.Real, np.number)) or np.iscomplexobj(value):
        raise TypeError(f"{name} is a {type(value).__name__}; a number is expected")
    return float(value)


def whole(value: Any, name: str, bits: int = 31) -> int:
    try:
        if isinstance(value, (bool, np.bool_)):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is a {type(value).__name__}; a whole number is expected") from None
    if not 0 <= number < 2**bits:
        raise ArgumentError(f"{name} is {number}; it must be between 0 and {2**bits - 1}")
    return number


def flag(value: Any, name: str) -> bool:
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{name} is a {type(value).__name__}; True or False is expected")
    return bool(value)


def text(value: Any, name: str) -> str:
    if not isinstance(value, str):
        raise TypeError(f"{name} is a {type(value).__name__}; a string is expected")
    return value


def _set_weights(result: _orbitutte.Options, weights: Any) -> None:
    if isinstance(weights, str):
        result.set_weights(weights)
        return
    i, j, w = _edges_of_sparse(weights) if hasattr(weights, "tocoo") else _edges_of_triple(weights)
    if not len(w):
        raise ArgumentError("weights is empty; give every edge of the mesh once")
    result.give_weights(i, j, w)


def _edges_of_triple(weights: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    if not isinstance(weights, (tuple, list)) or len(weights) != 3:
        raise TypeError("weights must be a name, three arrays (i, j, w), or a sparse matrix")
    i, j = _arrays.indices(weights[0], "weights: i"), _arrays.indices(weights[1], "weights: j")
    w = np.asarray(weights[2])
    if w.dtype.kind not in "fiu" and w.size:
        raise TypeError(f"weights: w has the type {w.dtype}; real numbers are expected")
    if w.ndim != 1 or not len(i) == len(j) == len(w):
        raise ArgumentError(f"weights: i, j and w have the lengths {len(i)}, {len(j)} and {w.shape}; they must be the same")
    return i, j, np.ascontiguousarray(w, dtype=np.float64)


def _edges_of_sparse(matrix: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """A symmetric matrix names every edge twice, a triangular one once."""
    entries = matrix.tocoo()
    i, j, w = _edges_of_triple((entries.row, entries.col, entries.data))
    if (i == j).any():
        raise ArgumentError(f"weights: the matrix has an entry on its diagonal, at {int(i[np.argmax(i == j)])}; it must have edges only")
    lower, upper = i > j, i < j
    if lower.any() and upper.any():
        difference = abs(matrix - matrix.T).tocoo()
        if difference.nnz and difference.data.max() > 0:
            k = int(np.argmax(difference.data))
            raise ArgumentError(f"weights: the matrix is not symmetric at ({difference.row[k]}, {difference.col[k]})")
        return i[upper], j[upper], w[upper]
    return i, j, w


def _points(points: Any) -> tuple[list[int], np.ndarray]:
    """Vertices and unit vectors from a mapping {vertex: (x, y, z)}."""
    try:
        items = list(points.items())
    except AttributeError:
        raise TypeError(f"points is a {type(points).__name__}; a mapping of vertices to points, as in {{12: (0, 0, 1)}}, is expected") from None
    if not items:
        return [], np.zeros((0, 3))
    vertices = [whole(vertex, "points: a vertex") for vertex, _ in items]
    return vertices, _on_sphere(vertices, np.asarray([point for _, point in items], dtype=np.float64), "points: the point for")


def _polygon(polygon: Any, cones: Any) -> _orbitutte.Target:
    if polygon is None:
        raise ArgumentError("polygon is missing; give its corners as k x 4 rows of vertex, x, y, z, or as k x 3 positions of the vertices in cones")
    if isinstance(polygon, (str, bytes, os.PathLike)):
        if cones is not None:
            raise ArgumentError("leave out cones: the lines of the polygon's file name the vertices")
        return _orbitutte.Target.polygon_file(_arrays.path(polygon))
    corners = np.asarray(polygon)
    if corners.dtype.kind not in "fiu":
        raise TypeError(f"polygon has the type {corners.dtype}; real numbers are expected")
    if corners.ndim == 2 and corners.shape[1] == 4:
        if cones is not None:
            raise ArgumentError("leave out cones: the rows of polygon name the vertices")
        vertices = corners[:, 0]
        if not np.array_equal(vertices, np.floor(vertices)) or not (np.abs(vertices) < 2**31).all():
            raise ArgumentError("polygon: the first column must be vertices, whole numbers")
        return _polygon_of(vertices.astype(np.int32).tolist(), corners[:, 1:])
    points = _arrays.positions(corners, "polygon", "corner")
    if cones is None or isinstance(cones, str):
        raise ArgumentError("cones is missing; give the vertices of the polygon's corners")
    vertices = _arrays.indices(cones, "cones").tolist()
    if len(vertices) != len(points):
        raise ArgumentError(f"there are {len(points)} corners of the polygon and {len(vertices)} vertices in cones")
    return _polygon_of(vertices, points)


def _polygon_of(vertices: list[int], points: np.ndarray) -> _orbitutte.Target:
    """Corners that are off the sphere by at most 1e-3, as rounded decimals are, are moved onto it."""
    points = _arrays.finite_positions(points, "polygon", "corner")
    return _orbitutte.Target.polygon(vertices, _on_sphere(vertices, points, "polygon: the corner at"))


def _on_sphere(vertices: list[int], points: np.ndarray, what: str) -> np.ndarray:
    if points.ndim != 2 or points.shape[1] != 3:
        raise ArgumentError(f"{what} vertex {vertices[0]} is not three numbers x, y, z")
    lengths = np.linalg.norm(points, axis=1)
    off = ~(np.abs(lengths - 1) <= 1e-3)
    if off.any():
        k = int(np.argmax(off))
        raise ArgumentError(f"{what} vertex {vertices[k]} is at distance {lengths[k]:.6g} from the centre, not on the unit sphere")
    return points / lengths[:, None]
