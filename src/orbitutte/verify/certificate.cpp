// SPDX-License-Identifier: MIT
// Why this is a proof: seams with orthogonal transforms glue |G| copies of the cut disk to a closed surface
// with a map to the sphere, and lay them on opposite sides of every seam. Positive triangles with edges
// shorter than pi make the map a local homeomorphism away from the vertices, and by the area, |G| times
// 4 pi/|G|, it covers the sphere once, so it is one at the vertices too. Seams that match leave the angles
// around a vertex a multiple of what they have to be: the checks of angles only have to tell multiples apart,
// and may follow the rounding of short edges. Positions are exact sums of doubles, offsets included; lengths,
// angles and areas are those of their differences. A closed sphere without seams is a copy by itself. A
// polygon stands for the triangles between its edges and its middle; that it is convex is checked besides.
// Where the boundary is held on a convex polygon instead, positive triangles cover every point as often as
// the boundary goes around it: once inside the polygon, and not at all outside.
#include "orbitutte/verify/certificate.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <numbers>
#include <optional>
#include <span>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/parallel.h"
#include "orbitutte/verify/angle_sums.h"
#include "orbitutte/verify/convexity.h"
#include "orbitutte/verify/held_sides.h"
#include "orbitutte/verify/laid_out.h"
#include "orbitutte/verify/seam_residuals.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

constexpr double unit_bound = 1e-12, angle_bound = 1e-8, area_bound = 1e-9, straight_bound = 1e-8,
                 off_space_bound = 1e-2;

Check at_most(std::string name, double value, double bound) {
  Check check = {std::move(name), value <= bound, value, bound, {}};
  if (!check.passed) check.detail = fmt::format("{:.3g} is more than {:.3g}", value, bound);
  return check;
}

// A check that counts offences and names the first.
Check none(std::string name, long long offences, std::string first) {
  return {std::move(name), offences == 0, static_cast<double>(offences), 0,
          offences ? std::move(first) : std::string()};
}

class Offences {
 public:
  template <typename... Arguments>
  void add(fmt::format_string<Arguments...> text, Arguments&&... arguments) {
    if (count_++ == 0) first_ = fmt::format(text, std::forward<Arguments>(arguments)...);
  }
  bool any() const { return count_ > 0; }
  Check check(std::string name) const { return none(std::move(name), count_, first_); }

 private:
  long long count_ = 0;
  std::string first_;
};

// The target that the signature names, read again.
Target claimed_target(const Embedding& embedding) {
  return read_target(embedding.target.signature, embedding.cones, embedding.positions);
}

// Does the signature speak of a surface without an orientation?
bool has_no_orientation(const std::string& signature) {
  try {
    return parse_orbifold(signature).topology == Topology::projective_plane;
  } catch (const ArgumentError&) {
    return false;  // of which cone_check tells
  }
}

// Is a face of the cut mesh the input's? Where the surface has no orientation, it may be turned over, its
// first corner still the first.
bool is_input_face(std::span<const int> input, std::span<const int> cut, const std::vector<int>& source,
                   bool may_be_turned) {
  const int n_cut = static_cast<int>(source.size());
  const auto is_copy = [&](int v, int vertex) { return v >= 0 && v < n_cut && source[v] == vertex; };
  if (std::equal(cut.begin(), cut.end(), input.begin(), input.end(), is_copy)) return true;
  return may_be_turned && cut.size() == input.size() && is_copy(cut[0], input[0]) &&
         std::equal(cut.rbegin(), cut.rend() - 1, input.begin() + 1, is_copy);
}

// The faces of the cut mesh are the input's, on copies of its vertices, the first n of which are the input
// vertices.
Check cut_mesh_check(int n, const FaceView& input, const Embedding& embedding) {
  Offences offences;
  const FaceView faces = embedding.faces();
  const int n_cut = static_cast<int>(embedding.source_vertex.size());
  if (embedding.positions.rows() != n_cut || n_cut < n)
    offences.add("{} positions, {} source vertices and {} input vertices do not fit together",
                 embedding.positions.rows(), n_cut, n);
  if (faces.count() != input.count())
    offences.add("the cut mesh has {} faces, the input {}", faces.count(), input.count());
  if (offences.any()) return offences.check("cut_mesh");
  for (int v = 0; v < n_cut; ++v) {
    const int source = embedding.source_vertex[v];
    if (source < 0 || source >= n || (v < n && source != v))
      offences.add("cut vertex {} names the input vertex {}", v, source);
  }
  const bool may_be_turned = has_no_orientation(embedding.target.signature);
  const std::vector<int> others = parallel_select(input.count(), [&](int f) {
    return !is_input_face(input[f], faces[f], embedding.source_vertex, may_be_turned);
  });
  for (const int f : others) offences.add("face {} is not the input's face {}, cut", f, f);
  return offences.check("cut_mesh");
}

// Offsets name cut vertices and are finite.
Check offsets_check(const Embedding& embedding) {
  Offences offences;
  for (const Offset& offset : embedding.offsets)
    if (offset.vertex < 0 || offset.vertex >= embedding.positions.rows() || !offset.d.allFinite())
      offences.add("an offset of vertex {} is not finite, or the cut mesh has no such vertex", offset.vertex);
  return offences.check("offsets");
}

// By how much more than on the sphere doubles round what is quadratic in coordinates as large as this one: in
// the hyperbolic plane they grow with the exponential of the distance from (0, 0, 1).
double rounding_scale(double height) { return std::max(1.0, height * height); }

// In the target's space.
Check surface_check(const Embedding& embedding) {
  const std::string name = "unit_positions";
  const Points& X = embedding.positions;
  if (!X.allFinite()) return none(name, 1, "a position is not finite");
  const Space space = embedding.space();
  const auto largest = [&](const auto& of_vertex) {
    return parallel_max(static_cast<int>(X.rows()), of_vertex);
  };
  // Copies are products of numbers as large as the largest.
  const double scale = rounding_scale(largest([&](int v) { return std::abs(X(v, 2)); }));
  const double defect = largest([&](int v) { return space.defect(X.row(v)); }) / scale;
  return at_most(name, std::isfinite(defect) ? defect : std::numeric_limits<double>::infinity(), unit_bound);
}

// Of every cut vertex, does a face use it?
std::vector<char> used_vertices(const Triangles& F, int n_cut) {
  std::vector<char> used(n_cut, 0);
  parallel_parts(n_cut, [&](int begin, int end) {
    for (const int v : std::span(F.data(), static_cast<std::size_t>(F.size())))
      if (v >= begin && v < end) used[v] = 1;
  });
  return used;
}

// The edges of the cut mesh, and what is not inside.
struct CutEdges {
  long long count = 0;

  // The half-edges that are not opposite to exactly one other in the other direction, ascending.
  std::vector<int> not_inside;

  // Of every half-edge of the cut mesh; empty if those that are not inside have no opposite one.
  std::vector<int> opposite = {};

  int opposite_of(int h) const { return opposite.empty() ? -1 : opposite[h]; }
};

// From the cut mesh alone.
CutEdges found_edges(const Embedding& triangles) {
  const Triangles& F = triangles.triangles;
  Connectivity found = connectivity_of(F, static_cast<int>(triangles.source_vertex.size()));
  const std::vector<int>& opposite = found.opposite;
  // Of more than two half-edges of an edge, one is not the opposite one of its own opposite one.
  std::vector<int> not_inside = parallel_select(static_cast<int>(F.size()), [&](int h) {
    const int other = opposite[h];
    return other < 0 || opposite[other] != h || halfedge_origin(F, other) == halfedge_origin(F, h);
  });
  return {static_cast<long long>(found.edges.size()), std::move(not_inside), std::move(found.opposite)};
}

// The same from the connectivity of an orientable surface whose triangles are those of the cut mesh. Each of
// its edges has one half-edge, or two in opposite directions, and half-edges of one edge of the cut mesh are
// of one edge of the surface.
CutEdges edges_left_by_the_cut(const Triangles& F, const Connectivity& input) {
  std::vector<int> not_inside = parallel_select(static_cast<int>(F.size()), [&](int h) {
    const int other = input.opposite[h];
    return other < 0 || halfedge_origin(F, h) != halfedge_target(F, other) ||
           halfedge_target(F, h) != halfedge_origin(F, other);
  });
  return {static_cast<long long>(F.size() + not_inside.size()) / 2, std::move(not_inside)};
}

// The boundary half-edges of the cut mesh, each by its origin; empty, with an offence, unless the cut mesh is
// a disk or a sphere: every edge has one face, or two that run along it in opposite directions, there is one
// simple boundary loop and V - E + F = 1, or there is none and V - E + F = 2. input: the connectivity of the
// surface, if edges_left_by_the_cut may take it.
std::unordered_map<int, int> boundary_of_cut_mesh(const Embedding& embedding, const Connectivity* input,
                                                  Offences& offences) {
  const Triangles& F = embedding.triangles;
  const CutEdges edges = input ? edges_left_by_the_cut(F, *input) : found_edges(embedding);
  std::unordered_map<int, int> next;
  for (const int h : edges.not_inside) {
    const int other = edges.opposite_of(h);
    if (other >= 0 && edges.opposite_of(other) != h)
      offences.add("edge ({}, {}) of the cut mesh has more than two faces", halfedge_origin(F, h),
                   halfedge_target(F, h));
    if (other >= 0 && halfedge_origin(F, other) == halfedge_origin(F, h))
      offences.add("two faces run along edge ({}, {}) of the cut mesh in the same direction",
                   halfedge_origin(F, h), halfedge_target(F, h));
    if (other < 0 && !next.emplace(halfedge_origin(F, h), halfedge_target(F, h)).second)
      offences.add("the boundary of the cut mesh passes twice through vertex {}", halfedge_origin(F, h));
  }
  const std::vector<char> used = used_vertices(F, static_cast<int>(embedding.source_vertex.size()));
  const long long euler = std::count(used.begin(), used.end(), 1) - edges.count + F.rows();
  if (euler != (next.empty() ? 2 : 1))
    offences.add("the cut mesh has Euler characteristic {}; a disk has 1, and a closed sphere 2", euler);
  if (offences.any() || next.empty()) return {};
  std::size_t steps = 0;
  const int start = next.begin()->first;
  for (int v = start; steps == 0 || (v != start && steps <= next.size()); ++steps) {
    const auto at = next.find(v);
    if (at == next.end()) break;
    v = at->second;
  }
  if (steps != next.size()) offences.add("the boundary of the cut mesh is not one loop");
  return next;
}

// 1 where (a, b) is a boundary edge that no bank has covered yet, -1 where (b, a) is, 0 where neither is;
// then covers it.
int cover(std::unordered_map<int, int>& uncovered, int a, int b) {
  for (const auto& [from, to, direction] : {std::tuple(a, b, 1), std::tuple(b, a, -1)}) {
    const auto at = uncovered.find(from);
    if (at == uncovered.end() || at->second != to) continue;
    uncovered.erase(at);
    return direction;
  }
  return 0;
}

// Covers both banks' edges. A rotation lays copies of the tile on both sides of an edge where the banks run
// along the boundary in opposite directions, a reflection where they run in the same (a mirror's always do);
// otherwise the map folds there.
void cover_banks(const Seam& seam, std::size_t s, std::unordered_map<int, int>& uncovered,
                 Offences& offences) {
  const bool mirror = seam.is_mirror(), reverses = seam.transform.reverses_orientation();
  for (std::size_t k = 1; k < seam.left.size(); ++k) {
    const int left = cover(uncovered, seam.left[k - 1], seam.left[k]);
    const int right = mirror ? left : cover(uncovered, seam.right[k - 1], seam.right[k]);
    if (left == 0 || right == 0) {
      const std::vector<int>& bank = left == 0 ? seam.left : seam.right;
      offences.add("({}, {}) of seam {} is no boundary edge of the cut mesh, or lies in two banks",
                   bank[k - 1], bank[k], s);
    } else if ((left == right) != reverses) {
      offences.add("seam {} folds the map along ({}, {}): its transform lays both faces on the same side", s,
                   seam.left[k - 1], seam.left[k]);
    }
  }
}

// The cut vertices of the fixed cones, the corners of a polygon.
std::vector<int> fixed_corners(const Embedding& embedding) {
  std::vector<int> corners;
  for (const ConeCopies& cone : embedding.cones)
    if (cone.mark.kind == ConeKind::fixed)
      corners.insert(corners.end(), cone.copies.begin(), cone.copies.end());
  return corners;
}

// Every boundary edge of the cut mesh lies in exactly one bank, or between fixed corners; paired vertices are
// copies of one input vertex, and paired edges have their faces on opposite sides.
Check seam_gluing_check(const Embedding& embedding, const Connectivity* input) {
  Offences offences;
  const int n_cut = static_cast<int>(embedding.source_vertex.size());
  std::unordered_map<int, int> uncovered = boundary_of_cut_mesh(embedding, input, offences);
  for (std::size_t s = 0; s < embedding.seams.size() && !offences.any(); ++s) {
    const Seam& seam = embedding.seams[s];
    if (seam.left.size() != seam.right.size() || seam.left.size() < 2) {
      offences.add("the banks of seam {} do not pair", s);
      continue;
    }
    for (std::size_t k = 0; k < seam.left.size(); ++k) {
      const int l = seam.left[k], r = seam.right[k];
      if (l < 0 || r < 0 || l >= n_cut || r >= n_cut ||
          embedding.source_vertex[l] != embedding.source_vertex[r])
        offences.add("seam {} pairs the cut vertices {} and {}, which are no copies of one input vertex", s,
                     l, r);
    }
    if (offences.any()) continue;
    cover_banks(seam, s, uncovered, offences);
  }
  if (!uncovered.empty() && fixed_corners(embedding).empty()) {
    const auto first = *std::min_element(uncovered.begin(), uncovered.end());
    offences.add("the boundary edge ({}, {}) of the cut mesh lies in no seam", first.first, first.second);
  }
  return offences.check("seam_gluing");
}

// The boundary runs once around the polygon of the fixed corners, where there are any.
Check held_sides_check(const Embedding& embedding, const Connectivity* input) {
  const std::string name = "held_sides";
  const std::vector<int> corners = fixed_corners(embedding);
  if (corners.empty()) return none(name, 0, {});
  Offences offences;
  const std::unordered_map<int, int> next = boundary_of_cut_mesh(embedding, input, offences);
  if (next.empty()) return none(name, 1, "the cut mesh is no disk");
  const int start = next.begin()->first;
  std::vector<int> boundary = {start};
  while (next.at(boundary.back()) != start) boundary.push_back(next.at(boundary.back()));
  const std::vector<std::string> departures =
      departures_from_sides(embedding.positions, std::move(boundary), corners);
  return none(name, static_cast<long long>(departures.size()), departures.empty() ? "" : departures.front());
}

// Isometries whose determinant is that of their kind.
Check transform_check(const Embedding& embedding) {
  Offences offences;
  const std::vector<Seam>& seams = embedding.seams;
  for (std::size_t s = 0; s < seams.size(); ++s) {
    const Matrix3& M = seams[s].transform.matrix();
    if (!(embedding.space().isometry_defect(M) < unit_bound * rounding_scale(M(2, 2)))) {
      offences.add("the transform of seam {} is no isometry of the {} space", s, embedding.space().name());
    } else if (seams[s].is_mirror() && (M.determinant() > 0 || std::abs(M.trace() - 1) > unit_bound)) {
      offences.add("seam {} is glued to itself by what is no reflection", s);
    }
  }
  return offences.check("seam_transforms");
}

// Positions with offsets lie in the target's space at the scale of the edges beside them: by how much more or
// less than 1 is k (x^2 + y^2) + z^2, in shares of the shortest edge there.
Check exact_surface_check(const Embedding& triangles, const ExactPositions& positions) {
  const int count = static_cast<int>(triangles.source_vertex.size());
  std::vector<char> has_offsets(count);
  for (int v = 0; v < count; ++v) has_offsets[v] = positions.has_offsets(v);
  const std::vector<double> shortest = shortest_edges(triangles, positions, has_offsets);
  double worst = 0;
  for (int v = 0; v < count; ++v) {
    if (!has_offsets[v]) continue;
    const Vector3Of<MostPrecise> p = positions.exact(v);
    const MostPrecise off = triangles.space().form(p, p) - 1;
    const double share = std::abs(static_cast<double>(off)) / shortest[v];
    if (share > 0) worst = std::max(worst, share);
  }
  return at_most("exact_positions", worst, off_space_bound);
}

// The banks match; see judge_seams.
Check seam_check(const SeamResiduals& residuals) {
  return {"seam_residual", residuals.failure.empty(), residuals.value, residuals.bound, residuals.failure};
}

// The copies of the cones' input vertices among the cut vertices, ascending.
std::unordered_map<int, std::vector<int>> copies_of_cones(const Embedding& embedding) {
  const int n_cut = static_cast<int>(embedding.source_vertex.size());
  std::unordered_map<int, std::vector<int>> copies;
  std::vector<char> is_cone(n_cut, 0);  // by input vertex
  for (const ConeCopies& cone : embedding.cones) {
    copies[cone.vertex];
    if (cone.vertex >= 0 && cone.vertex < n_cut) is_cone[cone.vertex] = 1;
  }
  for (int v = 0; v < n_cut; ++v)
    if (const int source = embedding.source_vertex[v]; is_cone[source]) copies[source].push_back(v);
  return copies;
}

// The marks are those of the signature, in its order, and name all copies of their vertices.
Check cone_check(const Embedding& embedding) {
  Offences offences;
  try {
    const Target target = claimed_target(embedding);
    if (target.marks.size() != embedding.cones.size())
      offences.add("{} marks {} vertices, not {}", target.signature, target.marks.size(),
                   embedding.cones.size());
    for (std::size_t k = 0; !offences.any() && k < target.marks.size(); ++k) {
      const ConeCopies& cone = embedding.cones[k];
      const Mark& mark = target.marks[k];
      if (cone.mark.order() != mark.order() || cone.mark.kind != mark.kind)
        offences.add("vertex {} is a {} of order {}, which {} does not ask for there", cone.vertex,
                     name_of(cone.mark.kind), cone.mark.order(), target.signature);
    }
  } catch (const Error& error) {
    offences.add("{}", error.what());
  }
  const std::unordered_map<int, std::vector<int>> copies_of = copies_of_cones(embedding);
  for (const ConeCopies& cone : embedding.cones) {
    const std::vector<int>& copies = copies_of.at(cone.vertex);
    std::vector<int> named = cone.copies;
    std::sort(named.begin(), named.end());
    if (copies.empty() || copies != named)
      offences.add("the copies named for the cone {} are not all there are", cone.vertex);
  }
  return offences.check("cones");
}

// What the angles around the vertices of the surface have to add up to.
struct ExpectedAngles {
  // By surface_vertex: 2 pi, or pi on a mirror; at cones and corners what their marks say; 0 where nothing is
  // asked: where no face is, at fixed corners and along held sides.
  std::vector<double> angle;
  std::vector<char> is_cone;

  // A quarter of the least of all: sums that are further off may belong to another multiple.
  double largest_error = pi / 4;
};

// triangles: the embedding, its polygons divided, with its seams.
ExpectedAngles expected_angles(const Embedding& triangles) {
  ExpectedAngles expected;
  const std::size_t count = triangles.source_vertex.size();
  expected.angle.assign(count, 0.0);
  expected.is_cone.assign(count, 0);
  const std::vector<char> used = used_vertices(triangles.triangles, static_cast<int>(count));
  for (int v = 0; v < static_cast<int>(count); ++v)
    if (used[v]) expected.angle[surface_vertex(triangles, v)] = 2 * pi;
  for (const Seam& seam : triangles.seams)
    if (seam.is_mirror())
      for (const int v : seam.left) expected.angle[surface_vertex(triangles, v)] = pi;
  if (!fixed_corners(triangles).empty()) {
    Offences ignored;  // held_sides_check tells of them
    for (const auto& [from, to] : boundary_of_cut_mesh(triangles, nullptr, ignored))
      expected.angle[surface_vertex(triangles, from)] = 0;
  }
  for (const ConeCopies& cone : triangles.cones) {
    const bool is_fixed = cone.mark.kind == ConeKind::fixed;
    expected.is_cone[cone.vertex] = 1;
    expected.angle[cone.vertex] = is_fixed ? 0 : cone.mark.angle;
    if (!is_fixed) expected.largest_error = std::min(expected.largest_error, cone.mark.angle / 4);
  }
  return expected;
}

// The largest difference between a sum of angles and what it has to be, relative to what rounding explains:
// at cones and corners, or at all other vertices.
class AngleCheck {
 public:
  explicit AngleCheck(std::string name) : name_(std::move(name)) {}

  void add(int vertex, double difference, double bound) {
    if (!(difference <= bound) && failures_++ == 0) vertex_ = vertex;
    const double ratio =
        std::isnan(difference) ? std::numeric_limits<double>::infinity() : difference / bound;
    if (!(ratio > worst_)) return;
    worst_ = ratio;
    value_ = difference;
    bound_ = bound;
  }

  Check check() const {
    Check check = {name_, failures_ == 0, value_, bound_, {}};
    if (!check.passed)
      check.detail = fmt::format(
          "the angles around {} vertices are wrong, first around vertex {}; the "
          "largest difference is {:.3g}, more than {:.3g}",
          failures_, vertex_, value_, bound_);
    return check;
  }

 private:
  std::string name_;
  int failures_ = 0, vertex_ = -1;
  double worst_ = -1, value_ = 0, bound_ = angle_bound;
};

// triangles, positions: those of which the sums are. Where a sum is off by more than angle_bound, the
// rounding of the positions may explain it.
std::vector<Check> angle_checks(const Embedding& triangles, const ExactPositions& positions,
                                const std::vector<double>& sums, const ExpectedAngles& expected) {
  const int count = static_cast<int>(std::min(sums.size(), expected.angle.size()));
  const auto difference = [&](int v) { return std::abs(sums[v] - expected.angle[v]); };
  const auto is_asked = [&](int v) {
    return expected.is_cone[v] ? expected.angle[v] != 0 : expected.angle[v] > 0;
  };
  std::vector<char> is_off(sums.size(), 0);
  bool any_off = false;
  for (int v = 0; v < count; ++v)
    if (is_asked(v) && !(difference(v) <= angle_bound)) is_off[v] = any_off = true;
  std::vector<double> rounding;
  if (any_off) rounding = rounding_of_angles(triangles, positions, is_off);
  AngleCheck cones("cone_angles"), others("angle_sums");
  for (int v = 0; v < count; ++v) {
    if (!is_asked(v)) continue;
    const double bound =
        is_off[v] ? std::min(angle_bound + rounding[v], expected.largest_error) : angle_bound;
    (expected.is_cone[v] ? cones : others).add(v, difference(v), bound);
  }
  return {cones.check(), others.check()};
}

// The seams generate the group of the signature. In the plane it is infinite, and nothing is to be counted.
Check group_check(const Embedding& embedding) {
  const std::string name = "group_order";
  const int order = embedding.target.group_order;
  try {
    const int of_signature = claimed_target(embedding).group_order;
    if (of_signature != order)
      return {
          name, false, static_cast<double>(order), static_cast<double>(of_signature),
          fmt::format("{} has a group of order {}, not {}", embedding.target.signature, of_signature, order)};
    if (order == 0) return {name, true, 0, 0, {}};
    std::vector<Isometry> generators;
    for (const Seam& seam : embedding.seams) generators.push_back(seam.transform);
    const int generated = SymmetryGroup(embedding.space(), generators, order).order();
    const std::string detail =
        generated == order ? std::string() : fmt::format("the seams generate a group of order {}", generated);
    return {name, detail.empty(), static_cast<double>(generated), static_cast<double>(order), detail};
  } catch (const ArgumentError& error) {
    return {name, false, 0, static_cast<double>(order), error.what()};
  }
}

// face_of: the input face of every triangle, where it is not the triangle itself.
Check orientation_check(const std::vector<char>& positive, const std::vector<int>& face_of,
                        std::vector<int>& nonpositive) {
  for (int f = 0; f < static_cast<int>(positive.size()); ++f)
    if (!positive[f]) nonpositive.push_back(face_of.empty() ? f : face_of[f]);
  nonpositive.erase(std::unique(nonpositive.begin(), nonpositive.end()), nonpositive.end());
  const std::string first = nonpositive.empty()
                                ? std::string()
                                : fmt::format("face {} is not positively oriented", nonpositive.front());
  return none("positive_faces", static_cast<long long>(nonpositive.size()), first);
}

// Puts polygons that are not convex among the faces that are not positively oriented.
Check convexity_check(const Embedding& embedding, const ExactPositions& positions,
                      std::vector<int>& nonpositive) {
  const std::vector<ConcaveCorner> concave = concave_corners(embedding, positions, straight_bound);
  for (const ConcaveCorner& corner : concave) nonpositive.push_back(corner.face);
  std::sort(nonpositive.begin(), nonpositive.end());
  nonpositive.erase(std::unique(nonpositive.begin(), nonpositive.end()), nonpositive.end());
  const std::string first = concave.empty() ? std::string()
                                            : fmt::format("face {} is not convex at vertex {}",
                                                          concave.front().face, concave.front().vertex);
  return none("convex_faces", static_cast<long long>(concave.size()), first);
}

// The edge with the widest chord. Of several, the longest by rounding.
struct WidestEdge {
  double squared_chord = 0, length = 0;

  void take(const WidestEdge& other) {
    if (other.squared_chord < squared_chord) return;
    length = other.squared_chord > squared_chord ? other.length : std::max(length, other.length);
    squared_chord = other.squared_chord;
  }
};

// Of the faces begin .. end - 1.
WidestEdge widest_edge(const Embedding& embedding, int begin, int end) {
  const Points& X = embedding.positions;
  const FaceView faces = embedding.faces();
  const Space space = embedding.space();
  WidestEdge widest;
  for (int f = begin; f < end; ++f) {
    int a = faces[f].back();
    for (const int b : faces[f]) {
      const Vector3 from = X.row(std::exchange(a, b)), to = X.row(b), chord = from - to;
      if (const double squared = space.dot(chord, chord); squared >= widest.squared_chord)
        widest.take({squared, space.distance(from, to)});
    }
  }
  return widest;
}

Check edge_length_check(const Embedding& embedding, double& longest) {
  WidestEdge widest;
  std::mutex mutex;
  parallel_ranges(embedding.faces().count(), [&](int begin, int end) {
    const WidestEdge here = widest_edge(embedding, begin, end);
    const std::lock_guard lock(mutex);
    widest.take(here);
  });
  longest = widest.length;
  const double bound = embedding.space().longest_unique();
  Check check = {"edge_lengths", longest < bound, longest, bound, {}};
  if (!check.passed) check.detail = "an edge is not shorter than pi";
  return check;
}

Check area_check(const Certificate& certificate) {
  Check check =
      at_most("signed_area", std::abs(certificate.signed_area - certificate.expected_area), area_bound);
  if (!check.passed)
    check.detail =
        fmt::format("the area is {:.12g}, not {:.12g}", certificate.signed_area, certificate.expected_area);
  return check;
}

bool all_passed(const std::vector<Check>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const Check& check) { return check.passed; });
}

// That the cut mesh is the input's; false where nothing else can be computed safely.
bool check_input(int vertex_count, const FaceView& faces, const Embedding& embedding,
                 Certificate& certificate) {
  certificate.expected_area = 4 * pi / std::max(embedding.target.group_order, 1);
  certificate.checks.push_back(cut_mesh_check(vertex_count, faces, embedding));
  certificate.checks.push_back(surface_check(embedding));
  if (!embedding.offsets.empty()) certificate.checks.push_back(offsets_check(embedding));
  return all_passed(certificate.checks);
}

// What is judged: the embedding, and the triangles that its faces are made of.
struct Judged {
  const Embedding& embedding;

  // The embedding, its polygons divided; of another triangulation, that one's images.
  const Embedding& triangles;

  // Of the triangles.
  const ExactPositions& positions;
};

// That seams or held sides glue the cut mesh to a surface; false as before.
bool check_gluing(const Judged& judged, const Connectivity* input, Certificate& certificate) {
  const Embedding& embedding = judged.embedding;
  std::vector<Check>& checks = certificate.checks;
  checks.push_back(seam_gluing_check(judged.triangles, input));
  checks.push_back(transform_check(embedding));
  checks.push_back(cone_check(embedding));
  if (!all_passed(checks)) return false;
  certificate.expected_area = target_area(claimed_target(embedding));
  checks.push_back(held_sides_check(embedding, input));
  checks.push_back(group_check(embedding));
  if (judged.positions.has_offsets())
    checks.push_back(exact_surface_check(judged.triangles, judged.positions));
  const SeamResiduals residuals = judge_seams(judged.triangles, judged.positions);
  certificate.max_seam_residual = residuals.largest;
  checks.push_back(seam_check(residuals));
  return true;
}

// That the images of the surface's faces cover the tile once. face_of: the face that each triangle is part
// of, or empty.
void check_faces(const Judged& judged, const ExpectedAngles& expected, const std::vector<int>& face_of,
                 Certificate& certificate) {
  const auto& [embedding, triangles, positions] = judged;
  std::vector<Check>& checks = certificate.checks;
  const TriangleSums sums = sum_over_triangles(triangles, positions);
  checks.push_back(orientation_check(sums.positive, face_of, certificate.nonpositive_faces));
  const Check lengths = edge_length_check(embedding, certificate.max_edge_length);
  if (std::isfinite(lengths.bound)) checks.push_back(lengths);
  for (Check& check : angle_checks(triangles, positions, sums.angle, expected))
    checks.push_back(std::move(check));
  certificate.signed_area = sums.signed_area;
  checks.push_back(area_check(certificate));
  certificate.bijective = all_passed(checks);
}

// Flips of the mesh's edges lead to the triangulation's faces, whose corners are unit vectors.
bool check_layout(const Embedding& layout, const IntrinsicTriangulation& triangulation,
                  Certificate& certificate) {
  Offences offences;
  for (int h = 0; h < static_cast<int>(triangulation.F.size()); ++h)
    if (layout.source_vertex[h] != halfedge_origin(triangulation.F, h))
      offences.add("flips do not lead to face {} of the triangulation", h / 3);
  certificate.checks.push_back(offences.check("flips"));
  Check unit = surface_check(layout);
  unit.name = "unit_corners";
  certificate.checks.push_back(unit);
  return all_passed(certificate.checks);
}

// input: see boundary_of_cut_mesh.
Certificate certify_on(const Connectivity* input, int vertex_count, const FaceView& faces,
                       const Embedding& embedding) {
  Certificate certificate;
  if (!check_input(vertex_count, faces, embedding, certificate)) return certificate;
  std::optional<DividedPolygons> polygons;
  if (embedding.polygons.count() > 0) polygons = divide_from_middles(embedding);
  const Embedding& triangles = polygons ? polygons->embedding : embedding;
  const ExactPositions positions(triangles);
  const Judged judged = {embedding, triangles, positions};
  if (!check_gluing(judged, polygons ? nullptr : input, certificate)) return certificate;
  check_faces(judged, expected_angles(triangles), polygons ? polygons->face_of : std::vector<int>(),
              certificate);
  if (polygons)
    certificate.checks.push_back(convexity_check(embedding, positions, certificate.nonpositive_faces));
  certificate.bijective = all_passed(certificate.checks);
  return certificate;
}

}  // namespace

Certificate certify(int vertex_count, const FaceView& faces, const Embedding& embedding) {
  return certify_on(nullptr, vertex_count, faces, embedding);
}

Certificate certify(const Surface& surface, const Embedding& embedding) {
  const bool is_orientable = surface.topology == Topology::sphere || surface.topology == Topology::disk;
  return certify_on(is_orientable && !surface.has_polygons() ? &surface.connectivity : nullptr,
                    surface.vertex_count(), surface.faces(), embedding);
}

Certificate certify_intrinsic(const Surface& surface, const Embedding& embedding,
                              const IntrinsicTriangulation& triangulation) {
  Certificate certificate;
  if (!check_input(surface.vertex_count(), surface.faces(), embedding, certificate)) return certificate;
  const ExactPositions positions(embedding);
  if (!check_gluing({embedding, embedding, positions}, nullptr, certificate)) return certificate;
  if (positions.has_offsets() && !all_passed(certificate.checks)) return certificate;  // no exact group
  const Embedding layout = laid_out(surface, embedding, triangulation);
  if (!check_layout(layout, triangulation, certificate)) return certificate;
  const ExactPositions laid_out_positions(layout);
  check_faces({layout, layout, laid_out_positions}, expected_angles(embedding), {}, certificate);
  return certificate;
}

}  // namespace orbitutte
