// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/contacts.h"

#include <algorithm>
#include <numeric>

#include "orbitutte/mesh/groups.h"

namespace orbitutte {
namespace {

// The graph whose nodes are the vertices 0 .. n-1 and the faces n .. n+m-1, each face joined to its vertices.
class ContactSearch {
 public:
  ContactSearch(const PolygonTopology& surface, int vertex_count)
      : surface_(surface),
        vertex_count_(vertex_count),
        corners_of_vertex_(
            group_by(surface.corner_count(), vertex_count, [&](int c) { return surface.origin[c]; })),
        done_(vertex_count + surface.face_count(), 0) {}

  // Every cycle of length four is found from its first node, by descending numbers of neighbours.
  std::vector<DoubleContact> run() {
    std::vector<int> order(done_.size());
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return degree(a) > degree(b); });
    for (const int node : order) {
      find_cycles(node);
      done_[node] = 1;
    }
    return std::move(found_);
  }

 private:
  bool is_face(int node) const { return node >= vertex_count_; }
  int degree(int node) const {
    return is_face(node) ? surface_.degree(node - vertex_count_)
                         : corners_of_vertex_.start[node + 1] - corners_of_vertex_.start[node];
  }

  // Calls visit(neighbour) for those that are not done.
  template <typename Visit>
  void for_neighbors(int node, const Visit& visit) const {
    for (int k = 0; k < degree(node); ++k) {
      const int neighbor =
          is_face(node) ? surface_.origin[surface_.face_start[node - vertex_count_] + k]
                        : vertex_count_ +
                              surface_.face_of[corners_of_vertex_.items[corners_of_vertex_.start[node] + k]];
      if (!done_[neighbor]) visit(neighbor);
    }
  }

  void find_cycles(int node) {
    steps_.clear();
    for_neighbors(node, [&](int between) {
      for_neighbors(between, [&](int end) {
        if (end != node) steps_.emplace_back(end, between);
      });
    });
    std::sort(steps_.begin(), steps_.end());
    for (std::size_t begin = 0, end = 0; begin < steps_.size(); begin = end) {
      while (end < steps_.size() && steps_[end].first == steps_[begin].first) ++end;
      judge(node, begin, end);
    }
  }

  // The cycles through `node` and the node that the steps begin .. end - 1 lead to.
  void judge(int node, std::size_t begin, std::size_t end) {
    for (std::size_t k = begin + 1; k < end; ++k) {
      DoubleContact contact = {node, steps_[begin].first, steps_[begin].second, steps_[k].second};
      if (!is_face(node)) {
        std::swap(contact.face, contact.vertex);
        std::swap(contact.other, contact.second);
      }
      contact.face -= vertex_count_;
      contact.other -= vertex_count_;
      if (is_one_contact(contact)) continue;
      found_.push_back(contact);
      return;
    }
  }

  // Begins on the side with fewer corners to look at.
  int corner(int face, int vertex) const {
    if (surface_.degree(face) <= degree(vertex)) {
      int c = surface_.face_start[face];
      while (surface_.origin[c] != vertex) ++c;
      return c;
    }
    const int* c = &corners_of_vertex_.items[corners_of_vertex_.start[vertex]];
    while (surface_.face_of[*c] != face) ++c;
    return *c;
  }

  // Do edges of both faces lead from one vertex to the other?
  bool is_one_contact(const DoubleContact& contact) const {
    const int c = corner(contact.face, contact.vertex);
    const auto is_common = [&](int h) {
      return surface_.twin[h] >= 0 && surface_.face_of[surface_.twin[h]] == contact.other;
    };
    const int degree = surface_.degree(contact.face);
    for (int k = 0, h = c; k < degree && is_common(h); ++k) {
      h = surface_.next(h);
      if (surface_.origin[h] == contact.second) return true;
    }
    for (int k = 0, h = surface_.previous(c); k < degree && is_common(h); ++k) {
      if (surface_.origin[h] == contact.second) return true;
      h = surface_.previous(h);
    }
    return false;
  }

  const PolygonTopology& surface_;
  const int vertex_count_;
  const Groups corners_of_vertex_;
  std::vector<char> done_;
  std::vector<std::pair<int, int>> steps_;  // the node reached and the one between
  std::vector<DoubleContact> found_;
};

}  // namespace

std::vector<DoubleContact> double_contacts(const PolygonTopology& surface, int vertex_count) {
  return ContactSearch(surface, vertex_count).run();
}

}  // namespace orbitutte
