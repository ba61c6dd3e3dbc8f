// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/mesh_repair.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <span>
#include <utility>

#include "orbitutte/inspect/inspection_steps.h"
#include "orbitutte/mesh/disjoint_sets.h"
#include "orbitutte/mesh/point_numbers.h"

namespace orbitutte {
namespace {

using Polygon = std::vector<int>;
using Edge = std::pair<int, int>;
using inspection::InspectedMesh;

constexpr std::size_t largest_triangulated_hole = 200;
constexpr double flat = 1e-12;  // of a face's longest edge, squared, its doubled area

Edge undirected(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// Faces, one after the other.
struct FaceList {
  std::vector<int> corners;
  std::vector<int> start = {0};

  int count() const { return static_cast<int>(start.size()) - 1; }

  template <class Corners>
  void append(const Corners& face) {
    corners.insert(corners.end(), face.begin(), face.end());
    start.push_back(static_cast<int>(corners.size()));
  }

  void append_all(const FaceList& faces) {
    for (int f = 0; f < faces.count(); ++f)
      append(std::span(faces.corners).subspan(faces.start[f], faces.start[f + 1] - faces.start[f]));
  }
};

// The next vertex around a face.
template <class Corners>
int vertex_after(const Corners& face, std::size_t k) {
  return face[(k + 1) % face.size()];
}

// The corners but the first, in the other direction.
void turn_over(std::span<int> face) { std::reverse(face.begin() + 1, face.end()); }

bool names_a_vertex_twice(std::span<const int> face) {
  constexpr std::size_t small = 8;
  if (face.size() > small) return std::set<int>(face.begin(), face.end()).size() < face.size();
  for (auto corner = face.begin(); corner != face.end(); ++corner)
    if (std::find(face.begin(), corner, *corner) != corner) return true;
  return false;
}

// Points by cells as wide as a tolerance; without one, every point is a cell.
class Neighbourhoods {
 public:
  Neighbourhoods(const Points& V, double tolerance)
      : V_(V), tolerance_(tolerance), before_(static_cast<std::size_t>(V.rows()), -1) {}

  // Calls meet(u) for each point in the cells around that of v, and puts v into its own.
  template <class Meet>
  void add(int v, const Meet& meet) {
    const PointNumbers::Point cell = cell_of(v);
    const int reach = tolerance_ > 0 ? 1 : 0;
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y)
        for (int z = -reach; z <= reach; ++z) {
          const std::optional<int> there = cells_.find({cell[0] + x, cell[1] + y, cell[2] + z});
          for (int u = there ? last_[*there] : -1; u >= 0; u = before_[u]) meet(u);
        }
    const int number = cells_.number_of(cell);
    if (number == static_cast<int>(last_.size())) last_.push_back(-1);
    before_[v] = std::exchange(last_[number], v);
  }

 private:
  PointNumbers::Point cell_of(int v) const {
    PointNumbers::Point cell = {V_(v, 0), V_(v, 1), V_(v, 2)};
    if (tolerance_ > 0)
      for (double& x : cell) x = std::floor(x / tolerance_);
    return cell;
  }

  const Points& V_;
  double tolerance_;
  PointNumbers cells_;

  // The last point in each cell, and the one before each point in its cell; -1 where there is none.
  std::vector<int> last_, before_;
};

struct FaceComponents {
  // The faces of each, found across edges with two faces.
  std::vector<std::vector<int>> faces;

  // Must a face be turned, so that neighbours agree?
  std::vector<int> is_turned;
};

class MeshRepair {
 public:
  MeshRepair(const PolygonMesh& mesh, const MeshRepairOptions& options)
      : options_(options),
        colours_(mesh.colours),
        mesh_{mesh.V, mesh.corners, mesh.face_start},
        image_(static_cast<std::size_t>(mesh.vertex_count())) {
    std::iota(image_.begin(), image_.end(), 0);
    source_ = image_;
  }

  RepairedMesh run() {
    const std::pair<RepairStep, void (MeshRepair::*)()> steps[] = {
        {RepairStep::drop_bad_faces, &MeshRepair::drop_bad_faces},
        {RepairStep::weld, &MeshRepair::weld},
        {RepairStep::drop_duplicates, &MeshRepair::drop_duplicates},
        {RepairStep::drop_flat_faces, &MeshRepair::drop_flat_faces},
        {RepairStep::split_non_manifold, &MeshRepair::split_non_manifold},
        {RepairStep::orient, &MeshRepair::orient},
        {RepairStep::keep_largest, &MeshRepair::keep_largest},
        {RepairStep::fill_holes, &MeshRepair::fill_holes},
        {RepairStep::split_ears, &MeshRepair::split_ears}};
    for (const auto& [step, run_step] : steps) {
      if (std::count(options_.without.begin(), options_.without.end(), step) > 0) continue;
      step_ = step;
      (this->*run_step)();
      keep_new_vertices();
    }
    return result();
  }

 private:
  void record(long long count, const std::string& message) {
    if (count > 0) result_.records.push_back({step_, count, message});
  }

  Vector3 at(int v) const { return mesh_.V.row(v); }

  int vertex_count() const { return mesh_.vertex_count(); }

  int face_count() const { return mesh_.face_count(); }

  std::span<const int> face(int f) const {
    return std::span(mesh_.corners).subspan(mesh_.face_start[f], mesh_.face_degree(f));
  }

  bool is_vertex(int v) const { return inspection::in_range(mesh_, v); }

  bool is_good(int f) const {
    const std::span<const int> corners = face(f);
    const auto is_usable = [&](int v) { return is_vertex(v) && mesh_.V.row(v).allFinite(); };
    return corners.size() >= 3 && std::all_of(corners.begin(), corners.end(), is_usable) &&
           !names_a_vertex_twice(corners);
  }

  // The mesh with its edges; kept as long as the faces stay as they are.
  const InspectedMesh& inspected() {
    if (inspected_) return *inspected_;
    inspected_.emplace(mesh_);
    for (int f = 0; f < face_count(); ++f)
      if (!is_good(f)) inspected_->state[f] = inspection::FaceState::malformed;
    find_edges(*inspected_);
    return *inspected_;
  }

  void take_faces(FaceList faces) {
    inspected_.reset();
    components_.reset();
    mesh_.corners = std::move(faces.corners);
    mesh_.face_start = std::move(faces.start);
  }

  template <class IsKept>
  void keep_faces(const IsKept& is_kept) {
    FaceList kept;
    kept.corners.reserve(mesh_.corners.size());
    kept.start.reserve(mesh_.face_start.size());
    for (int f = 0; f < face_count(); ++f)
      if (is_kept(f)) kept.append(face(f));
    take_faces(std::move(kept));
  }

  // The faces for which `is_bad`; records "<count> faces <what>, the first face <f>".
  template <class IsBad>
  void drop_faces(const IsBad& is_bad, std::string_view what) {
    std::vector<char> is_dropped(face_count(), 0);
    int count = 0, first = -1;
    for (int f = 0; f < face_count(); ++f) {
      if (!is_bad(f)) continue;
      is_dropped[f] = 1;
      if (count++ == 0) first = f;
    }
    if (count > 0) keep_faces([&](int f) { return !is_dropped[f]; });
    record(count, count == 1
                      ? fmt::format("1 face {} was dropped: face {}", what, first)
                      : fmt::format("{} faces {} were dropped, the first was face {}", count, what, first));
  }

  void drop_bad_faces() {
    drop_faces([&](int f) { return !is_good(f); },
               "with missing vertices, positions that are not finite or a vertex named twice");
  }

  // Sets of vertices of faces, each within the tolerance of another of its set.
  DisjointSets vertices_together() const {
    std::vector<char> is_used(vertex_count(), 0);
    for (const int v : mesh_.corners)
      if (is_vertex(v)) is_used[v] = mesh_.V.row(v).allFinite();
    DisjointSets sets(vertex_count());
    Neighbourhoods known(mesh_.V, options_.weld_tolerance);
    for (int v = 0; v < vertex_count(); ++v) {
      if (!is_used[v]) continue;
      known.add(v, [&](int u) {
        if ((at(u) - at(v)).norm() <= options_.weld_tolerance) sets.unite(u, v);
      });
    }
    return sets;
  }

  void weld() {
    DisjointSets sets = vertices_together();
    int count = 0, first = -1;
    for (int v = 0; v < vertex_count(); ++v) {
      image_[v] = sets.find(v);
      if (image_[v] != v && count++ == 0) first = v;
    }
    record(count,
           fmt::format("{} {} welded to others at the same place, the first was vertex {} to {}", count,
                       count == 1 ? "vertex was" : "vertices were", first, first < 0 ? -1 : image_[first]));
    if (count == 0) return;
    FaceList welded;
    for (int f = 0; f < face_count(); ++f) welded.append(image_of(face(f)));
    take_faces(std::move(welded));
    drop_faces([&](int f) { return !is_good(f); }, "that fell together when vertices were welded");
  }

  // The face after welding; neighbours that are one vertex now are named once.
  Polygon image_of(std::span<const int> face) const {
    Polygon image;
    image.reserve(face.size());
    for (const int v : face) image.push_back(is_vertex(v) ? image_[v] : v);
    image.erase(std::unique(image.begin(), image.end()), image.end());
    while (image.size() > 1 && image.front() == image.back()) image.pop_back();
    return image;
  }

  void drop_duplicates() {
    const std::vector<int> first = first_doubles(inspected(), inspection::sorted_corners(mesh_));
    drop_faces([&](int f) { return first[f] >= 0 && first[f] != f; },
               "with the same vertices as an earlier one");
  }

  // Zero of a face that is not good.
  Vector3 vector_area(int f) const {
    Vector3 sum = Vector3::Zero();
    if (!is_good(f)) return sum;
    const std::span<const int> corners = face(f);
    for (std::size_t k = 1; k + 1 < corners.size(); ++k)
      sum += (at(corners[k]) - at(corners[0])).cross(at(corners[k + 1]) - at(corners[0]));
    return 0.5 * sum;
  }

  bool is_flat(int f) const {
    const std::span<const int> corners = face(f);
    double longest = 0;
    for (std::size_t k = 0; k < corners.size(); ++k)
      longest = std::max(longest, (at(corners[k]) - at(vertex_after(corners, k))).squaredNorm());
    return !(2 * vector_area(f).norm() > flat * longest);
  }

  void drop_flat_faces() {
    drop_faces([&](int f) { return is_good(f) && is_flat(f); }, "without area");
  }

  // Corners stay together across edges with two faces. What is left apart at a vertex gets copies of it.
  void split_non_manifold() {
    DisjointSets fans = corner_fans(inspected());
    FaceList split = {mesh_.corners, mesh_.face_start};
    std::vector<int> vertex_of_fan(split.corners.size(), -1);  // by its first corner
    std::vector<char> has_fan(vertex_count(), 0);
    int count = 0, first = -1;
    for (std::size_t c = 0; c < split.corners.size(); ++c) {
      int& v = split.corners[c];
      if (!is_vertex(v)) continue;
      int& known = vertex_of_fan[fans.find(static_cast<int>(c))];
      if (known < 0) {
        const bool needs_copy = std::exchange(has_fan[v], 1);
        if (needs_copy && count++ == 0) first = v;
        known = needs_copy ? add_vertex(at(v), source_[v]) : v;
      }
      v = known;
    }
    if (count > 0) take_faces(std::move(split));
    record(count, fmt::format("{} {} added where faces do not form one fan, the first for vertex {}", count,
                              count == 1 ? "copy was" : "copies were", first));
  }

  // A vertex of the mesh when the step ends.
  int add_vertex(const Vector3& position, int source) {
    new_positions_.push_back(position);
    source_.push_back(source);
    return static_cast<int>(source_.size()) - 1;
  }

  void keep_new_vertices() {
    if (new_positions_.empty()) return;
    inspected_.reset();
    const int count = vertex_count();
    mesh_.V.conservativeResize(static_cast<Eigen::Index>(source_.size()), 3);
    for (std::size_t k = 0; k < new_positions_.size(); ++k)
      mesh_.V.row(count + static_cast<int>(k)) = new_positions_[k];
    new_positions_.clear();
  }

  // The neighbours of each face, in the order of the edges between them: half-edges of the face, in groups.
  Groups sides_by_face(const InspectedMesh& s) const {
    Groups sides;
    sides.start.assign(static_cast<std::size_t>(face_count()) + 1, 0);
    for (int e = 0; e < s.edge_count(); ++e)
      for (int i = 0; s.faces_on(e) == 2 && i < 2; ++i) ++sides.start[s.face_of[s.half_edge(e, i)] + 1];
    std::partial_sum(sides.start.begin(), sides.start.end(), sides.start.begin());
    sides.items.resize(static_cast<std::size_t>(sides.start.back()));
    std::vector<int> fill(sides.start.begin(), sides.start.end() - 1);
    for (int e = 0; e < s.edge_count(); ++e)
      for (int i = 0; s.faces_on(e) == 2 && i < 2; ++i)
        sides.items[fill[s.face_of[s.half_edge(e, i)]]++] = s.half_edge(e, 1 - i);  // that of the neighbour
    return sides;
  }

  // Kept as long as the faces stay, even if some are turned over.
  const FaceComponents& components() {
    if (components_) return *components_;
    const InspectedMesh& s = inspected();
    std::vector<int> edge_of(mesh_.corners.size(), -1);  // of half-edges
    for (int e = 0; e < s.edge_count(); ++e)
      for (int i = 0; i < s.faces_on(e); ++i) edge_of[s.half_edge(e, i)] = e;
    const Groups across = sides_by_face(s);
    FaceComponents& result = components_.emplace();
    std::vector<int>& is_turned = result.is_turned;
    is_turned.assign(face_count(), -1);
    for (int seed = 0; seed < face_count(); ++seed) {
      if (is_turned[seed] >= 0) continue;
      std::vector<int> component = {seed};
      is_turned[seed] = 0;
      for (std::size_t k = 0; k < component.size(); ++k)
        for (int i = across.start[component[k]]; i < across.start[component[k] + 1]; ++i) {
          const int face = s.face_of[across.items[i]];
          if (is_turned[face] >= 0) continue;
          is_turned[face] =
              is_turned[component[k]] ^ static_cast<int>(s.runs_twice(edge_of[across.items[i]]));
          component.push_back(face);
        }
      prefer_fewer_turned(component, is_turned);
      result.faces.push_back(std::move(component));
    }
    return result;
  }

  static void prefer_fewer_turned(const std::vector<int>& component, std::vector<int>& is_turned) {
    const auto turned =
        std::count_if(component.begin(), component.end(), [&](int f) { return is_turned[f] == 1; });
    if (2 * turned <= static_cast<std::ptrdiff_t>(component.size())) return;
    for (const int f : component) is_turned[f] ^= 1;
  }

  double volume(const std::vector<int>& component, const std::vector<int>& corners) const {
    const Vector3 middle = at(corners[mesh_.face_start[component.front()]]);
    double sum = 0;
    for (const int f : component) {
      const auto around = std::span(corners).subspan(mesh_.face_start[f], mesh_.face_degree(f));
      for (std::size_t k = 1; k + 1 < around.size(); ++k)
        sum += (at(around[0]) - middle).dot((at(around[k]) - middle).cross(at(around[k + 1]) - middle));
    }
    return sum;
  }

  // Faces on edges with another number of faces than two, and those that are not good.
  std::vector<char> open_faces() {
    const InspectedMesh& s = inspected();
    std::vector<char> is_open(face_count(), 0);
    for (int f = 0; f < face_count(); ++f) is_open[f] = !s.well_formed(f);
    for (int e = 0; e < s.edge_count(); ++e)
      for (int i = 0; s.faces_on(e) != 2 && i < s.faces_on(e); ++i) is_open[s.face_of[s.half_edge(e, i)]] = 1;
    return is_open;
  }

  void orient() {
    const FaceComponents& all = components();
    std::vector<int> is_turned = all.is_turned;
    FaceList oriented = {mesh_.corners, mesh_.face_start};
    const auto turn = [&](int f) {
      turn_over(std::span(oriented.corners).subspan(mesh_.face_start[f], mesh_.face_degree(f)));
    };
    for (int f = 0; f < face_count(); ++f)
      if (is_turned[f]) turn(f);
    const std::vector<char> is_open = open_faces();
    for (const std::vector<int>& component : all.faces) {
      if (std::any_of(component.begin(), component.end(), [&](int f) { return is_open[f]; })) continue;
      if (!(volume(component, oriented.corners) < 0)) continue;
      for (const int f : component) {
        turn(f);
        is_turned[f] ^= 1;
      }
    }
    const auto turned = std::count(is_turned.begin(), is_turned.end(), 1);
    const auto first = std::find(is_turned.begin(), is_turned.end(), 1) - is_turned.begin();
    if (turned > 0) turn_faces(std::move(oriented));
    record(turned, fmt::format("{} {} turned over, the first was face {}", turned,
                               turned == 1 ? "face was" : "faces were", first));
  }

  // Components stay what they are if faces are turned.
  void turn_faces(FaceList oriented) {
    std::optional<FaceComponents> kept = std::move(components_);
    take_faces(std::move(oriented));
    components_ = std::move(kept);
  }

  void keep_largest() {
    const std::vector<std::vector<int>>& all = components().faces;
    if (all.size() < 2) return;
    std::vector<double> areas;
    areas.reserve(all.size());
    for (const std::vector<int>& component : all) {
      double sum = 0;
      for (const int f : component) sum += vector_area(f).norm();
      areas.push_back(sum);
    }
    const auto largest = std::max_element(areas.begin(), areas.end()) - areas.begin();
    std::vector<char> is_kept(face_count(), 0);
    for (const int f : all[largest]) is_kept[f] = 1;
    const int before = face_count();
    const auto dropped = static_cast<long long>(all.size()) - 1;
    keep_faces([&](int f) { return is_kept[f]; });
    record(dropped, fmt::format("{} smaller {} dropped, {} faces in all", dropped,
                                dropped == 1 ? "component was" : "components were", before - face_count()));
  }

  // Boundary curves, against the direction of the faces, so that triangles along them fit.
  std::vector<Polygon> boundary_curves() {
    const InspectedMesh& s = inspected();
    std::map<int, int> after;
    for (int e = 0; e < s.edge_count(); ++e)
      if (s.faces_on(e) == 1) after[s.target(s.half_edge(e, 0))] = s.origin(s.half_edge(e, 0));
    std::vector<Polygon> curves;
    while (!after.empty()) {
      Polygon curve;
      bool is_closed = false;
      for (auto here = after.begin(); here != after.end() && !is_closed; here = after.find(curve.back())) {
        if (curve.empty()) curve.push_back(here->first);
        const int to = here->second;
        after.erase(here);
        is_closed = to == curve.front();
        if (!is_closed) curve.push_back(to);
      }
      // Others run through places that are not manifold, and are left.
      if (is_closed) curves.push_back(std::move(curve));
    }
    std::stable_sort(curves.begin(), curves.end(),
                     [](const Polygon& a, const Polygon& b) { return a.size() > b.size(); });
    return curves;
  }

  // All edges between vertices of the curves.
  std::set<Edge> edges_between(const std::vector<Polygon>& curves) {
    const InspectedMesh& s = inspected();
    std::vector<char> is_concerned(vertex_count(), 0);
    for (const Polygon& curve : curves)
      for (const int v : curve) is_concerned[v] = 1;
    std::set<Edge> edges;
    for (int e = 0; e < s.edge_count(); ++e) {
      const int h = s.half_edge(e, 0);
      if (is_concerned[s.lower(h)] && is_concerned[s.upper(h)]) edges.emplace(s.lower(h), s.upper(h));
    }
    return edges;
  }

  bool is_to_be_filled(const Polygon& curve) const {
    return curve.size() >= 3 &&
           (!options_.largest_hole || static_cast<int>(curve.size()) <= *options_.largest_hole);
  }

  void fill_holes() {
    std::vector<Polygon> curves = boundary_curves();
    if (!options_.largest_hole && !curves.empty()) curves.erase(curves.begin());
    std::erase_if(curves, [&](const Polygon& curve) { return !is_to_be_filled(curve); });
    if (curves.empty()) return;
    std::set<Edge> edges = edges_between(curves);
    FaceList filled = {mesh_.corners, mesh_.face_start};
    for (const Polygon& curve : curves) fill(curve, edges, filled);
    const int triangles = filled.count() - face_count();
    take_faces(std::move(filled));
    record(static_cast<long long>(curves.size()),
           fmt::format("{} {} filled with {} triangles", curves.size(),
                       curves.size() == 1 ? "hole was" : "holes were", triangles));
  }

  // The triangulation of least area whose inner edges the mesh does not have yet; if there is none, or the
  // curve is long, a fan around its middle.
  void fill(const Polygon& curve, std::set<Edge>& edges, FaceList& faces) {
    if (curve.size() <= largest_triangulated_hole && triangulate(curve, edges, faces)) return;
    Vector3 middle = Vector3::Zero();
    for (const int v : curve) middle += at(v) / static_cast<double>(curve.size());
    const int tip = add_vertex(middle, -1);
    for (std::size_t k = 0; k < curve.size(); ++k)
      faces.append(std::array{curve[k], vertex_after(curve, k), tip});
  }

  // By dynamic programming over stretches i .. j of the curve.
  bool triangulate(const Polygon& curve, std::set<Edge>& edges, FaceList& faces) {
    constexpr double impossible = std::numeric_limits<double>::infinity();
    const std::size_t n = curve.size();
    std::vector<std::vector<double>> least(n, std::vector<double>(n, 0));
    std::vector<std::vector<std::size_t>> choice(n, std::vector<std::size_t>(n, 0));
    for (std::size_t length = 2; length < n; ++length)
      for (std::size_t i = 0; i + length < n; ++i) {
        const std::size_t j = i + length;
        least[i][j] = impossible;
        const bool is_side = length == n - 1;
        if (!is_side && edges.contains(undirected(curve[i], curve[j]))) continue;
        for (std::size_t k = i + 1; k < j; ++k) {
          const double area = 0.5 * (at(curve[k]) - at(curve[i])).cross(at(curve[j]) - at(curve[i])).norm();
          if (const double sum = least[i][k] + least[k][j] + area; sum < least[i][j]) {
            least[i][j] = sum;
            choice[i][j] = k;
          }
        }
      }
    if (!(least[0][n - 1] < impossible)) return false;
    std::vector<std::pair<std::size_t, std::size_t>> waiting = {{0, n - 1}};
    while (!waiting.empty()) {
      const auto [i, j] = waiting.back();
      waiting.pop_back();
      if (j - i < 2) continue;
      const std::size_t k = choice[i][j];
      faces.append(std::array{curve[i], curve[k], curve[j]});
      edges.insert(undirected(curve[i], curve[j]));
      waiting.emplace_back(i, k);
      waiting.emplace_back(k, j);
    }
    return true;
  }

  void split_ears() {
    const InspectedMesh& s = inspected();
    std::vector<char> on_boundary(vertex_count(), 0);
    for (int e = 0; e < s.edge_count(); ++e)
      if (s.faces_on(e) == 1)
        on_boundary[s.lower(s.half_edge(e, 0))] = on_boundary[s.upper(s.half_edge(e, 0))] = 1;
    std::map<Edge, int> middle;
    for (int e = 0; e < s.edge_count(); ++e) {
      const int a = s.lower(s.half_edge(e, 0)), b = s.upper(s.half_edge(e, 0));
      if (s.faces_on(e) == 2 && on_boundary[a] && on_boundary[b])
        middle[{a, b}] = add_vertex(0.5 * (at(a) + at(b)), -1);
    }
    if (middle.empty()) return;
    FaceList divided, further;
    for (int f = 0; f < face_count(); ++f) divide(face(f), middle, divided, further);
    divided.append_all(further);
    take_faces(std::move(divided));
    const Edge first = middle.begin()->first;
    record(
        static_cast<long long>(middle.size()),
        fmt::format("{} {} between vertices of the boundary got a vertex in the middle, the first was {}-{}",
                    middle.size(), middle.size() == 1 ? "edge" : "edges", source_[first.first],
                    source_[first.second]));
  }

  // Triangles are divided where edges have a new vertex; polygons get it as a further corner.
  static void divide(std::span<const int> face, const std::map<Edge, int>& middle, FaceList& divided,
                     FaceList& further) {
    Polygon around;
    std::vector<char> is_new;
    for (std::size_t k = 0; k < face.size(); ++k) {
      around.push_back(face[k]);
      is_new.push_back(0);
      if (const auto at = middle.find(undirected(face[k], vertex_after(face, k))); at != middle.end()) {
        around.push_back(at->second);
        is_new.push_back(1);
      }
    }
    if (face.size() > 3 || around.size() == 3) {
      divided.append(around);
      return;
    }
    cut_corners(std::move(around), std::move(is_new), divided, further);
  }

  // Cuts off the corners between two new vertices, and the rest into triangles from a new vertex.
  static void cut_corners(Polygon around, std::vector<char> is_new, FaceList& divided, FaceList& further) {
    const auto begin = std::find(is_new.begin(), is_new.end(), 1) - is_new.begin();
    std::rotate(around.begin(), around.begin() + begin, around.end());
    std::rotate(is_new.begin(), is_new.begin() + begin, is_new.end());
    if (around.size() == 6) {  // three corners and the triangle in the middle
      for (std::size_t k = 0; k < 6; k += 2)
        further.append(std::array{around[k], around[k + 1], around[(k + 2) % 6]});
      divided.append(std::array{around[0], around[2], around[4]});
      return;
    }
    divided.append(std::array{around[0], around[1], around[2]});
    for (std::size_t k = 2; k + 1 < around.size(); ++k)
      further.append(std::array{around[0], around[k], around[k + 1]});
  }

  // The vertices of faces get new numbers in their order; -1 for the others.
  std::vector<int> numbers_of_used() const {
    std::vector<int> number(vertex_count(), -1);
    for (const int v : mesh_.corners)
      if (is_vertex(v)) number[v] = 0;
    int count = 0;
    for (int& v : number)
      if (v == 0) v = count++;
    return number;
  }

  RepairedMesh result() {
    const std::vector<int> number = numbers_of_used();
    const auto count = std::count_if(number.begin(), number.end(), [](int v) { return v >= 0; });
    PolygonMesh& mesh = result_.mesh;
    mesh.V.resize(count, 3);
    const bool has_colours = colours_.rows() > 0 && std::none_of(source_.begin(), source_.end(),
                                                                 [](int source) { return source < 0; });
    if (has_colours) mesh.colours.resize(count, 3);
    result_.source_vertex.resize(static_cast<std::size_t>(count));
    std::vector<int> first_with_source(image_.size(), -1);
    for (int v = 0; v < vertex_count(); ++v) {
      if (number[v] < 0) continue;
      mesh.V.row(number[v]) = mesh_.V.row(v);
      result_.source_vertex[number[v]] = source_[v];
      if (has_colours) mesh.colours.row(number[v]) = colours_.row(source_[v]);
      if (source_[v] >= 0 && first_with_source[source_[v]] < 0) first_with_source[source_[v]] = number[v];
    }
    result_.vertex_of.reserve(image_.size());
    for (const int v : image_) result_.vertex_of.push_back(first_with_source[v]);
    mesh.corners = std::move(mesh_.corners);
    for (int& v : mesh.corners)
      if (v >= 0 && v < static_cast<int>(number.size())) v = number[v];
    mesh.face_start = std::move(mesh_.face_start);
    return std::move(result_);
  }

  const MeshRepairOptions& options_;
  const Points& colours_;
  PolygonMesh mesh_;

  // The vertex that each of the input was welded to, itself if to none; the vertex of the input that each
  // vertex is, or is a copy of.
  std::vector<int> image_, source_;
  std::vector<Vector3> new_positions_;
  std::optional<InspectedMesh> inspected_;
  std::optional<FaceComponents> components_;
  RepairStep step_ = RepairStep::drop_bad_faces;
  RepairedMesh result_;
};

}  // namespace

RepairedMesh repair_mesh(const PolygonMesh& mesh, const MeshRepairOptions& options) {
  if (!(options.weld_tolerance >= 0) || !std::isfinite(options.weld_tolerance))
    throw ArgumentError(fmt::format("the tolerance {} for welding must be a number that is not negative",
                                    options.weld_tolerance));
  return MeshRepair(mesh, options).run();
}

RepairInPlace repair_in_place(const PolygonMesh& mesh, const MeshRepairOptions& options) {
  RepairedMesh repaired = repair_mesh(mesh, options);
  const int n = mesh.vertex_count();
  RepairInPlace result;
  result.summary.records = std::move(repaired.records);
  std::vector<int>& added = result.summary.added;
  std::vector<int> place;  // of each vertex of the repaired mesh
  std::vector<char> is_taken(n, 0);
  place.reserve(repaired.source_vertex.size());
  for (const int source : repaired.source_vertex) {
    const bool keeps_number = source >= 0 && !std::exchange(is_taken[source], 1);
    place.push_back(keeps_number ? source : n + static_cast<int>(added.size()));
    if (!keeps_number) added.push_back(source);
  }
  result.image.reserve(n);
  for (const int v : repaired.vertex_of) result.image.push_back(v < 0 ? -1 : place[v]);

  PolygonMesh& kept = result.mesh;
  const auto rows = n + static_cast<Eigen::Index>(added.size());
  const bool has_faces = repaired.mesh.vertex_count() > 0, has_colours = repaired.mesh.colours.rows() > 0;
  kept.V = has_faces ? Points(repaired.mesh.V.row(0).replicate(rows, 1)) : Points::Zero(rows, 3);
  if (has_colours) kept.colours = Points::Zero(rows, 3);
  for (std::size_t v = 0; v < place.size(); ++v) {
    kept.V.row(place[v]) = repaired.mesh.V.row(static_cast<int>(v));
    if (has_colours) kept.colours.row(place[v]) = repaired.mesh.colours.row(static_cast<int>(v));
  }
  kept.corners = std::move(repaired.mesh.corners);
  for (int& v : kept.corners)
    if (v >= 0 && v < static_cast<int>(place.size())) v = place[v];
  kept.face_start = std::move(repaired.mesh.face_start);
  return result;
}

}  // namespace orbitutte
