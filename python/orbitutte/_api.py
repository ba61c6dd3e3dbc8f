# SPDX-License-Identifier: MIT
"""The functions of the package."""
from __future__ import annotations

import json
import os
import warnings
from collections.abc import Callable, Sequence
from typing import Any, NamedTuple, Union

import numpy as np
import numpy.typing as npt

from . import _arrays, _deprecated, _options, _orbitutte
from ._embedding import Embedding
from .errors import ArgumentError, EmbeddingWarning, MeshError, MeshWarning

Progress = Callable[[str, int, float, float], Union[bool, None]]
Cones = Union[Sequence[Union[int, str]], npt.NDArray[np.integer], str, None]


def embed(V: npt.ArrayLike, F: Any, signature: str = "best", cones: Cones = "best", *, objective: str = "sigma", progress: Progress | None = None,
          angles: Any = None, polygon: Any = None, geometry: str | None = None, repair: bool = False, **options: Any) -> Embedding:
    """Embed a mesh into an orbifold of the sphere, the plane or the hyperbolic plane.

    Parameters
    ----------
    V : (n, 3) array_like
        Positions of the vertices, any real dtype.
    F : (m, 3) array_like of int, (m, k), or list of sequences
        Faces, counterclockwise seen from outside, 0-based; sequences of different lengths are polygons.
    signature : str
        Conway's symbol, such as "432" (see `families`) or "7,3,2"; "best", the spherical one of least distortion; "1" or "sphere" for the
        whole sphere, ``"*"`` or "hemisphere" for a disk; "cones", or ``"*cones"`` for a disk, for cones of any angles, which decide the
        space; or "polygon" for a fixed boundary.
    cones : sequence of int and "best", "best", or "extremities"
        The vertices to be marked, in the order of the symbol; "best" in place of those, or all, that are to be chosen so that the map
        distorts least. "auto" is an older name of "best". "extremities" takes vertices that are far from each other. None for "1" and
        ``"*"``.
    objective : "sigma", "symmetric-dirichlet" or "range"
        What the choice is for the least of: the standard deviation of the logarithm of the scale, the mean of the symmetric Dirichlet energy,
        or the ratio of the largest scale to the smallest.
    progress : callable(stage, iteration, energy, gradient_norm), optional
        Called in every stage and iteration. Returning False cancels; what it raises passes through.
    angles : sequence of float
        For "cones" and ``"*cones"``: the angle of each vertex in `cones`, radians. Vertices on the boundary of a disk are corners.
    polygon : path, (k, 4) array_like of vertex, x, y, z, or (k, 3) array_like for the vertices in `cones`
        The corners, for the signature "polygon": counterclockwise, on the unit sphere.
    geometry : "spherical" or "euclidean"
        Deprecated: the signature decides the space.
    repair : bool
        First do what ``orbitutte repair`` does. Vertices keep their numbers, and new ones follow: ``report["repair"]`` says what was done, and
        of which vertex each new one is a copy. A vertex in `cones` that was welded to another stands for that one.
    weights : str, (i, j, w), or scipy sparse matrix
        "standard" (the default: delaunay, or cotan for polygons), "cotan", "delaunay", "mean-value" or "uniform"; or
        a weight >= 0 for every edge, once.
    weights_file : path
        Lines ``i j w`` instead.
    clamp : float
        Replaces every cotangent weight that is zero or negative; 0.01.
    cut_seed : int
        Another number gives another cut through the same cones.
    spread : "arc-length" or "equidistant"
        How boundary vertices are spread along the sides of a polygon.
    tolerance : float
        The optimiser stops if the gradient and the last step are smaller; 1e-9.
    max_iterations : int
        After so many the result is returned as it is, not converged; 2000.
    threads : int
        0, as many as the machine has. Results do not depend on it.
    centre : str
        Of "1" and ``"*"``: what comes to lie at the centre of the sphere, "area" of the surface (the default) or its "vertices"; "sigma"
        for the least distortion of areas; or "none".
    points : mapping of int to (x, y, z)
        Of "1" and ``"*"``: up to three vertices, and the points of the unit sphere at which they come to lie.
    quotient : bool
        Take the quotient of the map by its group, a map to the whole sphere or a hemisphere; for ``NN``, ``*NN``, ``N*``, ``222``
        and ``*222``.

    Returns
    -------
    Embedding
        If it has not converged or is not certified, an `EmbeddingWarning` says so.

    Raises
    ------
    MeshError
        If the mesh cannot be embedded as asked; the message names the vertex, edge or face.
    ArgumentError, TypeError
        If an argument has no meaning.
    Cancelled
        If `progress` returned False.
    """
    chosen = _options.options(**options)
    mesh = _arrays.mesh(V, F)
    if _options.flag(repair, "repair"):
        mesh, image = mesh.repaired()
        cones = _followed(cones, image)
    known = _options.target(signature, cones, polygon, geometry, angles)
    target, vertices, is_choice = _options.wish(mesh, known, signature, cones, angles)
    if is_choice:
        wanted = _orbitutte.ChooseOptions(target, vertices, _options.text(objective, "objective"), chosen)
        return _told(Embedding._of(_orbitutte.embed_best(mesh, wanted, _callable(progress))))
    return _told(Embedding._of(_orbitutte.embed(mesh, target, vertices, chosen, _callable(progress))))


def _followed(cones: Cones, image: npt.NDArray[np.int32]) -> Cones:
    """The cones after a repair that has made vertex image[v] of the vertex v, or -1 if no face is left there."""
    if cones is None or isinstance(cones, str):
        return cones
    followed: list[int | str] = []
    for cone in cones:
        is_known = not isinstance(cone, str) and 0 <= cone < len(image)
        if is_known and image[cone] < 0:
            raise MeshError(f"vertex {cone} is marked, but no face at it is left after the repair; mark another vertex")
        followed.append(int(image[cone]) if is_known else cone)
    return followed


def choose(V: npt.ArrayLike, F: Any, signature: str = "best", cones: Cones = "best", *, objective: str = "sigma", solved: int = 3,
           progress: Progress | None = None, **options: Any) -> list[dict[str, Any]]:
    """The best cones of every family of orbifolds that a mesh embeds into, the best first.

    Arguments are those of `embed`.

    Parameters
    ----------
    solved : int
        So many of the best are embedded and certified.

    Returns
    -------
    list of dict
        ``orbifold``, ``cones``, ``predicted`` (a dictionary of ``sigma``, ``within_4``, ``below_64``, ``symmetric_dirichlet`` and
        ``range``) and, if it was embedded, ``solved`` (as `distortion`) and ``bijective``, or ``refusal``, the reason why not.
    """
    mesh = _arrays.mesh(V, F)
    target = _options.target(signature, cones)
    wanted = _orbitutte.ChooseOptions(target, _options.marks(mesh, target, cones).vertices, _options.text(objective, "objective"),
                                      _options.options(**options))
    return json.loads(_orbitutte.choose(mesh, wanted, _options.whole(solved, "solved"), _callable(progress)))["choices"]


class Solver:
    """Many embeddings of one mesh: keeps what depends neither on the cones nor on their orders.

    Parameters
    ----------
    V, F, **options
        As for `embed`. The mesh is copied.

    Examples
    --------
    >>> solver = orbitutte.Solver(V, F)
    >>> maps = [solver.embed(signature, [12, 40, 7]) for signature in ("532", "432", "332")]
    """

    __slots__ = ("_mesh", "_core", "_options")

    def __init__(self, V: npt.ArrayLike, F: Any, **options: Any) -> None:
        chosen = _options.options(**options)
        self._mesh = _arrays.mesh(V, F)
        self._core = _orbitutte.Solver(self._mesh, chosen)
        self._options = chosen

    def embed(self, signature: str = "best", cones: Cones = "best", *, objective: str = "sigma", progress: Progress | None = None,
              angles: Any = None, polygon: Any = None, geometry: str | None = None) -> Embedding:
        """As the function `embed`. One thread at a time. What is chosen is computed with a solver of its own."""
        known = _options.target(signature, cones, polygon, geometry, angles)
        target, vertices, is_choice = _options.wish(self._mesh, known, signature, cones, angles)
        if is_choice:
            wanted = _orbitutte.ChooseOptions(target, vertices, _options.text(objective, "objective"), self._options)
            return _told(Embedding._of(_orbitutte.embed_best(self._mesh, wanted, _callable(progress))))
        return _told(Embedding._of(self._core.embed(target, vertices, _callable(progress))))

    def __repr__(self) -> str:
        return f"<orbitutte.Solver of {len(self._mesh.positions)} vertices>"


def info(V: npt.ArrayLike, F: Any) -> dict[str, Any]:
    """Topology, quality and defects of a mesh, and the families that it embeds into.

    The dictionary of ``orbitutte info --json``. Defects are part of it, and raise nothing.
    """
    return json.loads(_arrays.mesh(V, F).info())


def families() -> list[dict[str, str]]:
    """The families of orbifolds: ``family``, ``group_order``, ``input``, ``marked_vertices``."""
    return json.loads(_orbitutte.families())


def signatures() -> list[dict[str, str]]:
    """Deprecated: its name is now `families`."""
    _deprecated.tell("signatures", "families")
    return families()


def choose_cones(V: npt.ArrayLike, F: Any, signature: str, *, geometry: str | None = None) -> list[int]:
    """Well separated extremities to be marked, as `embed` takes them for "extremities"."""
    return _arrays.mesh(V, F).extremities(_options.target(signature, None, None, geometry))


class FittedCones(NamedTuple):
    """Cones whose angles fit a surface; `embed` takes them: ``embed(V, F, "cones", cones.vertices, angles=cones.angles)``."""

    vertices: list[int]
    angles: npt.NDArray[np.float64]  #: (k,) radians, in the order of the vertices
    area: float  #: curvature times area of what is embedded into, by Gauss and Bonnet
    sigma: float  #: the standard deviation of the logarithm of the scale that is expected


def fitted_cones(V: npt.ArrayLike, F: Any, count: int | None = None, *, kept: Sequence[int] = (), sigma: float | None = None, area: float | None = 0.0,
                 orders: bool = False, greatest: float | None = None) -> FittedCones:
    """Cones of the angles, and as far as wanted at the vertices, that distort a sphere or disk least: least squares on the Laplacian.

    Parameters
    ----------
    V, F
        As for `embed`.
    count : int
        How many cones, `kept` included; if it is not given, as many as are kept.
    kept : sequence of int
        Vertices that are cones in any case.
    sigma : float
        As few cones as reach this standard deviation of the logarithm of the scale.
    area : float or None
        Curvature times area of what is embedded into: 0 for the plane, above 0 for the sphere, below 0 for the hyperbolic plane; None to fit
        it, too.
    orders : bool
        Round the angles to those of an orbifold, 2 pi/n, and pi/n on the boundary. Their area is then their own.
    greatest : float, optional
        The greatest angle of a cone, as a share of the flat one (2 pi inside, pi on the boundary): 1.95 in the plane if it is not given, 0.99
        elsewhere. The map with the cones need not be certified; `embed_fitted` takes milder ones then.

    Raises
    ------
    MeshError
        If a kept vertex is no vertex of a face, if no such angles have the area, or if `sigma` is out of reach.
    ArgumentError, TypeError
        If neither cones nor `sigma` are asked for, or if an argument has no meaning.
    """
    wishes = _options.cone_wishes(count, kept, sigma, area, orders, greatest)
    found = _orbitutte.fitted_cones(_arrays.mesh(V, F), wishes)
    return FittedCones(found.vertices, np.array(found.angles), found.area, found.sigma)


def embed_fitted(V: npt.ArrayLike, F: Any, count: int | None = None, *, signature: str = "cones", kept: Sequence[int] = (), sigma: float | None = None,
                 area: float | None = 0.0, orders: bool = False, greatest: float | None = None, progress: Progress | None = None,
                 **options: Any) -> Embedding:
    """Embed a sphere or disk with cones that `fitted_cones` finds, or with milder ones where these do not do.

    The command ``orbitutte embed --orbifold cones --angles fitted``. Where the map is not certified, only with other weights, or far from
    conformal, cones of smaller greatest angles are tried, at other places as far as these are free. The first without such a fault is
    taken, or else the one with the least. ``orders`` leaves no others to try.

    Parameters
    ----------
    V, F, progress, **options
        As for `embed`.
    signature : "cones" or ``"*cones"``
        The second for disks, whose corners are then cones, too.
    count, kept, sigma, area, orders, greatest
        As for `fitted_cones`.

    Returns
    -------
    Embedding
        If other cones were taken than `fitted_cones` gives, an `EmbeddingWarning` says so, with both sigmas.

    Raises
    ------
    MeshError, ArgumentError, TypeError, Cancelled
        As `fitted_cones` and `embed` do.
    """
    chosen = _options.options(**options)
    if _options.text(signature, "signature") not in _options.ANGLED:
        raise ArgumentError(f"signature is '{signature}'; cones of fitted angles make 'cones', or '*cones' of a disk")
    wishes = _options.cone_wishes(count, kept, sigma, area, orders, greatest)
    return _told(Embedding._of(_orbitutte.embed_fitted(_arrays.mesh(V, F), signature, wishes, chosen, _callable(progress))))


def verify(embedding: Embedding, V: npt.ArrayLike | None = None, F: Any = None, *, weights_file: str | os.PathLike | None = None,
           theorem2: bool = False) -> dict[str, Any]:
    """Judge an embedding and its report again, from the data alone.

    Parameters
    ----------
    embedding : Embedding
    V, F : optional
        The mesh; if not given, the one that the embedding knows.
    weights_file : path, optional
        The weights of the embedding, if they came from a file. With them its energy is checked, too.
    theorem2 : bool
        Also check the conditions of the paper's theorem 2, which takes long.

    Returns
    -------
    dict
        ``bijective``, ``checks`` and, if asked for, ``theorem2``, as in ``orbitutte verify --json``.
    """
    mesh = _mesh_or_none(V, F)
    file = b"" if weights_file is None else _arrays.path(weights_file)
    return json.loads(_embedding(embedding)._core.verify(mesh, file, "theorem2" if theorem2 else "certificate"))


def distortion(embedding: Embedding, V: npt.ArrayLike | None = None, F: Any = None) -> dict[str, Any]:
    """Area and angle distortion, measured again: ``area``, ``angle``, ``histogram``, ``measured_faces``, ``strain``."""
    mesh = _mesh_or_none(V, F)
    core = _embedding(embedding)._core
    return (core if mesh is None else core.with_mesh(mesh)).distortion()


def distortion_floor(V: npt.ArrayLike, F: Any, signature: str = "best", cones: Cones = "best", *, progress: Progress | None = None, polygon: Any = None,
                     **options: Any) -> dict[str, Any] | None:
    """The distortion that the coarseness of the mesh costs: no weights get far below it.

    The vertices are where the embedding of the surface subdivided twice has them, whose faces are 16 times as many. Arguments are
    those of `embed`; the weights do not matter.

    Returns
    -------
    dict or None
        As `distortion`. None if the finer map is not certified.
    """
    chosen = _options.options(**options)
    target = _options.target(signature, cones, polygon, None)
    mesh = _arrays.mesh(V, F)
    vertices, is_choice = _options.marks(mesh, target, cones)
    if is_choice:
        wanted = _orbitutte.ChooseOptions(target, vertices, "sigma", chosen)
        best = json.loads(_orbitutte.choose(mesh, wanted, 0, None))["choices"][0]
        target, vertices = _orbitutte.Target.parse(best["orbifold"]), best["cones"]
    return _orbitutte.distortion_floor(mesh, target, vertices, chosen, _callable(progress))


class Tiling(NamedTuple):
    """The whole sphere: |G| copies of an embedding, welded along its seams."""

    V: npt.NDArray[np.float64]  #: unit vectors
    F: _arrays.Faces  #: counterclockwise from outside; copy by copy, each in the order of the input
    copy: npt.NDArray[np.int32]  #: of every face, the copy of the tile that it belongs to: an index into Embedding.group

    element = _deprecated.renamed_field("element", "copy")


def tile(embedding: Embedding) -> Tiling:
    """Weld the |G| copies of an embedding into one closed mesh.

    Returns
    -------
    Tiling
        ``V`` ((k, 3) float64), ``F`` ((m |G|, 3) int32, or polygons as the input's) and ``copy`` ((m |G|,) int32). Face f of
        copy g is row g m + f.

    Raises
    ------
    ArgumentError
        If the copies do not close up into a sphere. Those of a polygon never do.
    """
    _embedding(embedding)._warn_of_offsets()
    V, triangles, corners, start, copy = embedding._core.tile()
    if len(start) < 2:
        return Tiling(V, triangles, copy)
    copies = int(copy[-1]) + 1
    return Tiling(V, _arrays.faces(corners, start), np.repeat(np.arange(copies, dtype=np.int32), (len(start) - 1) // copies))


def sample_mesh(shape: str = "figure", faces: int = 20000) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.int32]]:
    """Make a mesh, as ``orbitutte sample`` does.

    Parameters
    ----------
    shape : str
        "figure" (a sphere), "mask" (a disk), "boy", "roman", "crosscap" or "quotient" (projective planes).
    faces : int
        About so many, 100 to 20 million.
    """
    mesh = _orbitutte.Mesh.sample(_options.text(shape, "shape"), _options.whole(faces, "faces"))
    return mesh.positions, mesh.faces[0]


def build() -> dict[str, str]:
    """The parts that this module is built from: ``version``, ``commit``, ``backend`` and ``blas`` of its linear algebra."""
    return _orbitutte.build()


def keep_freed_memory() -> None:
    """Make this process keep memory that is freed, until its end, instead of giving it back to the operating system.

    This makes many embeddings of large meshes up to a third faster. Nothing changes if malloc is not glibc's.
    """
    _orbitutte.keep_freed_memory()


def use_huge_pages() -> None:
    """Do what `keep_freed_memory` does, and ask Linux to back the heap of this process by huge pages; the command line does it, too.

    Call it once, before threads are started: from then on they all share one heap. Nothing changes if malloc is not glibc's.
    """
    _orbitutte.use_huge_pages()


def read_mesh(path: str | os.PathLike) -> tuple[npt.NDArray[np.float64], _arrays.Faces]:
    """Read an OBJ, OFF, PLY, STL, VTK, VTP, glTF, GIfTI or FreeSurfer file, plain or compressed (`.gz`).

    Returns
    -------
    V : (n, 3) float64
    F : (m, 3) int32
        (m, k) if all faces have k corners; a list of tuples if their numbers differ.

    Raises
    ------
    FileError, MeshError, ArgumentError
        If the file cannot be read, makes no sense, or has an unknown ending.

    Warns
    -----
    MeshWarning
        If something in the file that may matter was ignored.
    """
    mesh = _orbitutte.Mesh.read(_arrays.path(path))
    for sentence in mesh.warnings:
        warnings.warn(sentence, MeshWarning, stacklevel=2)
    return mesh.positions, _arrays.faces(*mesh.faces)


def write_mesh(path: str | os.PathLike, V: npt.ArrayLike, F: Any) -> None:
    """Write OBJ, OFF, PLY, VTK, VTP or (triangles only) STL, glTF, GIfTI or FreeSurfer, as the ending of the path says. The file appears whole or not at all."""
    mesh = _arrays.mesh(_arrays.finite_positions(V), F)
    _arrays.require_vertices(mesh)
    mesh.write(_arrays.path(path))


def _told(embedding: Embedding) -> Embedding:
    """Warns about what the caller should know of a result."""
    for sentence in embedding.warnings:
        warnings.warn(sentence, EmbeddingWarning, stacklevel=3)
    if not embedding.converged:
        warnings.warn(f"the optimiser did not converge ({embedding._report['termination']}); the best embedding so far is the result",
                      EmbeddingWarning, stacklevel=3)
    elif not embedding.bijective:
        failed = [check for check in embedding._report["certificate"]["checks"] if not check["passed"]]
        details = "; ".join(f"{check['name']}: {check.get('detail', '')}" for check in failed)
        warnings.warn(f"the embedding is not certified to be bijective: {details}", EmbeddingWarning, stacklevel=3)
    return embedding


def _callable(progress: Any) -> Any:
    if progress is not None and not callable(progress):
        raise TypeError(f"progress is a {type(progress).__name__}; a function is expected")
    return progress


def _embedding(value: Any) -> Embedding:
    if not isinstance(value, Embedding):
        raise TypeError(f"an Embedding is expected, not a {type(value).__name__}")
    return value


def _mesh_or_none(V: Any, F: Any) -> _orbitutte.Mesh | None:
    if V is None and F is None:
        return None
    if V is None or F is None:
        raise ArgumentError("give both V and F, or none of them")
    return _arrays.mesh(V, F)
