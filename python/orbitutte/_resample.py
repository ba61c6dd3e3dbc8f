# SPDX-License-Identifier: MIT
"""Values from a surface to regular grids of the sphere or the plane, and back."""
from __future__ import annotations

import os
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _api, _arrays, _options, _orbitutte
from ._embedding import Embedding
from .errors import ArgumentError

Array = npt.NDArray[Any]


class Table(NamedTuple):
    """A sparse matrix by rows (CSR): row r has the weights ``weights[indptr[r]:indptr[r + 1]]`` in the columns ``indices[...]``."""

    indptr: npt.NDArray[np.int32]
    indices: npt.NDArray[np.int32]
    weights: npt.NDArray[np.float64]
    shape: tuple[int, int]

    def matrix(self) -> Any:
        """The same for SciPy (scipy.sparse.csr_matrix)."""
        from scipy.sparse import csr_matrix
        return csr_matrix((self.weights, self.indices, self.indptr), shape=self.shape)


class Resampler:
    """Values from the vertices of a surface to the points of a grid, and back: calling it, and `back`.

    Parameters
    ----------
    embedding : Embedding
    grid : str or (V, F) or path
        "ico:7" (an icosphere of level 7, 163,842 points), "healpix:64", "healpix-nested:64", "equirectangular:512x256",
        "octahedral:256", "cube:128"; of orbifolds of the plane "periodic:256" (the torus that covers it) or "tile:256" (442, 2222,
        \\*2222); or a sphere, for its vertices, such as FreeSurfer's fsaverage.
    kind : str
        "linear"; "nearest" (labels); "conservative": means over cells, which keep the integral over the surface (needs the mesh); or
        "least-squares": the values of which `back` makes those of the surface again as nearly as can be.

    Attributes
    ----------
    points : (k, 3) float64
        Unit vectors, or points of the plane z = 1, in the canonical frame of the orbifold.
    areas : (k,) float64
        The areas of the cells around the points, on the sphere or the plane.
    shape : tuple
        Of an image (height, width), of cubes (6, height, width), otherwise (k,).
    triangles : (t, 3) int32
        Between the points, of icospheres, spheres, octahedral images and cubes; otherwise none.
    surface_areas, vertex_areas : (k,), (n,) float64
        Of the kind "conservative": the areas of the surface that belong to the cells, and to the vertices. The sum of
        surface_areas * values on the grid is that of vertex_areas * values on the surface.
    """

    __slots__ = ("embedding", "kind", "_grid", "_tables", "points", "areas", "shape", "triangles", "surface_areas", "vertex_areas")

    def __init__(self, embedding: Embedding, grid: Any, kind: str = "linear") -> None:
        if not isinstance(embedding, Embedding):
            raise TypeError("embedding must be an orbitutte.Embedding")
        self.embedding, self.kind = embedding, _options.text(kind, "kind")
        if self.kind not in ("linear", "nearest", "conservative", "least-squares"):
            raise ArgumentError(f"kind is '{self.kind}'; it may be linear, nearest, conservative or least-squares")
        embedding._warn_of_offsets()
        self._grid = _grid_of(embedding, grid)
        self._tables: dict[str, Any] = {}
        self.points, self.areas, self.triangles = self._grid.points, self._grid.areas, self._grid.triangles
        self.shape = tuple(self._grid.shape) or (len(self.points),)
        self.surface_areas = self.vertex_areas = None
        if self.kind == "conservative":
            tables = _orbitutte.conservative_tables(embedding._core, self._grid)
            self._tables = {"grid": tables[0], "surface": tables[1]}
            self.surface_areas, self.vertex_areas = tables[2], tables[3]

    def __call__(self, values: npt.ArrayLike) -> Array:
        """Values at the vertices, (n,) or (n, c), at the points of the grid: of the shape `shape`, or shape + (c,).

        Whole numbers and truth values are labels, and stay what they are: each point gets the label of the largest weight; of the kind
        "conservative", so that each label keeps its area. Other values are added by their weights; NaN where the surface has no triangle.
        """
        values = np.asarray(values)
        rows, behind = _rows(values, len(self._columns("grid")), "values", "vertices")
        return self._apply("grid", rows).reshape(self.shape + behind)

    def back(self, values: npt.ArrayLike) -> Array:
        """Values on the grid, of the shape `shape` or shape + (c,), at the vertices: (n,) or (n, c)."""
        values = np.asarray(values)
        if values.shape[:len(self.shape)] != self.shape:
            raise ArgumentError(f"values has the shape {values.shape}; that of the grid is {self.shape}")
        behind = values.shape[len(self.shape):]
        rows = values.reshape((len(self.points),) + behind)
        rows, behind = _rows(rows, len(self.points), "values", "points")
        result = self._apply("surface", rows)
        return result.reshape((len(result),) + behind)

    def table(self) -> Table:
        """The table of weights from the vertices to the points: k x n; ArgumentError for "least-squares", which solves equations."""
        if self.kind == "least-squares":
            raise ArgumentError("values of the kind least-squares are no product with a table; call the resampler, or take linear")
        return self._table("grid")

    def back_table(self) -> Table:
        """The table from the points to the vertices: n x k."""
        return self._table("surface")

    def matrix(self) -> Any:
        """`table` as scipy.sparse.csr_matrix."""
        return self.table().matrix()

    def pad_indices(self, margin: int) -> npt.NDArray[np.int64]:
        """The points of the image with a margin on every side, (h + 2 margin, w + 2 margin), of cubes six of these: for training loops,
        ``values.reshape(k, c)[indices]`` is the image that goes on beyond its sides as the sphere, the torus or the group has it."""
        margin = _options.whole(margin, "margin")
        points = np.asarray(self._grid.padded_points(margin), dtype=np.int64)
        return points.reshape(self._grid.padded_shape(margin))

    def pad(self, image: npt.ArrayLike, margin: int) -> Array:
        """An image, of the shape `shape` or shape + (c,), with a margin whose values come from the symmetry."""
        image = np.asarray(image)
        if image.shape[:len(self.shape)] != self.shape:
            raise ArgumentError(f"image has the shape {image.shape}; that of the grid is {self.shape}")
        return image.reshape((len(self.points),) + image.shape[len(self.shape):])[self.pad_indices(margin)]

    def __repr__(self) -> str:
        return f"<orbitutte.Resampler to {self._grid.kind} {self.shape}, {self.kind}>"

    def _core_table(self, side: str) -> Any:
        if side not in self._tables:
            kind = "linear" if self.kind == "least-squares" else self.kind
            self._tables[side] = _orbitutte.resample_table(self.embedding._core, self._grid, kind, side)
        return self._tables[side]

    def _columns(self, side: str) -> range:
        return range(self._core_table(side).columns)

    def _apply(self, side: str, rows: Array) -> Array:
        table = self._core_table(side)
        as_numbers = np.ascontiguousarray(rows, dtype=np.float64)
        if self.kind == "least-squares" and side == "grid":
            if rows.dtype.kind in "biu":
                raise ArgumentError("values are whole numbers, and so labels, which least-squares cannot add; take nearest, or give floats")
            return _orbitutte.least_squares_values(self._core_table("surface"), table, as_numbers)
        if rows.dtype.kind not in "biu":
            return table.apply(as_numbers)
        if self.kind == "conservative":
            areas = (self.surface_areas, self.vertex_areas)
            rows_and_columns = areas if side == "grid" else areas[::-1]
            result = _orbitutte.labels_keeping_areas(table, as_numbers, *rows_and_columns)
        else:
            result = table.apply_to_labels(as_numbers)
        return result if np.isnan(result).any() else result.astype(rows.dtype)

    def _table(self, side: str) -> Table:
        table = self._core_table(side)
        return Table(table.indptr, table.indices, table.weights, (len(table.indptr) - 1, table.columns))


def resample(embedding: Embedding, values: npt.ArrayLike, grid: Any, kind: str | None = None) -> Array:
    """Values at the vertices of a surface on a grid: ``Resampler(embedding, grid, kind)(values)``.

    If `kind` is not given, it is "nearest" for whole numbers, which are labels, and "linear" for others.
    """
    if kind is None:
        kind = "nearest" if np.asarray(values).dtype.kind in "biu" else "linear"
    return Resampler(embedding, grid, kind)(values)


def _grid_of(embedding: Embedding, grid: Any) -> Any:
    if isinstance(grid, str) and not os.path.exists(grid):
        return _orbitutte.make_grid(embedding._core, grid)
    V, F = _api.read_mesh(grid) if isinstance(grid, (str, bytes, os.PathLike)) else _pair(grid)
    V, faces = _arrays.finite_positions(V), np.asarray(F)
    if faces.ndim != 2 or faces.shape[1] != 3 or faces.dtype.kind not in "iu":
        raise ArgumentError("the grid's sphere must be made of triangles: F must be m x 3 whole numbers")
    if faces.size and (faces.min() < 0 or faces.max() >= len(V)):
        raise ArgumentError("a triangle of the grid's sphere names a vertex that does not exist")
    return _orbitutte.sphere_grid(V, np.ascontiguousarray(faces, dtype=np.int32))


def _pair(grid: Any) -> Any:
    if not isinstance(grid, (tuple, list)) or len(grid) != 2:
        raise TypeError("grid must be a name such as 'ico:7', a path, or (V, F)")
    return grid


def _rows(values: Array, count: int, name: str, what: str) -> tuple[Array, tuple[int, ...]]:
    """Values as count x maps, and the dimensions behind the first."""
    if values.dtype.kind not in "biuf":
        raise TypeError(f"{name} must be real numbers")
    if values.ndim == 0 or len(values) != count:
        raise ArgumentError(f"{name} has the shape {values.shape}; there are {count} {what}")
    return values.reshape(count, -1), values.shape[1:]
