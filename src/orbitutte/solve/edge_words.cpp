// SPDX-License-Identifier: MIT
#include "orbitutte/solve/edge_words.h"

#include <map>
#include <utility>

#include "orbitutte/solve/frames.h"

namespace orbitutte {
namespace {

// The reduced words that have been met, each with a number; 0 is the empty one.
class WordTable {
 public:
  int number(const RotationWord& word) {
    const auto [at, is_new] = numbers_.try_emplace(word, static_cast<int>(words_.size()));
    if (is_new) words_.push_back(word);
    return at->second;
  }

  int product(int a, int b) {
    if (a == 0) return b;
    if (b == 0) return a;
    RotationWord word = words_[a];
    for (const int letter : words_[b])
      if (!word.empty() && word.back() == -letter)
        word.pop_back();
      else
        word.push_back(letter);
    return number(word);
  }

  int inverse(int a) {
    RotationWord word(words_[a].rbegin(), words_[a].rend());
    for (int& letter : word) letter = -letter;
    return number(word);
  }

  std::vector<RotationWord> release() { return std::move(words_); }

 private:
  std::vector<RotationWord> words_ = {{}};
  std::map<RotationWord, int> numbers_ = {{{}, 0}};
};

// R_(a + 1) ... R_b.
RotationWord product_between(int a, int b) {
  RotationWord word;
  for (int letter = a + 1; letter <= b; ++letter) word.push_back(letter);
  return word;
}

// Of every place along the boundary: how many cones have been met up to there.
std::vector<int> cones_met(const CutMesh& cut) {
  std::vector<char> is_cone(cut.source_vertex.size(), 0);
  for (const int v : cut.marks) is_cone[v] = 1;
  std::vector<int> met;
  int count = 0;
  for (const int v : cut.boundary) met.push_back(count += is_cone[v]);
  return met;
}

// Of every cut vertex, the element that takes its input vertex there: the inverse of the product of the
// rotations about the cones that are met after the latter and up to the former.
std::vector<int> elements_of_copies(const CutMesh& cut, const std::vector<int>& met, WordTable& words) {
  std::vector<int> place(cut.source_vertex.size(), 0), element(cut.source_vertex.size(), 0);
  for (int b = 0; b < static_cast<int>(cut.boundary.size()); ++b) {
    const int v = cut.boundary[b], source = cut.source_vertex[v];
    place[v] = b;
    if (v != source) element[v] = words.inverse(words.number(product_between(met[place[source]], met[b])));
  }
  return element;
}

// Of every edge of a bank, the element that takes what lies beyond it to where it continues the face there.
std::map<CutEdge, int> changes_at_sides(const CutMesh& cut, const std::vector<int>& met, WordTable& words) {
  std::map<CutEdge, int> changes;
  const int count = static_cast<int>(cut.boundary.size());
  for (std::size_t s = 0; s < cut.sides.size(); ++s) {
    const auto& [begin, partner] = cut.sides[s];
    if (partner <= static_cast<int>(s)) continue;
    const int end = s + 1 < cut.sides.size() ? cut.sides[s + 1].begin : count;
    const int other_begin = cut.sides[partner].begin, other_end = other_begin + end - begin;
    const int to_first = words.number(product_between(met[begin], met[other_begin])),
              to_second = words.inverse(to_first);
    for (int k = begin; k < end; ++k) {
      const int back = other_end - (k - begin);
      changes[cut_edge(cut.boundary[k], cut.boundary[(k + 1) % count])] = to_first;
      changes[cut_edge(cut.boundary[back % count], cut.boundary[back - 1])] = to_second;
    }
  }
  return changes;
}

}  // namespace

EdgeWords edge_words(const Surface& surface, const IntrinsicTriangulation* triangulation,
                     const CutMesh& cut) {
  WordTable words;
  const std::vector<int> met = cones_met(cut);
  Frames frames(cut, elements_of_copies(cut, met, words), words);
  frames.open_banks(surface.connectivity, cut, changes_at_sides(cut, met, words));
  if (triangulation)
    for (const Flip& flip : triangulation->flips) frames.apply(flip);
  const Triangles& F = triangulation ? triangulation->F : surface.triangles;
  std::vector<GluedEdge> edges =
      edges_along(frames, F, triangulation ? triangulation->connectivity : surface.connectivity);
  return {std::move(edges), words.release()};
}

}  // namespace orbitutte
