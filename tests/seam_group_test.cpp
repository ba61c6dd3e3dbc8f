// SPDX-License-Identifier: MIT
// The group of a free tile with all digits: whatever the positions of its marks, its relations hold.
#include "orbitutte/orbifold/seam_group.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <complex>
#include <map>
#include <numbers>
#include <random>
#include <set>

#include "orbitutte/embed.h"
#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/solve/boundary_conditions.h"
#include "test_meshes.h"

namespace orbitutte::seam_group_test {
namespace {

using std::numbers::pi;
using Exact = Matrix3Of<Precise>;
using ExactPoint = Vector3Of<Precise>;

constexpr double last_digits = 1e-80;

Mark cone(double angle) { return {angle, ConeKind::rotation}; }
Mark corner(double angle) { return {angle, ConeKind::corner}; }

double largest(const Exact& matrix) { return static_cast<double>(Precise(matrix.cwiseAbs().maxCoeff())); }
double largest(const ExactPoint& point) { return static_cast<double>(Precise(point.cwiseAbs().maxCoeff())); }

/// Where vertices are held (n x 3); zero elsewhere.
Points held_points(const BoundaryConditions& boundary) {
  Points result = Points::Zero(boundary.vertex_count(), 3);
  for (const auto& [v, point] : boundary.held) result.row(v) = point;
  return result;
}

/// A surface that is cut along a tree, and glued to a tile of some shape whose marks are a little off.
struct GluedCase {
  GluedCase(const Target& the_target, std::uint64_t cut_seed, double off) : target(the_target) {
    const Mesh mesh = target.topology == Topology::sphere ? test::perturbed(test::icosphere(2), 0.02, 7)
                                                          : test::perturbed(test::round_disk(8), 0.02, 7);
    cut = cut_along_tree(test::unjudged(mesh), choose_cones(mesh, target), target.inner_marks, {cut_seed});
    Points positions = target.space == Space::plane() ? positions_of_marks(cut, some_shape())
                                                      : held_points(boundary_of(any_tile(target, cut)));
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-off, off);
    for (const int mark : cut.marks)
      positions.row(mark) = target.space.retract(Vector3(positions.row(mark)) +
                                                 Vector3(uniform(generator), uniform(generator), 0));
    boundary = boundary_of(tile_through(target, cut, positions));
  }

  // In which no two marks coincide.
  Eigen::VectorXcd some_shape() const {
    const TileShapes shapes = tile_shapes(target, cut);
    Eigen::VectorXcd sum = Eigen::VectorXcd::Zero(shapes.basis.rows());
    for (Eigen::Index k = 0; k < shapes.basis.cols(); ++k)
      sum += std::polar(1.0, shapes.may_be_turned ? 0.7 * static_cast<double>(k * k) : 0.0) *
             shapes.basis.col(k);
    return sum;
  }

  BoundaryConditions boundary_of(const Tile& tile) const { return glue(cut, tile, target); }

  PreciseGroup<Precise> group() const {
    const auto position = [this](int v) -> ExactPoint {
      const Vector3 p = boundary.transform(v) * boundary.held_at(cut.source_vertex[v]);
      return p.cast<Precise>();
    };
    return group_of_boundary<Precise>(
        target, {cut.boundary, cut.source_vertex, boundary.seams, boundary.cones, position});
  }

  Target target;
  CutMesh cut;
  BoundaryConditions boundary;
};

std::vector<Target> free_targets() {
  std::vector<Target> targets;
  for (const auto& marks : std::vector<std::vector<Mark>>{
           {cone(pi), cone(pi), cone(pi), cone(pi)},
           {cone(1.2 * pi), cone(1.6 * pi), cone(0.3 * pi), cone(1.9 * pi), cone(pi)},
           {cone(1.6 * pi), cone(1.6 * pi), cone(1.6 * pi), cone(1.6 * pi)},
           {cone(pi), cone(pi), cone(pi), cone(pi), cone(pi)},
           {cone(pi), cone(0.7 * pi), cone(pi), cone(2 * pi / 3), cone(pi), cone(1.2 * pi)}})
    targets.push_back(cone_target(Topology::sphere, marks));
  for (const auto& marks : std::vector<std::vector<Mark>>{
           {corner(0.5 * pi), corner(0.5 * pi), corner(0.5 * pi), corner(0.5 * pi)},
           {corner(0.5 * pi), corner(0.5 * pi), corner(1.5 * pi), corner(0.5 * pi), corner(0.5 * pi),
            corner(0.5 * pi)},
           {cone(1.3 * pi), corner(0.5 * pi), corner(0.7 * pi), corner(0.5 * pi)},
           {cone(1.2 * pi), cone(1.5 * pi), corner(0.6 * pi), corner(0.7 * pi)},
           {cone(0.5 * pi), corner(0.5 * pi)},
           {cone(0.8 * pi), cone(1.2 * pi)}})
    targets.push_back(cone_target(Topology::disk, marks));
  return targets;
}

std::vector<GluedCase> all_cases() {
  std::vector<GluedCase> cases;
  for (const Target& target : free_targets())
    for (const std::uint64_t seed : {0, 1, 2})
      for (const double off : {0.0, 1e-11}) cases.emplace_back(target, seed, off);
  return cases;
}

std::string name_of_case(const GluedCase& c) {
  std::string name = c.target.signature + " " + c.target.space.name();
  for (const Mark& mark : c.target.marks) name += " " + std::to_string(mark.angle / pi);
  return name;
}

/// position(l) = g position(r).
struct Link {
  int l, r;
  Exact g;
};

/// What the seams say of the copies of each input vertex.
std::map<int, std::vector<Link>> links_of(const GluedCase& c, const PreciseGroup<Precise>& group) {
  std::map<int, std::vector<Link>> links;
  for (const Seam& seam : c.boundary.seams) {
    if (seam.is_mirror()) continue;
    const Exact g = group.element(seam.transform);
    for (std::size_t k = 0; k < seam.left.size(); ++k)
      links[c.cut.source_vertex[seam.left[k]]].push_back({seam.left[k], seam.right[k], g});
  }
  return links;
}

/// Takes the last of the copies that are linked to the first one to that: the product along the links, until
/// none is left.
struct Chain {
  int first, last;
  Exact product;
};

Chain chain_from(int first, std::vector<Link> links, Space space) {
  Chain chain = {first, first, Exact::Identity()};
  for (;;) {
    const auto at = std::find_if(links.begin(), links.end(), [&](const Link& link) {
      return link.l == chain.last || link.r == chain.last;
    });
    if (at == links.end()) return chain;
    const bool is_left = at->l == chain.last;
    chain.product = chain.product * (is_left ? at->g : precise_inverse(space, at->g));
    chain.last = is_left ? at->r : at->l;
    links.erase(at);
  }
}

/// The mirrors' reflections at the cut vertices where they end.
std::map<int, std::vector<Exact>> mirrors_at_ends(const GluedCase& c, const PreciseGroup<Precise>& group) {
  std::map<int, std::vector<Exact>> mirrors;
  for (const Seam& seam : c.boundary.seams)
    if (seam.is_mirror())
      for (const int end : {seam.left.front(), seam.left.back()})
        mirrors[end].push_back(group.element(seam.transform));
  return mirrors;
}

TEST(SeamGroup, ElementsAreIsometriesNearThoseInDoubles) {
  for (const GluedCase& c : all_cases()) {
    SCOPED_TRACE(name_of_case(c));
    const PreciseGroup<Precise> group = c.group();
    for (const Seam& seam : c.boundary.seams) {
      const Exact g = group.element(seam.transform);
      const double size = seam.transform.matrix().cwiseAbs().maxCoeff();
      EXPECT_LT((g.cast<double>() - seam.transform.matrix()).cwiseAbs().maxCoeff(), 1e-9 * size);
      EXPECT_LT(largest(Exact(precise_inverse(c.target.space, g) * g - Exact::Identity())),
                last_digits * size * size);
    }
  }
}

TEST(SeamGroup, CopiesAroundEveryVertexOfASphereCloseToTheLastDigit) {
  for (const GluedCase& c : all_cases()) {
    if (c.target.topology != Topology::sphere) continue;
    SCOPED_TRACE(name_of_case(c));
    const PreciseGroup<Precise> group = c.group();
    for (const auto& [vertex, links] : links_of(c, group)) {
      const Chain chain = chain_from(vertex, links, c.target.space);
      const auto mark = std::find(c.cut.marks.begin(), c.cut.marks.end(), vertex) - c.cut.marks.begin();
      if (mark == static_cast<long>(c.target.marks.size())) {
        if (links.size() == 1) continue;  // two copies
        EXPECT_EQ(chain.last, vertex);
        EXPECT_LT(largest(Exact(chain.product - Exact::Identity())), last_digits);
        continue;
      }
      EXPECT_EQ(chain.last, vertex);
      const ExactPoint p = group.held_point(c.boundary.held_at(vertex));
      EXPECT_LT(largest(ExactPoint(chain.product * p - p)), last_digits)
          << vertex << " mark " << mark << " links " << links.size();
      const Precise trace = 1 + 2 * cos(precise_angle<Precise>(c.target.marks[mark]));
      const double off = static_cast<double>(Precise(abs(chain.product.trace() - trace)));
      const bool is_exact = c.target.space != Space::plane() || c.target.marks[mark].order() > 0;
      EXPECT_LT(off, is_exact ? last_digits : 1e-14) << vertex;  // flat angles have to add up
    }
  }
}

TEST(SeamGroup, MirrorsMeetWhereCutsEndOnThemAndInTheirCorners) {
  for (const GluedCase& c : all_cases()) {
    if (c.target.topology != Topology::disk) continue;
    SCOPED_TRACE(name_of_case(c));
    const PreciseGroup<Precise> group = c.group();
    const auto mirrors = mirrors_at_ends(c, group);
    const auto links = links_of(c, group);
    std::set<int> seen;
    for (const auto& [end, at_end] : mirrors) {
      const int vertex = c.cut.source_vertex[end];
      if (!seen.insert(vertex).second) continue;
      const auto of_vertex = links.find(vertex);
      const Chain chain =
          chain_from(end, of_vertex == links.end() ? std::vector<Link>() : of_vertex->second, c.target.space);
      ASSERT_TRUE(mirrors.contains(chain.last));
      const Exact first = at_end.front(), other = mirrors.at(chain.last).back(),
                  last = chain.product * other * precise_inverse(c.target.space, chain.product);
      const auto mark = std::find(c.cut.marks.begin(), c.cut.marks.end(), vertex) - c.cut.marks.begin();
      if (mark >= static_cast<long>(c.target.marks.size())) {
        EXPECT_LT(largest(Exact(first - last)), last_digits) << "a cut ends there";
        continue;
      }
      const double turn = static_cast<double>(Precise((first * last).trace()));
      EXPECT_NEAR(turn, 1 + 2 * std::cos(2 * c.target.marks[mark].angle), 1e-9);
      if (end >= c.boundary.vertex_count()) continue;  // a copy
      const ExactPoint p = group.held_point(c.boundary.held_at(vertex));
      EXPECT_LT(largest(ExactPoint(first * p - p)), last_digits);
    }
  }
}

TEST(SeamGroup, ProductsOfTwoKnownElementsAreFoundAndOthersRefused) {
  const GluedCase c(cone_target(Topology::sphere, std::vector<Mark>(5, cone(pi))), 0, 0);
  const PreciseGroup<Precise> group = c.group();
  const Space space = c.target.space;
  for (const Seam& a : c.boundary.seams) {
    for (const Seam& b : c.boundary.seams) {
      const Exact expected = group.element(a.transform) * group.element(b.transform);
      EXPECT_LT(largest(Exact(group.element(a.transform * b.transform) - expected)), last_digits);
    }
  }
  EXPECT_THROW(group.element(space.rotation(Vector3(0, 0, 1), 0.1)), ArgumentError);
  EXPECT_THROW(group.element(space.to_origin(space.lift(1e-4, 2e-4))), ArgumentError);
}

TEST(SeamGroup, ALoopThatTheSeamsLeaveIsRefused) {
  const GluedCase c(parse_orbifold("2222"), 0, 0);
  const auto position = [&](int v) -> ExactPoint {
    return c.boundary.held_at(c.cut.source_vertex[v]).cast<Precise>();
  };
  const std::vector<int> shorter(c.cut.boundary.begin(), c.cut.boundary.begin() + c.cut.boundary.size() / 2);
  EXPECT_THROW(group_of_boundary<Precise>(
                   c.target, {shorter, c.cut.source_vertex, c.boundary.seams, c.boundary.cones, position}),
               ArgumentError);
}

TEST(ClosingPosition, IsWhereTheOthersLeaveTheFirstMark) {
  for (const GluedCase& c : all_cases()) {
    if (c.target.topology != Topology::sphere) continue;
    SCOPED_TRACE(name_of_case(c));
    Points positions = held_points(c.boundary);
    const int first = c.cut.marks.front();
    const Vector3 closing = closing_position(c.target, c.cut, positions);
    EXPECT_LT((closing - Vector3(positions.row(first))).norm(), 1e-8);
    positions.row(first) = closing;
    const BoundaryConditions boundary = c.boundary_of(tile_through(c.target, c.cut, positions));
    for (const Seam& seam : boundary.seams) {
      const Vector3 left =
          boundary.transform(seam.left.front()) * boundary.held_at(c.cut.source_vertex[seam.left.front()]);
      const Vector3 right =
          boundary.transform(seam.right.front()) * boundary.held_at(c.cut.source_vertex[seam.right.front()]);
      if (c.cut.source_vertex[seam.left.front()] != first) continue;
      const double size = seam.transform.matrix().cwiseAbs().maxCoeff() * right.cwiseAbs().maxCoeff();
      EXPECT_LT((left - seam.transform * right).cwiseAbs().maxCoeff(), 1e-14 * size);
    }
  }
}

}  // namespace
}  // namespace orbitutte::seam_group_test
