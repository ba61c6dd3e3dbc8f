# SPDX-License-Identifier: MIT
"""The result of an embedding."""
from __future__ import annotations

import json
import os
import warnings
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from . import _arrays, _deprecated, _options, _orbitutte
from .errors import ArgumentError, EmbeddingWarning

Array = npt.NDArray[Any]


class Seam(NamedTuple):
    """Two banks of the cut: ``positions[left] == positions[right] @ transform.T``. Of a mirror both are the same."""

    kind: str  #: "rotation", "reflection" or "rotoreflection"
    left: Array  #: cut vertices
    right: Array  #: cut vertices, as many
    transform: Array  #: 3 x 3


class Cone(NamedTuple):
    """A marked vertex. Its angles add up to 2 pi/order ("rotation"), to pi/order ("corner"), or are held ("fixed")."""

    vertex: int  #: of the input
    order: int
    kind: str
    copies: Array  #: its cut vertices


class Offsets(NamedTuple):
    """Parts of positions that doubles have no room for; a vertex may have several."""

    vertex: Array  #: cut vertices, ascending
    d: Array  #: (k, 3)


class EdgeWeights(NamedTuple):
    """A weight for every undirected edge. Those of an intrinsic triangulation may join two vertices more than once."""

    i: Array
    j: Array
    w: Array

    def to_sparse(self, n: int | None = None) -> Any:
        """The symmetric n x n matrix (scipy.sparse.coo_matrix); edges between the same vertices add up there."""
        from scipy.sparse import coo_matrix

        n = int(max(self.i.max(), self.j.max())) + 1 if n is None else n
        rows, columns = np.concatenate([self.i, self.j]), np.concatenate([self.j, self.i])
        return coo_matrix((np.concatenate([self.w, self.w]), (rows, columns)), shape=(n, n))


class Location(NamedTuple):
    """Points of the copies of a surface. Of a single point, an int, three numbers and an int."""

    triangle: Array  #: (k,) rows of Embedding.triangles; -1 where there is none
    barycentric: Array  #: (k, 3) on the corners of that row; NaN where there is none
    copy: Array  #: (k,) the copies of the tile, indices into Embedding.group; -1 where there is none

    face = _deprecated.renamed_field("face", "triangle")
    element = _deprecated.renamed_field("element", "copy")


class Embedding:
    """A map of a mesh onto an orbifold of the sphere or the plane, with its certificate.

    Made by `orbitutte.embed`, `Solver.embed` and `Embedding.load`. It cannot be changed; its arrays are read-only views
    that keep it alive. Indices are 0-based, angles in radians. The *cut mesh* is the mesh after cutting: its faces
    are the input faces in the input order, its vertices the n input vertices, followed by the copies that the cut adds.

    Attributes
    ----------
    positions : (n_cut, 3) float64
        Unit vectors, one for every cut vertex (points of the plane z = 1 for a Euclidean orbifold).
    canonical_positions : (n_cut, 3) float64
        The same in the canonical frame of the orbifold, which depends on its marks alone: in it, embeddings into one orbifold can be
        compared, whatever their cuts. `map_points` and `locate` work in it.
    placement : (3, 3) float64
        Takes the canonical frame to the one of `positions`, `seams` and `group`: the identity, unless the map was turned to where
        doubles resolve a small limb.
    offsets : Offsets
        Where doubles do not resolve the map: the position of a cut vertex is exactly the sum of its row of `positions` and all of its
        offsets.
    moved_vertices : (k,) int32
        Input vertices that were moved to make thin triangles positive; they are no critical points of the energy.
    is_free_to_rotate : bool
        Does the orbifold fix the map only up to a rotation about its axis (``NN``, ``N*``, ``Nx`` and ``*``), or about any (``1``)? See `rotation_to`.
    faces : (m, 3) int32
        The input faces on cut vertices. Faces of k corners are (m, k); if their numbers differ, a list of tuples.
    triangles : (t, 3) int32
        The same, with polygons divided into triangles.
    source_vertex : (n_cut,) int32
        The input vertex of every cut vertex.
    seams : list of Seam
        ``kind``, ``left``, ``right``, ``transform`` (3 x 3): position(left[i]) = transform position(right[i]).
    cones : list of Cone
        ``vertex``, ``order``, ``kind``, ``copies``.
    group : (k, 3, 3) float64
        The symmetries, the identity first: all |G| of the sphere; of the plane those that take the tile to the 100 nearest places.
    signature : str
        Conway's symbol, or "polygon".
    energy : float
        The Dirichlet energy: the sum over undirected edges of w d^2, d the length of the edge's arc.
    converged : bool
        Did the optimiser reach its tolerance?
    bijective : bool
        Is the map certified? Only converged maps are ever called bijective.
    certificate : dict
        As in the report.
    distortion : dict
        As in the report.
    history : (k,) structured array
        Fields ``energy``, ``gradient_norm`` and ``step``, for the start and every iteration.
    warnings : list of str
        Sentences about what deserves attention.
    weights : EdgeWeights
        ``i``, ``j``, ``w``, and ``to_sparse()``.
    area_distortion : (t,) float64
        Of every triangle: its share of the tile's area over its share of the source's (a ratio A; the report's
        statistics are of max(A, 1/A)). 0 where a triangle is not measured.
    angle_distortion : (t,) float64
        Of every triangle: the ratio of the singular values of its map. 0 where it is not measured.
    report : dict
        The JSON report, with the same keys and meanings as the command line's file.
    """

    __slots__ = ("_core", "_report", "_locator")

    def __init__(self, *_: Any, **__: Any) -> None:
        raise TypeError("an Embedding is made by orbitutte.embed, Solver.embed or Embedding.load")

    @classmethod
    def _of(cls, core: _orbitutte.Embedding) -> Embedding:
        self = object.__new__(cls)
        object.__setattr__(self, "_core", core)
        object.__setattr__(self, "_report", json.loads(core.brief_report))
        object.__setattr__(self, "_locator", None)
        return self

    def __setattr__(self, name: str, value: Any) -> None:
        raise AttributeError(f"an Embedding cannot be changed, nor its '{name}'")

    # Arrays

    @property
    def positions(self) -> npt.NDArray[np.float64]:
        """(n_cut, 3) unit vectors."""
        return self._core.positions

    @property
    def canonical_positions(self) -> npt.NDArray[np.float64]:
        """(n_cut, 3) the positions in the canonical frame of the orbifold."""
        return self._core.canonical_positions

    @property
    def placement(self) -> npt.NDArray[np.float64]:
        """(3, 3) the isometry from the canonical frame to the one of the positions."""
        return self._core.placement

    @property
    def offsets(self) -> Offsets:
        """What positions have beyond their doubles; empty where doubles suffice."""
        return Offsets(*self._core.offsets)

    @property
    def moved_vertices(self) -> npt.NDArray[np.int32]:
        """(k,) the input vertices that were moved to make thin triangles positive."""
        return np.array(self._report.get("moved_vertices", []), dtype=np.int32)

    @property
    def is_free_to_rotate(self) -> bool:
        """Is the map fixed only up to a rotation about the z axis?"""
        return self._core.is_free_to_rotate

    @property
    def faces(self) -> _arrays.Faces:
        """(m, 3) cut vertices, or (m, k), or a list of tuples, as the input's faces are."""
        corners, start = self._core.polygons
        return _arrays.faces(corners, start) if len(start) > 1 else self._core.triangles

    @property
    def triangles(self) -> npt.NDArray[np.int32]:
        """(t, 3) cut vertices."""
        return self._core.triangles

    @property
    def source_vertex(self) -> npt.NDArray[np.int32]:
        """(n_cut,) the input vertex of every cut vertex."""
        return self._core.source_vertex

    @property
    def seams(self) -> list[Seam]:
        """The seams of the cut."""
        return [Seam(*seam) for seam in self._core.seams]

    @property
    def cones(self) -> list[Cone]:
        """The marked vertices with their copies."""
        return [Cone(*cone) for cone in self._core.cones]

    @property
    def group(self) -> npt.NDArray[np.float64]:
        """(k, 3, 3) the identity first; see the class."""
        return self._core.group

    @property
    def weights(self) -> EdgeWeights:
        """The weights that the embedding was computed with, on the uncut mesh. Computed again after `load`."""
        return EdgeWeights(*self._core.weights())

    @property
    def area_distortion(self) -> npt.NDArray[np.float64]:
        """(t,) the area ratio A of every triangle; 0 where it is not measured. Needs the mesh."""
        return self._core.face_distortion()[0]

    @property
    def angle_distortion(self) -> npt.NDArray[np.float64]:
        """(t,) the ratio of singular values of every triangle's map; 0 where it is not measured. Needs the mesh."""
        return self._core.face_distortion()[1]

    # What the report says

    @property
    def report(self) -> dict[str, Any]:
        """The JSON report as a dictionary of the caller's own."""
        return json.loads(self._core.report)

    @property
    def signature(self) -> str:
        return self._report["orbifold"]["signature"]

    @property
    def energy(self) -> float:
        return self._report["energy"]

    @property
    def converged(self) -> bool:
        """Did the optimiser reach its tolerance?"""
        return self._report["termination"] == "converged"

    @property
    def bijective(self) -> bool:
        """Is the map certified to be a bijection onto the orbifold?"""
        return self._report["certificate"]["bijective"]

    @property
    def certificate(self) -> dict[str, Any]:
        """``bijective``, ``nonpositive_faces``, ``signed_area``, ``expected_area``, ``max_edge_length``, ..., ``checks``."""
        return json.loads(self._core.brief_report)["certificate"]

    @property
    def distortion(self) -> dict[str, Any]:
        """``area`` (mean, std, median, max), ``angle`` (mean, max), ``histogram``, ``measured_faces``."""
        return self.report["distortion"]

    @property
    def history(self) -> Array:
        """Structured array with the fields ``energy``, ``gradient_norm`` and ``step``."""
        rows = [(row["energy"], row["gradient_norm"], row["step"]) for row in self._report["history"]]
        array = np.array(rows, dtype=[("energy", "f8"), ("gradient_norm", "f8"), ("step", "f8")])
        array.setflags(write=False)
        return array

    @property
    def warnings(self) -> list[str]:
        """Sentences about what deserves attention."""
        return list(self._report.get("warnings", []))

    # The mesh that was embedded

    @property
    def mesh(self) -> tuple[npt.NDArray[np.float64], _arrays.Faces] | None:
        """(V, F) as they were embedded; None if the embedding was loaded without them."""
        known = self._core.mesh
        return None if known is None else (known.positions, _arrays.faces(*known.faces))

    def with_mesh(self, V: npt.ArrayLike, F: Any) -> Embedding:
        """The same embedding, knowing its mesh."""
        return Embedding._of(self._core.with_mesh(_arrays.mesh(V, F)))

    # Points

    @_deprecated.renamed_arguments(face="triangle", element="copy")
    def map_points(self, triangle: npt.ArrayLike, barycentric: npt.ArrayLike, copy: npt.ArrayLike | None = None) -> Array:
        """Take points of the surface to the sphere or the plane, in the canonical frame of the orbifold.

        Parameters
        ----------
        triangle : (k,) array_like of int, or int
            Rows of `triangles`; -1 gives NaN.
        barycentric : (k, 3) array_like, or (3,)
            Coordinates on the corners of those rows, with the sum 1. The corners are the input's, in its order. Projective planes
            are the exception: some of their faces are turned over (first, third, second), and the input vertices are ``source_vertex[triangles[triangle]]``.
        copy : (k,) array_like of int, or int, optional
            The copies of the tile, indices into `group`; if they are not given, the embedding itself.

        Returns
        -------
        (k, 3) float64, or (3,)
            The combination of the three positions, on the sphere normalised: triangles agree on their edges, and copies on seams.

        Raises
        ------
        ArgumentError
            Names the point whose triangle or copy does not exist, or whose coordinates are none.
        """
        self._warn_of_offsets(stacklevel=4)
        single = np.ndim(triangle) == 0
        triangles, points = _arrays.indices(_rows(triangle, 1), "triangle", "point"), _arrays.positions(_rows(barycentric, 2), "barycentric", "point")
        copies = np.empty(0, dtype=np.int32) if copy is None else _arrays.indices(_rows(copy, 1), "copy", "point")
        if copy is not None and len(copies) == 1 and len(triangles) != 1:
            copies = np.repeat(copies, len(triangles))
        if len(points) != len(triangles) or (copy is not None and len(copies) != len(triangles)):
            raise ArgumentError(f"there are {len(triangles)} triangles, {len(points)} rows of coordinates and {len(copies)} copies")
        images = _orbitutte.map_points(self._core, triangles, points, copies)
        return images[0] if single else images

    def locate(self, points: npt.ArrayLike) -> Location:
        """Find points of the sphere or the plane on the surface, in any of its copies: the inverse of `map_points`.

        The points of another embedding into the same orbifold, with corresponding cones in the same order, are its
        `canonical_positions`; if `is_free_to_rotate`, turn them by `rotation_to` first.

        Parameters
        ----------
        points : (k, 3) array_like, or (3,)
            In the canonical frame; their lengths do not matter.

        Returns
        -------
        Location
            ``triangle``, ``barycentric`` and ``copy``; ``map_points(*location)`` is the direction again. If the embedding is
            certified, every direction is found; in the plane, every point of the copies in `group`. -1 and NaN if nothing is there:
            outside of a polygon, in gaps of an embedding that is not bijective, and for vectors that are zero or not finite. Of several
            copies or triangles the first is taken.

        Notes
        -----
        The first call makes a search tree of the triangles, which the embedding keeps.
        """
        self._warn_of_offsets()
        single = np.ndim(points) == 1 and np.size(points) > 0
        directions = _arrays.positions(_rows(points, 2), "points", "point")
        if self._locator is None:
            object.__setattr__(self, "_locator", _orbitutte.PointLocator(self._core))
        triangle, barycentric, copy = self._locator.locate(directions)
        return Location(int(triangle[0]), barycentric[0], int(copy[0])) if single else Location(triangle, barycentric, copy)

    def rotation_to(self, points: npt.ArrayLike, other_points: npt.ArrayLike) -> npt.NDArray[np.float64]:
        """The rotation that takes points of this map best to those of another one into the same orbifold.

        Parameters
        ----------
        points, other_points : (k, 3) array_like
            Images of corresponding points, in the canonical frame: of all vertices of a mesh, or of one further landmark.

        Returns
        -------
        (3, 3) float64
            ``points @ rotation.T`` lie where `other_points` do, as nearly as a rotation about the axis can bring them there, modulo the
            group; of the whole sphere, a rotation about any axis. The identity unless `is_free_to_rotate`.

        Raises
        ------
        ArgumentError
            The numbers of points differ, or all lie on the axis, or on one line through the centre of the whole sphere.
        """
        first = _arrays.positions(_rows(points, 2), "points", "point")
        second = _arrays.positions(_rows(other_points, 2), "other_points", "point")
        return _orbitutte.rotation_between(self._core, first, second)

    @_deprecated.renamed_arguments(face="triangle")
    def source_points(self, triangle: npt.ArrayLike, barycentric: npt.ArrayLike) -> Array:
        """The same points on the surface in space: (k, 3), or (3,). Needs the mesh; NaN where the triangle is -1."""
        known = self.mesh
        if known is None:
            raise ArgumentError("points in space need the mesh that was embedded; load the embedding with it, or use with_mesh(V, F)")
        triangles = np.asarray(_arrays.indices(_rows(triangle, 1), "triangle", "point"))
        weights = _arrays.positions(_rows(barycentric, 2), "barycentric", "point")
        if len(triangles) != len(weights):
            raise ArgumentError(f"there are {len(triangles)} triangles and {len(weights)} rows of coordinates")
        wrong = (triangles < -1) | (triangles >= len(self.triangles))
        if wrong.any():
            k = int(np.argmax(wrong))
            raise ArgumentError(f"point {k} names the triangle {triangles[k]}; there are {len(self.triangles)}")
        corners = known[0][self.source_vertex[self.triangles[triangles]]]
        points = np.einsum("ki,kij->kj", weights, corners)
        points[triangles == -1] = np.nan
        return points[0] if np.ndim(triangle) == 0 else points

    # Files

    def save(self, ply: str | os.PathLike, json: str | os.PathLike | None = None) -> None:
        """Write the embedding, and its report, as ``orbitutte embed -o PLY --report JSON`` does.

        Raises
        ------
        FileError
            If a file cannot be written. Files appear whole or not at all.
        """
        self._core.save(_arrays.path(ply), b"" if json is None else _arrays.path(json))

    @staticmethod
    def load(ply: str | os.PathLike, json: str | os.PathLike, mesh: Any = None) -> Embedding:
        """Read an embedding and its report, written by `save` or by the command line.

        Parameters
        ----------
        ply, json : path
        mesh : path or (V, F), optional
            The mesh that was embedded: needed for `verify`, distortion, weights and pictures.

        Raises
        ------
        FileError, MeshError
            If a file cannot be read, or is not what it should be.
        """
        return Embedding._of(_orbitutte.load(_arrays.path(ply), _arrays.path(json), _known_mesh(mesh)))

    def write_tiling(self, path: str | os.PathLike) -> None:
        """Write the |G| copies as one closed mesh: .ply, .obj, .stl or .glb, as ``orbitutte tile`` does."""
        self._warn_of_offsets()
        self._core.write_tiling(_arrays.path(path))

    def render(self, path: str | os.PathLike, *, panel: str = "sheet", size: Any = None, view: Any = None, up: Any = None,
               title: str = "") -> None:
        """Draw a picture, as ``orbitutte render`` does: .png, or .svg for histogram and convergence.

        Parameters
        ----------
        path : path
        panel : str
            "source", "sphere", "area", "angle", "checkerboard", "histogram", "convergence" or "sheet".
        size : int, (width, height) or str, optional
            Pixels.
        view : str or (3,) array, optional
            "front", "back", "left", "right", "top", "bottom", or the direction towards the viewer.
        up : str or (3,) array, optional
            "x", "-x", ... "-z", or what points up.
        title : str
            Of the sheet.

        Raises
        ------
        ArgumentError
            If an option is out of range, if the mesh is not known, or if the module was built without pictures.
        """
        self._warn_of_offsets()
        texts = {"panel": _options.text(panel, "panel")}
        if size is not None:
            texts["size"] = _size(size)
        for name, value in (("view", view), ("up", up)):
            if value is not None:
                texts[name] = value if isinstance(value, str) else _direction(value, name)
        _orbitutte.render(self._core, _arrays.path(path), _options.text(title, "title"), texts)

    def _warn_of_offsets(self, stacklevel: int = 3) -> None:
        """For methods that use the doubles alone; `stacklevel` is that of their caller, farther by one through a decorator."""
        for sentence in self._core.offset_warnings:
            warnings.warn(sentence, EmbeddingWarning, stacklevel=stacklevel)

    # What Python itself needs

    def __repr__(self) -> str:
        mesh, order = self._report["mesh"], self._report["orbifold"]["group_order"]
        state = "bijective" if self.bijective else "not certified" if self.converged else f"not converged ({self._report['termination']})"
        return (f"<orbitutte.Embedding onto {self.signature} (|G| = {order or 'infinite'}): {mesh['vertices']} vertices, {mesh['faces']} faces, "
                f"{len(self.source_vertex)} cut vertices;\n energy {self.energy:.9g} after {self._report['iterations']} iterations, {state}>")

    def __reduce__(self) -> Any:
        known = self._core.mesh
        mesh = None if known is None else (known.positions, *known.faces)
        return _unpickled, (self._core.ply(), self._core.report, mesh)

    def __copy__(self) -> Embedding:
        return self

    def __deepcopy__(self, _: Any) -> Embedding:
        return self


def _rows(values: Any, dimensions: int) -> Any:
    """A single point as a row of one."""
    return [values] if np.ndim(values) == dimensions - 1 and np.size(values) > 0 else values


def _unpickled(ply: bytes, report: str, mesh: tuple | None) -> Embedding:
    known = None
    if mesh is not None:
        V, corners, start = mesh
        known = _orbitutte.Mesh(V, corners) if start is None else _orbitutte.Mesh(V, corners, start)
    return Embedding._of(_orbitutte.unpickled(ply, report, known))


def _known_mesh(mesh: Any) -> _orbitutte.Mesh | None:
    """The mesh of a path, or of (V, F)."""
    if mesh is None:
        return None
    if isinstance(mesh, (str, bytes, os.PathLike)):
        return _orbitutte.Mesh.read(_arrays.path(mesh))
    if not isinstance(mesh, (tuple, list)) or len(mesh) != 2:
        raise TypeError("mesh must be a path, or (V, F)")
    return _arrays.mesh(*mesh)


def _size(size: Any) -> str:
    if isinstance(size, str):
        return size
    sides = size if isinstance(size, (tuple, list)) else [size]
    if len(sides) not in (1, 2):
        raise ArgumentError("size must be a width, or a width and a height")
    return "x".join(str(_options.whole(side, "size")) for side in sides)


def _direction(value: Any, name: str) -> str:
    vector = np.asarray(value)
    if vector.shape != (3,) or vector.dtype.kind not in "fiu":
        raise TypeError(f"{name} must be a name or three numbers")
    return ",".join(repr(float(entry)) for entry in vector)
