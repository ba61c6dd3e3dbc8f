// SPDX-License-Identifier: MIT
#include "orbitutte/export/tiling.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "orbitutte/export/closed_mesh.h"
#include "orbitutte/export/tiled_faces.h"
#include "orbitutte/mesh/disjoint_sets.h"
#include "orbitutte/orbifold/symmetry_group.h"

namespace orbitutte {
namespace {

void check_vertices(const std::vector<int>& vertices, int count) {
  for (const int v : vertices)
    if (v < 0 || v >= count)
      throw ArgumentError(fmt::format("a seam names the cut vertex {}, but there are {}", v, count));
}

/// Checks for errors that an embedding may have if it was read from files.
void check_embedding(const Embedding& embedding, int copies) {
  const int vertices = static_cast<int>(embedding.positions.rows());
  if (!embedding.positions.allFinite())
    throw ArgumentError("the embedding has positions that are not finite");
  if (embedding.source_vertex.size() != static_cast<std::size_t>(vertices))
    throw ArgumentError("the embedding does not name a source vertex for every cut vertex");
  if (embedding.triangles.size() > 0 &&
      (embedding.triangles.minCoeff() < 0 || embedding.triangles.maxCoeff() >= vertices))
    throw ArgumentError("a face of the embedding names a vertex that does not exist");
  for (const Seam& seam : embedding.seams) {
    if (seam.left.size() != seam.right.size())
      throw ArgumentError("the two banks of a seam have different lengths");
    check_vertices(seam.left, vertices);
    check_vertices(seam.right, vertices);
  }
  if (embedding.target.is_polygon())
    throw ArgumentError(
        "the embedding has no seams, so that no symmetric copies of it tile the sphere; embed the mesh into "
        "an orbifold, not into a fixed polygon");
  const auto corners = static_cast<long long>(embedding.polygons.corners.size());
  const long long largest = std::max<long long>({vertices, embedding.triangles.rows(), corners});
  if (3 * largest * copies > std::numeric_limits<int>::max())
    throw ArgumentError(
        fmt::format("{} copies of {} faces have more than 2^31 - 1 corners; tile a coarser mesh", copies,
                    embedding.triangles.rows()));
}

/// The group of the copies that are asked for: all, or `copies` of infinitely many.
SymmetryGroup checked_group(const Embedding& embedding, int copies) {
  if (copies < 1) throw ArgumentError(fmt::format("{} copies make no tiling; ask for one or more", copies));
  const int order = embedding.target.group_order;
  check_embedding(embedding, order > 0 ? order : copies);
  return group_of(embedding, copies);
}

/// across[s][g]: the copy whose right bank of seam s meets the left bank of seam s of copy g; -1 at the
/// border of a patch.
std::vector<std::vector<int>> copies_across_seams(const Embedding& embedding, const SymmetryGroup& group) {
  std::vector<std::vector<int>> across;
  for (const Seam& seam : embedding.seams) {
    across.push_back(group.right_products(seam.transform));
    if (embedding.target.group_order > 0 && std::count(across.back().begin(), across.back().end(), -1) > 0)
      throw ArgumentError("the transform of a seam does not belong to the group of the orbifold");
  }
  return across;
}

/// Gives every copy the first colour that no neighbour has, copy by copy.
std::vector<int> greedy_colours(const std::vector<std::vector<int>>& across, int count) {
  std::vector<std::vector<int>> neighbours(count);
  for (const std::vector<int>& copies : across) {
    for (int g = 0; g < count; ++g) {
      if (copies[g] == g || copies[g] < 0) continue;
      neighbours[g].push_back(copies[g]);
      neighbours[copies[g]].push_back(g);
    }
  }
  std::vector<int> colour(count, -1);
  for (int g = 0; g < count; ++g) {
    const auto taken = [&](int c) {
      return std::any_of(neighbours[g].begin(), neighbours[g].end(), [&](int h) { return colour[h] == c; });
    };
    int c = 0;
    while (taken(c)) ++c;
    colour[g] = c;
  }
  return colour;
}

std::vector<TileCopy> tile_copies(const SymmetryGroup& group, const std::vector<std::vector<int>>& across) {
  const std::vector<int> colours = greedy_colours(across, group.order());
  std::vector<TileCopy> copies;
  copies.reserve(group.elements().size());
  for (const Isometry& g : group.elements())
    copies.push_back({g, g.reverses_orientation(), colours[copies.size()]});
  return copies;
}

/// The vertices of the sphere. A vertex inside the tile has an image in every copy. Copies of vertices on
/// seams coincide, so only these need sets. Vertices that no face uses have no copies.
struct Welding {
  /// The cut vertices that faces use, ascending.
  std::vector<int> copied;
  /// n_cut: a number for every copied vertex on a seam; -1 for all others.
  std::vector<int> on_seam;
  /// The number of vertices that have such a number.
  int seam_vertices = 0;
  /// |G| x seam_vertices, copy by copy: the smallest member of each member's set.
  std::vector<int> smallest;
  /// Of the sphere.
  int vertices = 0;
};

/// A mirror's number is the index of its reflection in the group, across[s][0]; if the patch does not
/// contain the reflection, the number is that of the seam.
MirrorsOfVertices mirrors_of_vertices(const Embedding& embedding,
                                      const std::vector<std::vector<int>>& across) {
  MirrorsOfVertices mirrors(embedding.positions.rows(), {-1, -1});
  for (std::size_t s = 0; s < across.size(); ++s) {
    if (embedding.seams[s].left != embedding.seams[s].right) continue;
    const int copies = static_cast<int>(across[s].size());
    const int mirror = across[s].front() >= 0 ? across[s].front() : copies + static_cast<int>(s);
    for (const int v : embedding.seams[s].left)
      if (mirrors[v][0] != mirror) mirrors[v][mirrors[v][0] < 0 ? 0 : 1] = mirror;
  }
  return mirrors;
}

std::vector<char> vertices_in_faces(const TiledFaces& tiled, Eigen::Index vertices) {
  std::vector<char> used(vertices, 0);
  for (const int v : tiled.triangles.reshaped()) used[v] = 1;
  return used;
}

std::vector<char> vertices_in_seams(const Embedding& embedding) {
  std::vector<char> used(embedding.positions.rows(), 0);
  for (const Seam& seam : embedding.seams) {
    for (const int v : seam.left) used[v] = 1;
    for (const int v : seam.right) used[v] = 1;
  }
  return used;
}

/// Copy g of left[i] is copy across[g] of right[i].
void unite_banks(const Seam& seam, const std::vector<int>& across, const Welding& welding,
                 DisjointSets& sets) {
  const int width = welding.seam_vertices;
  for (std::size_t i = 0; i < seam.left.size(); ++i) {
    const int left = welding.on_seam[seam.left[i]];
    const int right = welding.on_seam[seam.right[i]];
    if (left < 0 || right < 0) continue;
    for (std::size_t g = 0; g < across.size(); ++g)
      if (across[g] >= 0) sets.unite(static_cast<int>(g) * width + left, across[g] * width + right);
  }
}

// across: as copies_across_seams; so many copies.
Welding weld(const Embedding& embedding, const TiledFaces& tiled, const std::vector<std::vector<int>>& across,
             int copies) {
  const std::vector<char> in_face = vertices_in_faces(tiled, embedding.positions.rows());
  const std::vector<char> in_seam = vertices_in_seams(embedding);
  Welding welding;
  welding.on_seam.assign(in_face.size(), -1);
  for (int v = 0; v < static_cast<int>(in_face.size()); ++v) {
    if (in_face[v]) welding.copied.push_back(v);
    if (in_face[v] && in_seam[v]) welding.on_seam[v] = welding.seam_vertices++;
  }

  DisjointSets sets(copies * welding.seam_vertices);
  for (std::size_t s = 0; s < across.size(); ++s) unite_banks(embedding.seams[s], across[s], welding, sets);

  const int inside = static_cast<int>(welding.copied.size()) - welding.seam_vertices;
  welding.vertices = copies * inside;
  welding.smallest.resize(copies * welding.seam_vertices);
  for (int i = 0; i < static_cast<int>(welding.smallest.size()); ++i) {
    welding.smallest[i] = sets.find(i);
    if (welding.smallest[i] == i) ++welding.vertices;
  }
  return welding;
}

/// A closed mesh of triangles has 3/2 as many edges as faces, so Euler's V - E + F = 2 becomes 2 V = F + 4.
void check_sphere(long long vertices, long long faces) {
  if (2 * vertices != faces + 4)
    throw ArgumentError(
        "the copies of the embedding do not close up into a sphere: its seams are not its whole boundary");
}

/// Appends the vertices of the tile's copies in turn, except those that an earlier copy has added.
class VertexSweep {
 public:
  VertexSweep(const Embedding& embedding, const Welding& welding, Tiling& tiling)
      : embedding_(embedding),
        welding_(welding),
        tiling_(tiling),
        vertex_of_(embedding.positions.rows(), -1),
        vertex_of_set_(welding.smallest.size(), -1) {
    tiling_.mesh.V.resize(welding.vertices, 3);
    tiling_.source_vertex.resize(welding.vertices);
  }

  /// The vertices of the sphere at the cut vertices of copy g. Call it for g = 0, 1, 2, ... in turn.
  const std::vector<int>& copy(int g) {
    for (const int v : welding_.copied) {
      const int k = welding_.on_seam[v];
      vertex_of_[v] = k < 0 ? append(g, v) : on_seam(g, v, g * welding_.seam_vertices + k);
    }
    return vertex_of_;
  }

 private:
  /// The smallest member of a set is the first that the sweep meets.
  int on_seam(int g, int v, int member) {
    const int first = welding_.smallest[member];
    if (first == member) vertex_of_set_[first] = append(g, v);
    return vertex_of_set_[first];
  }

  int append(int g, int v) {
    const Vector3 position = tiling_.copies[g].transform * embedding_.positions.row(v).transpose();
    tiling_.mesh.V.row(next_) = embedding_.space().retract(position);
    tiling_.source_vertex[next_] = embedding_.source_vertex[v];
    return next_++;
  }

  const Embedding& embedding_;
  const Welding& welding_;
  Tiling& tiling_;
  std::vector<int> vertex_of_;      // n_cut: of the current copy
  std::vector<int> vertex_of_set_;  // |G| x seam vertices: set for the smallest members
  int next_ = 0;
};

/// Appends the polygons of copy g, each from the same corner on; mirrored copies are turned over.
void place_polygons(const TiledFaces& tiled, int g, const std::vector<int>& vertex_of, Tiling& tiling) {
  std::vector<int>& corners = tiling.polygons.corners;
  const FaceView polygons(tiled.polygons);
  for (int f = 0; f < polygons.count(); ++f) {
    const std::size_t begin = corners.size();
    for (const int v : polygons[f]) corners.push_back(vertex_of[v]);
    if (tiling.copies[g].mirrored)
      std::reverse(corners.begin() + static_cast<std::ptrdiff_t>(begin) + 1, corners.end());
    tiling.polygons.start.push_back(static_cast<int>(corners.size()));
  }
}

/// Sets the triangles of copy g; mirrored copies are turned over.
void place_triangles(const TiledFaces& tiled, int g, const std::vector<int>& vertex_of, Tiling& tiling) {
  const Eigen::Index faces = tiled.triangles.rows();
  const int second = tiling.copies[g].mirrored ? 2 : 1;
  for (Eigen::Index f = 0; f < faces; ++f) {
    const Eigen::Index row = g * faces + f;
    tiling.mesh.F(row, 0) = vertex_of[tiled.triangles(f, 0)];
    tiling.mesh.F(row, 1) = vertex_of[tiled.triangles(f, second)];
    tiling.mesh.F(row, 2) = vertex_of[tiled.triangles(f, 3 - second)];
    tiling.copy[row] = g;
  }
}

void require_copies_that_fit(const Target& target) {
  if (tiles_its_space(target)) return;
  throw ArgumentError(
      fmt::format("copies of the tile fill no plane, since not all angles of {} are 2 pi/n, and pi/n at "
                  "corners; embed the "
                  "mesh into an orbifold",
                  target.signature));
}

void require_closed(const Tiling& tiling) {
  if (tiling.polygons.count() > 0) {
    require_closed_sphere(tiling.mesh.V, tiling.polygons);
  } else {
    require_closed_sphere(tiling.mesh);
  }
}

}  // namespace

std::vector<TileCopy> tile_copies(const Embedding& embedding, int copies) {
  const SymmetryGroup group = checked_group(embedding, copies);
  return tile_copies(group, copies_across_seams(embedding, group));
}

Tiling weld_copies(const Embedding& embedding, int copies) {
  require_copies_that_fit(embedding.target);
  const SymmetryGroup group = checked_group(embedding, copies);
  const std::vector<std::vector<int>> across = copies_across_seams(embedding, group);
  const TiledFaces tiled = tiled_faces(embedding, mirrors_of_vertices(embedding, across));
  const Welding welding = weld(embedding, tiled, across, group.order());
  const Eigen::Index faces = group.order() * tiled.triangles.rows();
  const bool closes_up = embedding.target.group_order > 0;
  if (closes_up) check_sphere(welding.vertices, faces);

  Tiling tiling;
  tiling.copies = tile_copies(group, across);
  tiling.input_faces = tiled.input_faces;
  tiling.left_out = tiled.left_out;
  tiling.mesh.F.resize(faces, 3);
  tiling.copy.resize(faces);
  tiling.source_face.reserve(faces);
  VertexSweep sweep(embedding, welding, tiling);
  for (int g = 0; g < tiling.copy_count(); ++g) {
    const std::vector<int>& vertex_of = sweep.copy(g);
    place_triangles(tiled, g, vertex_of, tiling);
    place_polygons(tiled, g, vertex_of, tiling);
    tiling.source_face.insert(tiling.source_face.end(), tiled.face_of.begin(), tiled.face_of.end());
  }
  if (closes_up) require_closed(tiling);
  return tiling;
}

}  // namespace orbitutte
