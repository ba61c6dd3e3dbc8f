# SPDX-License-Identifier: MIT
"""Values at the vertices of a surface, and their files."""
from __future__ import annotations

import os
from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _orbitutte
from .errors import ArgumentError


class ValueLabel(NamedTuple):
    """What a value stands for where values are labels."""

    key: int
    name: str
    colour: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)  #: red, green, blue, alpha, 0 .. 1


class VertexData(NamedTuple):
    """Some maps of a surface, each with a value at every vertex."""

    values: npt.NDArray[Any]  #: (n, k), a column for each map; int64 if an .npy has whole numbers, otherwise float64
    names: list[str] = []  #: of the maps; none, or one each
    labels: list[ValueLabel] = []  #: the table, if the values are labels; -1 from an .annot file is of no label


def read_vertex_data(path: str | os.PathLike) -> VertexData:
    """Read values at vertices: `.shape.gii`, `.func.gii`, `.label.gii`, FreeSurfer's `.curv`, `.thickness`, `.sulc`, `.area`, ... and `.annot`, `.csv`, `.txt`,
    `.npy`, plain or compressed (`.gz`).

    Raises
    ------
    FileError, MeshError, ArgumentError
        If the file cannot be read, makes no sense, or has an unknown ending.
    """
    values, names, labels, is_whole = _orbitutte.read_values(_arrays.path(path))
    return VertexData(values.astype(np.int64) if is_whole else values, names, [ValueLabel(key, name, tuple(colour)) for key, name, colour in labels])


def write_vertex_data(path: str | os.PathLike, values: npt.ArrayLike, names: Sequence[str] = (), labels: Sequence[ValueLabel] = ()) -> None:
    """Write values at vertices, as the ending of the path says. The file appears whole or not at all.

    Parameters
    ----------
    values : (n,) or (n, k) array_like
        GIfTI and FreeSurfer keep single precision; `.label.gii` and `.annot` whole numbers; `.npy` keeps whole numbers as such.
    names : sequence of str
        Of the k maps.
    labels : sequence of (key, name, colour)
        For `.label.gii` and `.annot`.

    Raises
    ------
    FileError, MeshError, ArgumentError
        If the file cannot be written, cannot hold the values, or has an unknown ending.
    """
    is_whole = np.asarray(values).dtype.kind in "biu"
    array = np.asarray(values, dtype=np.float64)
    if array.ndim == 1:
        array = array[:, None]
    if array.ndim != 2:
        raise ArgumentError(f"values has the shape {array.shape}; it must be (n,) or (n, k)")
    table = [(int(key), str(name), tuple(float(channel) for channel in colour)) for key, name, colour in labels]
    _orbitutte.write_values(_arrays.path(path), array, [str(name) for name in names], table, is_whole)
