# SPDX-License-Identifier: MIT
"""Maps between two surfaces."""
from __future__ import annotations

import json
import os
import pathlib
import warnings
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _options, _orbitutte
from ._embedding import Embedding
from .errors import ArgumentError, EmbeddingWarning

Array = npt.NDArray[np.float64]


class SurfacePoints(NamedTuple):
    """Points of a surface."""

    #: (k,) int32: rows of `Embedding.triangles`; -1 for none.
    triangle: npt.NDArray[np.int32]
    #: (k, 3): coordinates on the corners of those rows, with the sum 1; NaN for none.
    barycentric: Array


class Overlay(NamedTuple):
    """The common refinement of two surfaces: one mesh with positions on both."""

    #: (n, 3): where its vertices lie in space, on A and on B.
    on_a: Array
    on_b: Array
    #: Convex polygons of up to six corners.
    faces: _arrays.Faces
    #: (m,) int32: the triangle of A, and that of B, that each face lies in.
    a_triangle: npt.NDArray[np.int32]
    b_triangle: npt.NDArray[np.int32]
    #: The name and the sentence of every check of the certificate that failed; none if the overlay is right.
    failed_checks: list[tuple[str, str]]


class TextureLayout(NamedTuple):
    """Where the corners of a surface's faces lie in its texture."""

    #: (k, 2): u to the right, v up; (0, 0) is the lower left corner of the picture, (1, 1) the upper right.
    uv: Array
    #: (corners,) int32: a row of uv for every corner of every face, one face after the other.
    of_corner: npt.NDArray[np.int32]


class Texture(NamedTuple):
    """A picture, and where a surface's corners lie in it."""

    #: (height, width, 4) uint8: red, green, blue (sRGB) and opacity, row by row from the top.
    picture: npt.NDArray[np.uint8]
    layout: TextureLayout


class SurfaceMap:
    """A bijection between two surfaces, A and B, by way of two embeddings into one target: made by `map_between`.

    Attributes
    ----------
    a, b : Embedding
    landmarks : (k, 2) int32
    """

    __slots__ = ("a", "b", "landmarks", "_from", "_overlay")

    def __init__(self, a: Embedding, b: Embedding, landmarks: npt.ArrayLike) -> None:
        if a.mesh is None or b.mesh is None:
            raise ArgumentError("a map between surfaces needs the meshes of both embeddings")
        self.a, self.b = a, b
        self.landmarks = _landmarks(landmarks)
        self._from: dict[str, Any] = {}
        self._overlay: Any = None

    @property
    def bijective(self) -> bool:
        """Are both embeddings certified? Then the map is one to one."""
        return self.a.bijective and self.b.bijective

    def to_b(self, points: Any = None) -> SurfacePoints:
        """Where points of A lie on B: all vertices, or pairs (triangle, barycentric) as `SurfacePoints` has them."""
        return self._images("a", points)

    def to_a(self, points: Any = None) -> SurfacePoints:
        """Where points of B lie on A."""
        return self._images("b", points)

    def pull(self, values: npt.ArrayLike, how: str = "linear") -> npt.NDArray[Any]:
        """Values at the vertices of B, (n_b,) or (n_b, c), at those of A: "linear" on every triangle, or, for labels, of the "nearest" corner."""
        return self._transfer("a", values, how)

    def push(self, values: npt.ArrayLike, how: str = "linear") -> npt.NDArray[Any]:
        """Values at the vertices of A at those of B."""
        return self._transfer("b", values, how)

    def matrix(self) -> Any:
        """The matrix of `pull`, scipy CSR, n_a x n_b: rows sum to one, those of vertices that no face uses are empty."""
        from scipy.sparse import csr_matrix
        _, weights, corners = self._vertices("a")
        used = np.nan_to_num(weights) != 0
        rows = np.broadcast_to(np.arange(len(weights))[:, None], weights.shape)
        shape = len(weights), len(self.b.mesh[0])
        return csr_matrix((weights[used], (rows[used], corners[used])), shape=shape)

    def overlay(self) -> Overlay:
        """The common refinement of both surfaces, and what its certificate finds wrong."""
        core = self._core_of_overlay()
        corners, start = core.corners, core.start
        faces = [tuple(corners[start[f]:start[f + 1]].tolist()) for f in range(len(start) - 1)]
        a_triangle, b_triangle = core.parents
        return Overlay(*self._positions(), faces, a_triangle, b_triangle, core.failed_checks(self.a._core, self.b._core))

    def morph(self, t: float) -> tuple[Array, npt.NDArray[np.int32]]:
        """The overlay in triangles, its vertices at (1 - t) times where they are on A plus t times where they are on B: (V, F)."""
        on_a, on_b = self._positions()
        return (1 - t) * on_a + t * on_b, self._core_of_overlay().triangles

    def bake(self, picture: npt.ArrayLike, of_b: Any, on_a: Any = None, size: tuple[int, int] | None = None) -> Texture:
        """The picture of B as the picture of A.

        picture: (height, width) or (height, width, 3 or 4), uint8. of_b: the texture coordinates of B, (uv, of_corner) as `read_texture_layout`
        has them; on_a: those of A, or None for a new chart. size: (width, height); that of B's picture if it is not given, a square for a new chart.
        """
        pixels = _pixels(picture)
        height, width = pixels.shape[:2]
        if size is None:
            size = (width, height) if on_a is not None else (max(width, height),) * 2
        layout_a = TextureLayout(*_orbitutte.new_texture_layout(self.a._core)) if on_a is None else _layout(on_a)
        wanted = tuple(_options.whole(side, "size") for side in size)
        baked = _orbitutte.bake(self._core_of_overlay(), (self.a._core, self.b._core), (tuple(layout_a), tuple(_layout(of_b))), pixels, wanted)
        return Texture(baked, layout_a)

    def write_morph(self, path: str | os.PathLike) -> None:
        """Write a GLB whose mesh is A and whose morph target is B, with an animation that goes there and back."""
        on_a, on_b = self._positions()
        _orbitutte.write_morph(_arrays.path(path), self._core_of_overlay().triangles, on_a, on_b)

    def save(self, folder: str | os.PathLike) -> None:
        """Write a.ply, a.json, b.ply, b.json and landmarks.json into a folder, which is made if it is not there."""
        at = pathlib.Path(folder)
        at.mkdir(parents=True, exist_ok=True)
        for name, side in (("a", self.a), ("b", self.b)):
            side.save(at / f"{name}.ply", at / f"{name}.json")
        (at / "landmarks.json").write_text(json.dumps(self.landmarks.tolist()) + "\n", encoding="utf-8")

    @staticmethod
    def load(folder: str | os.PathLike, A: Any, B: Any) -> SurfaceMap:
        """Read what `save` or ``orbitutte map`` has written. A and B are the meshes, as paths or (V, F)."""
        at = pathlib.Path(folder)
        sides = [Embedding.load(at / f"{name}.ply", at / f"{name}.json", mesh) for name, mesh in (("a", A), ("b", B))]
        if (at / "landmarks.json").exists():
            landmarks = json.loads((at / "landmarks.json").read_text(encoding="utf-8"))
        else:
            landmarks = json.loads((at / "map.json").read_text(encoding="utf-8"))["landmarks"]
        return SurfaceMap(*sides, landmarks)

    def __repr__(self) -> str:
        state = "bijective" if self.bijective else "not certified"
        return f"<orbitutte.SurfaceMap onto {self.a.signature}, {len(self.landmarks)} landmarks, {state}>"

    # Vertices and the overlay are computed once.

    def _sides(self, side: str) -> tuple[Embedding, Embedding]:
        return (self.a, self.b) if side == "a" else (self.b, self.a)

    def _vertices(self, side: str) -> Any:
        if side not in self._from:
            here, there = self._sides(side)
            self._from[side] = _orbitutte.images_of_vertices(here._core, there._core)
        return self._from[side]

    def _images(self, side: str, points: Any) -> SurfacePoints:
        if points is None:
            triangle, barycentric, _ = self._vertices(side)
            return SurfacePoints(triangle, barycentric)
        triangle, barycentric = points
        here, there = self._sides(side)
        return SurfacePoints(*_orbitutte.images_of_points(here._core, there._core, _arrays.indices(triangle, "triangle", "point"),
                                                          _arrays.positions(barycentric, "barycentric", "point")))

    def _transfer(self, side: str, values: npt.ArrayLike, how: str) -> npt.NDArray[Any]:
        array = np.asarray(values)
        _, weights, corners = self._vertices(side)
        _, there = self._sides(side)
        if len(array) != len(there.mesh[0]):
            raise ArgumentError(f"there are {len(array)} values, and the surface has {len(there.mesh[0])} vertices")
        if how == "nearest":
            nearest = np.argmax(np.nan_to_num(weights), axis=1)
            return array[corners[np.arange(len(corners)), nearest]]
        if how != "linear":
            raise ArgumentError(f"how is '{how}'; it may be linear or nearest")
        return np.einsum("vk,vk...->v...", np.where(weights == 0, 0.0, weights), array[corners].astype(float))

    def _core_of_overlay(self) -> Any:
        if self._overlay is None:
            self._overlay = _orbitutte.Overlay(self.a._core, self.b._core)
        return self._overlay

    def _positions(self) -> tuple[Array, Array]:
        core = self._core_of_overlay()
        return (core.on_a(_arrays.positions(self.a.mesh[0]), self.a._core), core.on_b(_arrays.positions(self.b.mesh[0]), self.b._core))


def map_between(A: Any, B: Any, landmarks: npt.ArrayLike = (), *, tile: str = "shared", cut_seeds: tuple[int, int] = (0, 0),
                progress: Any = None, **options: Any) -> SurfaceMap:
    """The map of one surface to another that takes every landmark to its partner.

    Parameters
    ----------
    A, B : (V, F)
        The meshes, as `embed` takes them: two spheres or two disks.
    landmarks : (k, 2) array_like of int
        Vertices of A and of B that correspond: three or more on spheres, or none for a guess; two or more on disks, inside or on the boundary.
    tile : "shared" or "regular"
        What decides the shape of the tile if it is free: both surfaces, or the number of landmarks alone.
    cut_seeds : (int, int)
        Which cuts through the landmarks are taken on A and on B. They change nothing about the map.
    progress : callable(stage, iteration, energy, gradient_norm), optional
        As for `embed`.
    weights, clamp, max_iterations, threads
        As for `embed`.
    tolerance : float
        As for `embed`, but 1e-13: errors in shrunk limbs appear in full size on the other surface. Hyperbolic tiles stop at 1e-9.

    Raises
    ------
    MeshError
        If a landmark is no vertex, is used twice or lies inside one surface and on the boundary of the other, or if the surfaces differ in
        topology; the message names it.
    ArgumentError, TypeError, Cancelled
        As for `embed`.
    """
    options.setdefault("tolerance", 1e-13)
    meshes = _arrays.mesh(*A), _arrays.mesh(*B)
    pairs = _landmarks(landmarks)
    seeds = tuple(_options.whole(seed, "cut_seeds") for seed in cut_seeds)
    how = _orbitutte.MapOptions(_options.options(**options), _options.text(tile, "tile"), seeds)
    a, b, sentences = _orbitutte.map_two(meshes, pairs, how, progress)
    result = SurfaceMap(Embedding._of(a), Embedding._of(b), pairs)
    for sentence in sentences:
        warnings.warn(sentence, EmbeddingWarning, stacklevel=2)
    if not result.bijective:
        warnings.warn("the map is not certified: an embedding is not", EmbeddingWarning, stacklevel=2)
    return result


def read_texture_layout(path: str | os.PathLike) -> TextureLayout | None:
    """The texture coordinates of an OBJ file; None if it has none."""
    found = _orbitutte.read_texture_layout(_arrays.path(path))
    return None if found is None else TextureLayout(*found)


def _pixels(picture: npt.ArrayLike) -> npt.NDArray[np.uint8]:
    array = np.asarray(picture)
    if array.ndim == 2:
        array = np.repeat(array[:, :, None], 3, axis=2)
    if array.dtype != np.uint8 or array.ndim != 3 or array.shape[2] not in (3, 4) or array.size == 0:
        raise ArgumentError(f"the picture is an array of {array.dtype} of the shape {array.shape}; it must be uint8, height x width, or x 3 or x 4")
    if array.shape[2] == 3:
        array = np.concatenate([array, np.full((*array.shape[:2], 1), 255, np.uint8)], axis=2)
    return np.ascontiguousarray(array)


def _layout(layout: Any) -> TextureLayout:
    uv, of_corner = layout
    array = np.ascontiguousarray(uv, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 2 or not np.isfinite(array).all():
        raise ArgumentError(f"texture coordinates have the shape {array.shape}; they must be k x 2, and finite")
    return TextureLayout(array, _arrays.indices(np.ravel(of_corner), "of_corner"))


def _landmarks(landmarks: npt.ArrayLike) -> npt.NDArray[np.int32]:
    array = np.asarray(landmarks)
    if array.size == 0:
        return np.empty((0, 2), dtype=np.int32)
    if array.ndim != 2 or array.shape[1] != 2:
        raise ArgumentError(f"landmarks have the shape {array.shape}; they must be k x 2, a vertex of A and one of B a row")
    return np.ascontiguousarray(_arrays.indices(array.ravel(), "landmarks").reshape(-1, 2))
