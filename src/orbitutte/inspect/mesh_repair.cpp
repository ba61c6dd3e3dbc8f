// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/mesh_repair.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "orbitutte/mesh/disjoint_sets.h"

namespace orbitutte {
namespace {

using Polygon = std::vector<int>;
using Edge = std::pair<int, int>;

constexpr std::size_t largest_triangulated_hole = 200;
constexpr double flat = 1e-12;  // of a face's longest edge, squared, its doubled area

Edge undirected(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// A face's side from corner k to the next.
struct FaceSide {
  int face, k;
};

class MeshRepair {
 public:
  MeshRepair(const PolygonMesh& mesh, const MeshRepairOptions& options)
      : options_(options), colours_(mesh.colours) {
    for (int v = 0; v < mesh.vertex_count(); ++v) {
      V_.push_back(mesh.V.row(v));
      source_.push_back(v);
    }
    for (int f = 0; f < mesh.face_count(); ++f)
      faces_.emplace_back(mesh.corners.begin() + mesh.face_start[f],
                          mesh.corners.begin() + mesh.face_start[f + 1]);
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
    }
    return result();
  }

 private:
  void record(long long count, const std::string& message) {
    if (count > 0) result_.records.push_back({step_, count, message});
  }

  const Vector3& at(int v) const { return V_[v]; }

  bool is_vertex(int v) const { return v >= 0 && v < static_cast<int>(V_.size()); }

  bool is_good(const Polygon& face) const {
    const auto is_usable = [&](int v) { return is_vertex(v) && V_[v].allFinite(); };
    return face.size() >= 3 && std::all_of(face.begin(), face.end(), is_usable) &&
           std::set<int>(face.begin(), face.end()).size() == face.size();
  }

  // The faces for which `is_bad`; records "<count> faces <what>, the first face <f>".
  template <class IsBad>
  void drop_faces(const IsBad& is_bad, std::string_view what) {
    std::vector<Polygon> kept;
    int count = 0, first = -1;
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f) {
      if (!is_bad(f)) {
        kept.push_back(std::move(faces_[f]));
      } else if (count++ == 0) {
        first = f;
      }
    }
    faces_ = std::move(kept);
    record(count, count == 1
                      ? fmt::format("1 face {} was dropped: face {}", what, first)
                      : fmt::format("{} faces {} were dropped, the first was face {}", count, what, first));
  }

  void drop_bad_faces() {
    drop_faces([&](int f) { return !is_good(faces_[f]); },
               "with missing vertices, positions that are not finite or a vertex named twice");
  }

  using Cell = std::array<double, 3>;

  // Of a grid as wide as the tolerance; without one, every point is a cell.
  Cell cell_of(const Vector3& p) const {
    Cell cell;
    for (int axis = 0; axis < 3; ++axis) {
      const double tolerance = options_.weld_tolerance;
      cell[axis] = (tolerance > 0 ? std::floor(p[axis] / tolerance) : p[axis]) + 0.0;  // -0 is 0
    }
    return cell;
  }

  // Calls `meet` for each vertex in the cells around one that are filled.
  template <class Meet>
  void around(const std::map<Cell, std::vector<int>>& cells, const Cell& cell, const Meet& meet) const {
    const int reach = options_.weld_tolerance > 0 ? 1 : 0;
    for (int x = -reach; x <= reach; ++x)
      for (int y = -reach; y <= reach; ++y)
        for (int z = -reach; z <= reach; ++z) {
          const auto there = cells.find({cell[0] + x, cell[1] + y, cell[2] + z});
          if (there == cells.end()) continue;
          for (const int v : there->second) meet(v);
        }
  }

  // Sets of vertices of faces, each within the tolerance of another of its set.
  DisjointSets vertices_together() const {
    std::vector<char> is_used(V_.size(), 0);
    for (const Polygon& face : faces_)
      for (const int v : face)
        if (is_vertex(v)) is_used[v] = V_[v].allFinite();
    DisjointSets sets(static_cast<int>(V_.size()));
    std::map<Cell, std::vector<int>> cells;
    for (int v = 0; v < static_cast<int>(V_.size()); ++v) {
      if (!is_used[v]) continue;
      const Cell cell = cell_of(at(v));
      around(cells, cell, [&](int u) {
        if ((at(u) - at(v)).norm() <= options_.weld_tolerance) sets.unite(u, v);
      });
      cells[cell].push_back(v);
    }
    return sets;
  }

  void weld() {
    DisjointSets sets = vertices_together();
    int count = 0, first = -1;
    std::vector<int> image(V_.size());
    for (int v = 0; v < static_cast<int>(V_.size()); ++v) {
      image[v] = sets.find(v);
      if (image[v] != v && count++ == 0) first = v;
    }
    record(count,
           fmt::format("{} {} welded to others at the same place, the first was vertex {} to {}", count,
                       count == 1 ? "vertex was" : "vertices were", first, first < 0 ? -1 : image[first]));
    if (count == 0) return;
    for (Polygon& face : faces_) {
      for (int& v : face) v = image[v];
      face.erase(std::unique(face.begin(), face.end()), face.end());
      while (face.size() > 1 && face.front() == face.back()) face.pop_back();
    }
    drop_faces([&](int f) { return !is_good(faces_[f]); }, "that fell together when vertices were welded");
  }

  void drop_duplicates() {
    std::set<Polygon> seen;
    drop_faces(
        [&](int f) {
          Polygon sorted = faces_[f];
          std::sort(sorted.begin(), sorted.end());
          return !seen.insert(std::move(sorted)).second;
        },
        "with the same vertices as an earlier one");
  }

  Vector3 vector_area(const Polygon& face) const {
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      sum += (at(face[k]) - at(face[0])).cross(at(face[k + 1]) - at(face[0]));
    return 0.5 * sum;
  }

  void drop_flat_faces() {
    drop_faces(
        [&](int f) {
          double longest = 0;
          for (std::size_t k = 0; k < faces_[f].size(); ++k)
            longest = std::max(longest, (at(faces_[f][k]) - at(next(faces_[f], k))).squaredNorm());
          return !(2 * vector_area(faces_[f]).norm() > flat * longest);
        },
        "without area");
  }

  static int next(const Polygon& face, std::size_t k) { return face[(k + 1) % face.size()]; }

  std::map<Edge, std::vector<FaceSide>> sides() const {
    std::map<Edge, std::vector<FaceSide>> result;
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f)
      for (std::size_t k = 0; k < faces_[f].size(); ++k)
        result[undirected(faces_[f][k], next(faces_[f], k))].push_back({f, static_cast<int>(k)});
    return result;
  }

  // Corners stay together across edges with two faces. What is left apart at a vertex gets copies of it.
  void split_non_manifold() {
    std::vector<int> first_corner = {0};
    for (const Polygon& face : faces_)
      first_corner.push_back(first_corner.back() + static_cast<int>(face.size()));
    DisjointSets fans(first_corner.back());
    for (const auto& [edge, at_edge] : sides()) {
      if (at_edge.size() != 2) continue;
      const auto corner = [&](const FaceSide& side, int v) {
        const Polygon& face = faces_[side.face];
        const int k = face[side.k] == v ? side.k : (side.k + 1) % static_cast<int>(face.size());
        return first_corner[side.face] + k;
      };
      for (const int v : {edge.first, edge.second}) fans.unite(corner(at_edge[0], v), corner(at_edge[1], v));
    }
    std::map<Edge, int> copy;  // by vertex and fan
    std::vector<char> has_fan(V_.size(), 0);
    int count = 0, first = -1;
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f)
      for (std::size_t k = 0; k < faces_[f].size(); ++k) {
        int& v = faces_[f][k];
        const auto [known, is_new] =
            copy.try_emplace({v, fans.find(first_corner[f] + static_cast<int>(k))}, v);
        if (is_new && std::exchange(has_fan[v], 1)) {
          if (count++ == 0) first = v;
          known->second = add_vertex(at(v), source_[v]);
        }
        v = known->second;
      }
    record(count, fmt::format("{} {} added where faces do not form one fan, the first for vertex {}", count,
                              count == 1 ? "copy was" : "copies were", first));
  }

  int add_vertex(const Vector3& position, int source) {
    V_.push_back(position);
    source_.push_back(source);
    return static_cast<int>(V_.size()) - 1;
  }

  struct Components {
    // The faces of each, found across edges with two faces.
    std::vector<std::vector<int>> faces;

    // Must a face be turned, so that neighbours agree?
    std::vector<int> is_turned;
  };

  Components components() const {
    std::vector<std::vector<std::pair<int, int>>> neighbours(faces_.size());  // and: do they disagree?
    for (const auto& [edge, at_edge] : sides()) {
      if (at_edge.size() != 2) continue;
      const FaceSide a = at_edge[0], b = at_edge[1];
      const int disagree = faces_[a.face][a.k] == faces_[b.face][b.k];
      neighbours[a.face].emplace_back(b.face, disagree);
      neighbours[b.face].emplace_back(a.face, disagree);
    }
    Components result;
    std::vector<int>& is_turned = result.is_turned;
    is_turned.assign(faces_.size(), -1);
    for (int seed = 0; seed < static_cast<int>(faces_.size()); ++seed) {
      if (is_turned[seed] >= 0) continue;
      std::vector<int>& component = result.faces.emplace_back();
      component.push_back(seed);
      is_turned[seed] = 0;
      for (std::size_t k = 0; k < component.size(); ++k)
        for (const auto& [face, disagree] : neighbours[component[k]]) {
          if (is_turned[face] >= 0) continue;
          is_turned[face] = is_turned[component[k]] ^ disagree;
          component.push_back(face);
        }
      prefer_fewer_turned(component, is_turned);
    }
    return result;
  }

  static void prefer_fewer_turned(const std::vector<int>& component, std::vector<int>& is_turned) {
    const auto turned =
        std::count_if(component.begin(), component.end(), [&](int f) { return is_turned[f] == 1; });
    if (2 * turned <= static_cast<std::ptrdiff_t>(component.size())) return;
    for (const int f : component) is_turned[f] ^= 1;
  }

  double volume(const std::vector<int>& component) const {
    const Vector3 middle = at(faces_[component.front()].front());
    double sum = 0;
    for (const int f : component)
      for (std::size_t k = 1; k + 1 < faces_[f].size(); ++k)
        sum +=
            (at(faces_[f][0]) - middle).dot((at(faces_[f][k]) - middle).cross(at(faces_[f][k + 1]) - middle));
    return sum;
  }

  void turn_over(int f) { std::reverse(faces_[f].begin() + 1, faces_[f].end()); }

  void orient() {
    Components all = components();
    for (int f = 0; f < static_cast<int>(faces_.size()); ++f)
      if (all.is_turned[f]) turn_over(f);
    std::vector<char> is_open(faces_.size(), 0);
    for (const auto& [edge, at_edge] : sides())
      if (at_edge.size() != 2)
        for (const FaceSide& side : at_edge) is_open[side.face] = 1;
    for (const std::vector<int>& component : all.faces) {
      if (std::any_of(component.begin(), component.end(), [&](int f) { return is_open[f]; })) continue;
      if (!(volume(component) < 0)) continue;
      for (const int f : component) {
        turn_over(f);
        all.is_turned[f] ^= 1;
      }
    }
    const auto turned = std::count(all.is_turned.begin(), all.is_turned.end(), 1);
    const auto first = std::find(all.is_turned.begin(), all.is_turned.end(), 1) - all.is_turned.begin();
    record(turned, fmt::format("{} {} turned over, the first was face {}", turned,
                               turned == 1 ? "face was" : "faces were", first));
  }

  void keep_largest() {
    const std::vector<std::vector<int>> all = components().faces;
    if (all.size() < 2) return;
    const auto area = [&](const std::vector<int>& component) {
      double sum = 0;
      for (const int f : component) sum += vector_area(faces_[f]).norm();
      return sum;
    };
    std::vector<double> areas;
    areas.reserve(all.size());
    for (const std::vector<int>& component : all) areas.push_back(area(component));
    const auto largest = std::max_element(areas.begin(), areas.end()) - areas.begin();
    std::vector<char> is_kept(faces_.size(), 0);
    for (const int f : all[largest]) is_kept[f] = 1;
    const std::size_t before = faces_.size();
    std::vector<Polygon> kept;
    for (std::size_t f = 0; f < before; ++f)
      if (is_kept[f]) kept.push_back(std::move(faces_[f]));
    faces_ = std::move(kept);
    const auto dropped = static_cast<long long>(all.size()) - 1;
    record(dropped, fmt::format("{} smaller {} dropped, {} faces in all", dropped,
                                dropped == 1 ? "component was" : "components were", before - faces_.size()));
  }

  // Boundary curves, against the direction of the faces, so that triangles along them fit.
  std::vector<Polygon> boundary_curves() const {
    std::map<int, int> after;
    for (const auto& [edge, at_edge] : sides()) {
      if (at_edge.size() != 1) continue;
      const Polygon& face = faces_[at_edge[0].face];
      after[next(face, at_edge[0].k)] = face[at_edge[0].k];
    }
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

  void fill_holes() {
    const std::vector<Polygon> curves = boundary_curves();
    int count = 0;
    std::size_t triangles = faces_.size();
    std::set<Edge> edges;
    for (const auto& [edge, at_edge] : sides()) edges.insert(edge);
    for (std::size_t c = options_.largest_hole ? 0 : 1; c < curves.size(); ++c) {
      if (options_.largest_hole && static_cast<int>(curves[c].size()) > *options_.largest_hole) continue;
      if (curves[c].size() < 3) continue;
      fill(curves[c], edges);
      ++count;
    }
    triangles = faces_.size() - triangles;
    record(count, fmt::format("{} {} filled with {} triangles", count, count == 1 ? "hole was" : "holes were",
                              triangles));
  }

  // The triangulation of least area whose inner edges the mesh does not have yet; if there is none, or the
  // curve is long, a fan around its middle.
  void fill(const Polygon& curve, std::set<Edge>& edges) {
    if (curve.size() <= largest_triangulated_hole && triangulate(curve, edges)) return;
    Vector3 middle = Vector3::Zero();
    for (const int v : curve) middle += at(v) / static_cast<double>(curve.size());
    const int tip = add_vertex(middle, -1);
    for (std::size_t k = 0; k < curve.size(); ++k) faces_.push_back({curve[k], next(curve, k), tip});
  }

  // By dynamic programming over stretches i .. j of the curve.
  bool triangulate(const Polygon& curve, std::set<Edge>& edges) {
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
      faces_.push_back({curve[i], curve[k], curve[j]});
      edges.insert(undirected(curve[i], curve[j]));
      waiting.emplace_back(i, k);
      waiting.emplace_back(k, j);
    }
    return true;
  }

  void split_ears() {
    const auto all = sides();
    std::vector<char> on_boundary(V_.size(), 0);
    for (const auto& [edge, at_edge] : all)
      if (at_edge.size() == 1) on_boundary[edge.first] = on_boundary[edge.second] = 1;
    std::map<Edge, int> middle;
    for (const auto& [edge, at_edge] : all)
      if (at_edge.size() == 2 && on_boundary[edge.first] && on_boundary[edge.second])
        middle[edge] = add_vertex(0.5 * (at(edge.first) + at(edge.second)), -1);
    if (middle.empty()) return;
    std::vector<Polygon> divided, further;
    for (const Polygon& face : faces_) divide(face, middle, divided, further);
    faces_ = std::move(divided);
    faces_.insert(faces_.end(), further.begin(), further.end());
    const Edge first = middle.begin()->first;
    record(
        static_cast<long long>(middle.size()),
        fmt::format("{} {} between vertices of the boundary got a vertex in the middle, the first was {}-{}",
                    middle.size(), middle.size() == 1 ? "edge" : "edges", source_[first.first],
                    source_[first.second]));
  }

  // Triangles are divided where edges have a new vertex; polygons get it as a further corner.
  static void divide(const Polygon& face, const std::map<Edge, int>& middle, std::vector<Polygon>& divided,
                     std::vector<Polygon>& further) {
    Polygon around;
    std::vector<char> is_new;
    for (std::size_t k = 0; k < face.size(); ++k) {
      around.push_back(face[k]);
      is_new.push_back(0);
      if (const auto at = middle.find(undirected(face[k], next(face, k))); at != middle.end()) {
        around.push_back(at->second);
        is_new.push_back(1);
      }
    }
    if (face.size() > 3 || around.size() == 3) {
      divided.push_back(std::move(around));
      return;
    }
    cut_corners(std::move(around), std::move(is_new), divided, further);
  }

  // Cuts off the corners between two new vertices, and the rest into triangles from a new vertex.
  static void cut_corners(Polygon around, std::vector<char> is_new, std::vector<Polygon>& divided,
                          std::vector<Polygon>& further) {
    const auto begin = std::find(is_new.begin(), is_new.end(), 1) - is_new.begin();
    std::rotate(around.begin(), around.begin() + begin, around.end());
    std::rotate(is_new.begin(), is_new.begin() + begin, is_new.end());
    if (around.size() == 6) {  // three corners and the triangle in the middle
      for (std::size_t k = 0; k < 6; k += 2)
        further.push_back({around[k], around[k + 1], around[(k + 2) % 6]});
      divided.push_back({around[0], around[2], around[4]});
      return;
    }
    divided.push_back({around[0], around[1], around[2]});
    for (std::size_t k = 2; k + 1 < around.size(); ++k)
      further.push_back({around[0], around[k], around[k + 1]});
  }

  RepairedMesh result() {
    std::vector<int> number(V_.size(), -1);
    for (const Polygon& face : faces_)
      for (const int v : face)
        if (is_vertex(v)) number[v] = 0;
    int count = 0;
    for (int& v : number)
      if (v == 0) v = count++;
    PolygonMesh& mesh = result_.mesh;
    mesh.V.resize(count, 3);
    const bool has_colours = colours_.rows() > 0 && std::none_of(source_.begin(), source_.end(),
                                                                 [](int source) { return source < 0; });
    if (has_colours) mesh.colours.resize(count, 3);
    result_.source_vertex.resize(count);
    for (std::size_t v = 0; v < V_.size(); ++v) {
      if (number[v] < 0) continue;
      mesh.V.row(number[v]) = V_[v];
      result_.source_vertex[number[v]] = source_[v];
      if (has_colours) mesh.colours.row(number[v]) = colours_.row(source_[v]);
    }
    for (const Polygon& face : faces_) {
      for (const int v : face) mesh.corners.push_back(is_vertex(v) ? number[v] : v);
      mesh.face_start.push_back(static_cast<int>(mesh.corners.size()));
    }
    return std::move(result_);
  }

  const MeshRepairOptions& options_;
  const Points& colours_;
  std::vector<Vector3> V_;
  std::vector<int> source_;
  std::vector<Polygon> faces_;
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

}  // namespace orbitutte
