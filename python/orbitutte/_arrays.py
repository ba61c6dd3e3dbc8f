# SPDX-License-Identifier: MIT
"""Arguments as the arrays that the compiled module takes: C-contiguous, float64 and int32, of the right shape."""
from __future__ import annotations

import os
from collections.abc import Sequence
from itertools import chain
from typing import Any, Union

import numpy as np
import numpy.typing as npt

from . import _orbitutte
from .errors import ArgumentError, MeshError

Positions = npt.NDArray[np.float64]
#: m x k if all faces have k corners; otherwise one sequence of vertices for each face.
Faces = Union[npt.NDArray[np.int32], list[tuple[int, ...]]]

_LARGEST = np.iinfo(np.int32).max


def positions(V: npt.ArrayLike, name: str = "V", row: str = "vertex") -> Positions:
    """n x 3, float64. Copies only if the array is different."""
    array = _as_array(V, name, row)
    if array.size == 0 and array.ndim <= 2:
        return np.empty((0, 3))
    _require_kind(array, "fiu", name, "real numbers")
    if array.ndim != 2 or array.shape[1] != 3:
        raise ArgumentError(f"{name} has the shape {array.shape}; it must be n x 3, one {row} a row")
    return np.ascontiguousarray(array, dtype=np.float64)


def finite_positions(V: npt.ArrayLike, name: str = "V", row: str = "vertex") -> Positions:
    """The same, refusing infinities and NaN."""
    array = positions(V, name, row)
    bad = ~np.isfinite(array).all(axis=1)
    if bad.any():
        raise ArgumentError(f"{name}: {row} {int(np.argmax(bad))} has a coordinate that is not finite")
    return array


def indices(values: npt.ArrayLike, name: str, what: str = "vertex") -> npt.NDArray[np.int32]:
    """k, int32."""
    array = _as_array(values, name, what)
    if array.size == 0 and array.ndim == 1:
        return np.empty(0, dtype=np.int32)
    _require_kind(array, "iu", name, "whole numbers")
    if array.ndim != 1:
        raise ArgumentError(f"{name} has the shape {array.shape}; it must be a sequence of whole numbers")
    return _as_int32(array, name, "entry")


def mesh(V: npt.ArrayLike, F: Any) -> _orbitutte.Mesh:
    """The mesh in the form of the compiled module, which copies it."""
    V = positions(V)
    if _is_ragged(F):
        return _orbitutte.Mesh(V, *_polygons(F))
    array = _as_array(F, "F", "face")
    if array.size == 0 and array.ndim <= 2:
        return _orbitutte.Mesh(V, np.empty((0, 3), dtype=np.int32))
    _require_kind(array, "iu", "F", "whole numbers, the vertices of the faces")
    if array.ndim != 2 or array.shape[1] < 3:
        raise ArgumentError(f"F has the shape {array.shape}; it must be m x 3, or m x k for faces of k corners, one face a row")
    array = _as_int32(array, "F", "face")
    if array.shape[1] == 3:
        return _orbitutte.Mesh(V, array)
    start = np.arange(0, array.size + 1, array.shape[1], dtype=np.int32)
    return _orbitutte.Mesh(V, array.reshape(-1), start)


def require_vertices(mesh: _orbitutte.Mesh) -> None:
    """Raises MeshError naming the first face with a vertex that does not exist."""
    corners, start = mesh.faces
    n, flat = len(mesh.positions), corners.reshape(-1)
    bad = (flat < 0) | (flat >= n)
    if bad.any():
        k = int(np.argmax(bad))
        f = k // 3 if start is None else int(np.searchsorted(start, k, side="right")) - 1
        raise MeshError(f"F: face {f} names the vertex {flat[k]}, but there are {n} vertices")


def faces(corners: npt.NDArray[np.int32], start: npt.NDArray[np.int32] | None) -> Faces:
    """Faces as users see them: an array if all have the same number of corners, otherwise a list of tuples."""
    if start is None:
        return corners
    degrees = np.diff(start)
    if len(degrees) and (degrees == degrees[0]).all():
        array = corners.reshape(-1, int(degrees[0]))
        array.setflags(write=False)
        return array
    vertices = corners.tolist()
    return [tuple(vertices[begin:end]) for begin, end in zip(start[:-1].tolist(), start[1:].tolist())]


def path(value: str | bytes | os.PathLike) -> bytes:
    """The bytes of a path."""
    try:
        encoded = os.fsencode(value)
    except TypeError:
        raise TypeError(f"a path must be a string or path object, not a {type(value).__name__}") from None
    if b"\0" in encoded:
        raise ArgumentError("a path holds a null character")
    return encoded


def _as_array(values: Any, name: str, row: str) -> np.ndarray:
    if isinstance(values, np.ma.MaskedArray):
        raise TypeError(f"{name} is a masked array; fill the masked entries or leave them out")
    try:
        array = np.asarray(values)
    except ValueError as error:  # ragged lists
        raise ArgumentError(_odd_row(values, name, row) or f"{name} is not an array: {error}") from None
    if array.dtype.kind == "O":
        odd = _odd_row(values, name, row)
        raise TypeError(odd or f"{name} holds objects; numbers are expected")
    return array


def _odd_row(values: Any, name: str, row: str) -> str | None:
    """The first row that is not like the first one."""
    if not isinstance(values, Sequence):
        return None
    lengths = [len(value) if hasattr(value, "__len__") else None for value in values]
    for k, length in enumerate(lengths):
        if length is None or length != lengths[0]:
            what = "is not a sequence" if length is None else f"has {length} entries, but {row} 0 has {lengths[0]}"
            return f"{name}: {row} {k} {what}"
        if any(isinstance(entry, str) or not np.isscalar(entry) for entry in values[k]):
            return f"{name}: {row} {k} holds something that is not a number"
    return None


def _require_kind(array: np.ndarray, kinds: str, name: str, expected: str) -> None:
    if array.dtype.kind not in kinds:
        raise TypeError(f"{name} has the type {array.dtype}; {expected} are expected")


def _as_int32(array: np.ndarray, name: str, row: str) -> npt.NDArray[np.int32]:
    if array.dtype != np.int32:
        bad = (array > _LARGEST) | (array < -_LARGEST)
        if bad.any():
            k = np.unravel_index(int(np.argmax(bad)), array.shape)
            raise MeshError(f"{name}: {row} {k[0]} names the vertex {array[k]}, which is more than there can be")
    return np.ascontiguousarray(array, dtype=np.int32)


def _is_ragged(F: Any) -> bool:
    """Is F a sequence of faces that differ in their numbers of corners?"""
    if isinstance(F, np.ndarray):
        return F.dtype == object and F.ndim == 1
    if not isinstance(F, (list, tuple)):
        return False
    try:
        return len({len(face) for face in F}) > 1
    except TypeError:
        return False  # taking it as an array gives a better message


def _polygons(F: Sequence[Any]) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.int32]]:
    """The corners of all faces, one after the other, and where each face starts."""
    for f, face in enumerate(F):
        if isinstance(face, (str, bytes)) or not hasattr(face, "__len__"):
            raise TypeError(f"F: face {f} is not a sequence of vertices")
    corners = _as_array(list(chain.from_iterable(F)), "the corners of F", "corner")
    if corners.ndim != 1 or (corners.size and corners.dtype.kind not in "iu"):
        for f, face in enumerate(F):
            one = np.asarray(face)
            if one.ndim != 1 or (one.size and one.dtype.kind not in "iu"):
                raise TypeError(f"F: face {f} is not a sequence of whole numbers")
    if len(corners) > _LARGEST:
        raise MeshError(f"F: {len(corners)} corners are more than 2^31 - 1")
    start = np.zeros(len(F) + 1, dtype=np.int32)
    np.cumsum([len(face) for face in F], out=start[1:])
    if corners.size and corners.dtype != np.int32:
        bad = (corners > _LARGEST) | (corners < -_LARGEST)
        if bad.any():
            k = int(np.argmax(bad))
            f = int(np.searchsorted(start, k, side="right")) - 1
            raise MeshError(f"F: face {f} names the vertex {corners[k]}, which is more than there can be")
    return np.ascontiguousarray(corners, dtype=np.int32), start
