// SPDX-License-Identifier: MIT
// A map with a limb that shrinks as far as is wanted, built by hand with all digits: rings of vertices around
// a corner of the tile, each smaller than the one before by the same factor. The seams run through the limb.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/precise_group.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/tile.h"
#include "test_meshes.h"

namespace orbitutte::test {

using Exact = Vector3Of<MostPrecise>;

/// Writes the position of a vertex as a row of doubles and offsets, until nothing is left or the rest is
/// below 1e-18 of `scale`.
inline void store(Embedding& embedding, int v, const Exact& position, double scale) {
  std::erase_if(embedding.offsets, [&](const Offset& offset) { return offset.vertex == v; });
  const Vector3 row = position.cast<double>();
  embedding.positions.row(v) = row;
  Exact rest = position - row.cast<MostPrecise>();
  const auto largest = [&] { return static_cast<double>(MostPrecise(rest.cwiseAbs().maxCoeff())); };
  while (largest() > 1e-18 * scale) {
    const Vector3 d = rest.cast<double>();
    embedding.offsets.push_back({v, d});
    rest -= d.cast<MostPrecise>();
  }
}

/// 532, cut open along the seams from the cone of order 2, the limb's tip, and from that of order 5.
class Limb {
 public:
  /// `rings` rings, each `factor` times as large as the one before; in all about `factor`^rings.
  Limb(double factor, int rings) : factor_(factor), rings_(rings) {
    embedding.target = parse_orbifold("532");
    const PreciseGroup<MostPrecise> group(embedding.target);
    const Tile tile = basic_tile(embedding.target, {0, 1, 2});
    tip_ = group.held_point(tile.sides[2].start);
    const Exact p1 = group.held_point(tile.sides[0].start), p2 = group.held_point(tile.sides[1].start);
    const Exact image = group.element(tile.sides[2].transform) * p2;
    around_ = {image, group.retract(p1 + image), p1, group.retract(p1 + p2), p2};
    make_vertices();
    make_faces();
    glue(tile);
    for (int ring = 0; ring <= rings_; ++ring)
      for (int j = 0; j < 5; ++j) store(embedding, vertex(ring, j), point(group, ring, j), scale(ring));
    store(embedding, 0, tip_, scale(rings_));
  }

  /// Of the cut mesh: 0 is the tip; points j = 0 and 4 of a ring lie on the two banks of its seam.
  int vertex(int ring, int j) const { return vertices_[ring][j]; }

  /// The size of a ring.
  double scale(int ring) const { return std::pow(factor_, ring); }

  Exact point(const PreciseGroup<MostPrecise>& group, int ring, int j) const {
    MostPrecise t = 1;
    for (int k = 0; k < ring; ++k) t *= factor_;
    return group.retract(tip_ + t * (around_[j] - tip_));
  }

  /// The faces between a ring and the next smaller one: twice its four.
  int first_face(int ring) const { return 8 * ring; }

  Surface surface() const { return unjudged(mesh); }

  Mesh mesh;  ///< round about a cone over the limb
  Embedding embedding;

 private:
  // The input's vertices first: the tip; of ring 0 image, the middle beside it and p1, copies of p2 and the
  // other middle; of all others four, of which the first has a copy.
  void make_vertices() {
    std::vector<int>& source = embedding.source_vertex;
    source.push_back(0);
    vertices_.resize(rings_ + 1);
    for (int ring = 0; ring <= rings_; ++ring)
      for (int j = 0; j < (ring == 0 ? 3 : 4); ++j) vertices_[ring][j] = add(static_cast<int>(source.size()));
    mesh.V.resize(static_cast<Eigen::Index>(source.size()), 3);
    mesh.V.row(0) << 0, 0, rings_ + 1;
    for (int ring = 0; ring <= rings_; ++ring)
      for (int j = 0; j < (ring == 0 ? 3 : 4); ++j)
        mesh.V.row(vertices_[ring][j]) << std::cos(1.57 * j), std::sin(1.57 * j), ring;
    vertices_[0][3] = add(vertices_[0][1]);
    for (int ring = 0; ring <= rings_; ++ring) vertices_[ring][4] = add(vertices_[ring][0]);
    embedding.positions.resize(static_cast<Eigen::Index>(source.size()), 3);
  }

  int add(int source) {
    embedding.source_vertex.push_back(source);
    return static_cast<int>(embedding.source_vertex.size()) - 1;
  }

  void make_faces() {
    std::vector<std::array<int, 3>> faces;
    for (int ring = 0; ring < rings_; ++ring) {
      for (int j = 0; j < 4; ++j) {
        faces.push_back({vertex(ring, j), vertex(ring, j + 1), vertex(ring + 1, j)});
        faces.push_back({vertex(ring, j + 1), vertex(ring + 1, j + 1), vertex(ring + 1, j)});
      }
    }
    for (int j = 0; j < 4; ++j) faces.push_back({vertex(rings_, j), vertex(rings_, j + 1), 0});
    embedding.triangles.resize(static_cast<Eigen::Index>(faces.size()), 3);
    for (std::size_t f = 0; f < faces.size(); ++f)
      embedding.triangles.row(static_cast<Eigen::Index>(f)) << faces[f][0], faces[f][1], faces[f][2];
    mesh.F = embedding.triangles.unaryExpr([&](int v) { return embedding.source_vertex[v]; });
  }

  void glue(const Tile& tile) {
    Seam limb, other;
    limb.left = limb.right = {0};
    for (int ring = rings_; ring >= 0; --ring) {
      limb.left.push_back(vertex(ring, 0));
      limb.right.push_back(vertex(ring, 4));
    }
    limb.transform = tile.sides[2].transform;
    other.left = {vertex(0, 2), vertex(0, 3), vertex(0, 4)};
    other.right = {vertex(0, 2), vertex(0, 1), vertex(0, 0)};
    other.transform = tile.sides[0].transform;
    embedding.seams = {limb, other};
    const std::vector<Mark>& marks = embedding.target.marks;
    embedding.cones = {{vertex(0, 2), marks[0], {vertex(0, 2)}},
                       {vertex(0, 0), marks[1], {vertex(0, 0), vertex(0, 4)}},
                       {0, marks[2], {0}}};
  }

  double factor_;
  int rings_;
  Exact tip_;
  std::array<Exact, 5> around_;  ///< ring 0
  std::vector<std::array<int, 5>> vertices_;
};

}  // namespace orbitutte::test
