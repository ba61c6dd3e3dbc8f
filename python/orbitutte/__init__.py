# SPDX-License-Identifier: MIT
"""Spherical orbifold Tutte embeddings (Aigerman, Kovalsky and Lipman 2017) of meshes in NumPy arrays.

>>> import orbitutte
>>> V, F = orbitutte.read_mesh("figure.ply")
>>> embedding = orbitutte.embed(V, F)
>>> embedding.bijective
True

Functions
---------
embed(V, F, signature="best", cones="best", *, objective, progress, polygon, geometry, weights, ...) -> Embedding
choose(V, F) -> list of dict            the best cones of every family, the best first
Solver(V, F, **options).embed(signature, cones) -> Embedding     many embeddings of one mesh
info(V, F) -> dict                      topology, quality, defects, what a mesh embeds into
families() -> list of dict              the families of orbifolds
choose_cones(V, F, signature) -> list   well separated vertices to be marked
fitted_cones(V, F, count) -> FittedCones    cones of the angles that distort least, for embed(V, F, "cones", vertices, angles=angles)
embed_fitted(V, F, count) -> Embedding  with these cones, or with milder ones if the map is not certified
map_between((V, F), (V, F), landmarks) -> SurfaceMap     a bijection between two surfaces
    to_b(points), to_a(points), pull(values), push(values), matrix(), overlay(), morph(t), write_morph(path),
    bake(picture, of_b, on_a) -> Texture, save(folder), load(folder, A, B)
Resampler(embedding, grid, kind)        values to icospheres, HEALPix, images of sphere or torus and back: resampler(values)
    back(values), table(), back_table(), matrix(), pad(image, margin), pad_indices(margin), points, areas, shape
resample(embedding, values, grid) -> values
verify(embedding[, V, F]) -> dict       the certificate again, from the data alone
distortion(embedding[, V, F]) -> dict   area and angle distortion again
distortion_floor(V, F, signature, cones) -> dict    the distortion that the coarseness of the mesh costs
tile(embedding) -> (V, F, copy)         |G| copies, welded into one closed mesh
sample_mesh(shape, faces) -> (V, F)     a mesh to try things with
read_mesh(path) -> (V, F)               OBJ, OFF, PLY, STL, VTK, VTP, glTF, GIfTI, FreeSurfer; .gz
read_texture_layout(path) -> TextureLayout    of an OBJ, for SurfaceMap.bake
write_mesh(path, V, F)
read_vertex_data(path) -> VertexData    values, names, labels of GIfTI, FreeSurfer, .csv, .txt, .npy; .gz
write_vertex_data(path, values[, names, labels])
build() -> dict                         version, commit, linear algebra
keep_freed_memory(), use_huge_pages()   for programs that embed many large meshes
Embedding                               positions, faces, source_vertex, seams, group, energy, certificate, ...;
    map_points(triangle, barycentric[, copy])      points of the surface to the sphere
    locate(points) -> (triangle, barycentric, copy)    and back, from anywhere on the tiled sphere
    source_points(triangle, barycentric)    the same points in space
    save(ply, json), load(ply, json[, mesh]), write_tiling(path), render(path, panel=..., size=...)

Exceptions: Error, of which MeshError and ArgumentError are ValueErrors and FileError is an OSError; Cancelled. Results that
are not converged or not certified come with an EmbeddingWarning, and files of which something was ignored with a MeshWarning.
"""
try:
    from . import _orbitutte
except ImportError as error:
    raise ImportError(f"the compiled module of orbitutte, _orbitutte, cannot be loaded from {__path__[0]}: {error}; './demo.sh' or "
                      "'cmake --build build --target orbitutte_package' builds it into build/python, where "
                      "PYTHONPATH=build/python finds it; it belongs to the Python that it was built for") from error

from ._api import (
    FittedCones, Solver, Tiling, build, choose, choose_cones, distortion, distortion_floor, embed, embed_fitted, families, fitted_cones, info, keep_freed_memory, read_mesh, sample_mesh, signatures, tile,
    use_huge_pages, verify, write_mesh,
)
from ._embedding import Cone, EdgeWeights, Embedding, Location, Offsets, Seam
from ._map import Overlay, SurfaceMap, SurfacePoints, Texture, TextureLayout, map_between, read_texture_layout
from ._orbitutte import __version__
from ._resample import Resampler, Table, resample
from ._values import ValueLabel, VertexData, read_vertex_data, write_vertex_data
from .errors import ArgumentError, Cancelled, EmbeddingWarning, Error, FileError, MeshError, MeshWarning

__all__ = [
    "ArgumentError", "Cancelled", "Cone", "EdgeWeights", "Embedding", "EmbeddingWarning", "Error", "FileError",
    "FittedCones", "Location", "MeshError", "MeshWarning", "Offsets", "Overlay", "Resampler", "Seam", "Solver", "SurfaceMap", "SurfacePoints", "Table",
    "Texture", "TextureLayout", "Tiling", "ValueLabel", "VertexData", "__version__",
    "build", "choose", "choose_cones", "distortion",
    "distortion_floor", "embed", "embed_fitted", "families", "fitted_cones", "info", "keep_freed_memory", "map_between", "read_mesh", "read_texture_layout",
    "read_vertex_data", "resample", "sample_mesh", "signatures", "tile",
    "use_huge_pages", "verify", "write_mesh", "write_vertex_data",
]
