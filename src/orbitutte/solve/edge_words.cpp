// SPDX-License-Identifier: MIT
#include "orbitutte/solve/edge_words.h"

#include <algorithm>
#include <map>
#include <utility>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/solve/frames.h"

namespace orbitutte {
namespace {

// The reduced words that have been met, each with a number; 0 is the empty one. A reflection is its own
// inverse, and stands there as itself.
class WordTable {
 public:
  explicit WordTable(std::vector<char> is_reflection) : is_reflection_(std::move(is_reflection)) {}

  int number(const GluingWord& word) {
    const auto [at, is_new] = numbers_.try_emplace(word, static_cast<int>(words_.size()));
    if (is_new) words_.push_back(word);
    return at->second;
  }

  int product(int a, int b) {
    if (a == 0) return b;
    if (b == 0) return a;
    GluingWord word = words_[a];
    for (const int letter : words_[b])
      if (!word.empty() && word.back() == inverse_letter(letter))
        word.pop_back();
      else
        word.push_back(letter);
    return number(word);
  }

  int inverse(int a) {
    GluingWord word(words_[a].rbegin(), words_[a].rend());
    for (int& letter : word) letter = inverse_letter(letter);
    return number(word);
  }

  std::vector<GluingWord> release() { return std::move(words_); }

 private:
  int inverse_letter(int letter) const { return letter > 0 && is_reflection_[letter - 1] ? letter : -letter; }

  // By generator.
  std::vector<char> is_reflection_;
  std::vector<GluingWord> words_ = {{}};
  std::map<GluingWord, int> numbers_ = {{{}, 0}};
};

// What the boundary of the cut mesh has met, up to each of its places.
class Walk {
 public:
  Walk(const Surface& surface, const CutMesh& cut) : on_boundary_(surface.boundary_vertices()) {
    std::vector<int> letter_of(cut.source_vertex.size(), 0);
    for (std::size_t k = 0; k < cut.arrangement.size(); ++k) {
      const int vertex = cut.marks[cut.arrangement[k]];
      letter_of[vertex] = static_cast<int>(k) + 1;
      is_reflection_.push_back(on_boundary_[vertex]);
    }
    int met = 0, corner = 0;
    for (const int v : cut.boundary) {
      const int letter = letter_of[v];  // of copies there is none
      if (letter > 0) met = letter;
      if (letter > 0 && is_reflection_[letter - 1]) corner = letter;
      met_.push_back(met);
      corner_.push_back(corner);
    }
  }

  const std::vector<char>& is_reflection() const { return is_reflection_; }
  bool is_on_boundary(int vertex) const { return on_boundary_[vertex] != 0; }

  // The product of the rotations about the cones that are met after one place and up to another.
  GluingWord rotations_between(int after, int last) const { return rotations(met_[after] + 1, met_[last]); }

  // The mirror of a disk at a place of its boundary: M = B^-1 m B, with m the generator of the corner before
  // and B the product of the rotations in between.
  int mirror_at(int place, WordTable& words) const {
    const int behind = words.number(rotations(corner_[place] + 1, met_[place]));
    return words.product(words.inverse(behind), words.product(words.number({corner_[place]}), behind));
  }

 private:
  GluingWord rotations(int first, int last) const {
    GluingWord word;
    for (int letter = first; letter <= last; ++letter)
      if (!is_reflection_[letter - 1]) word.push_back(letter);
    return word;
  }

  std::vector<char> on_boundary_, is_reflection_;

  // Of every place: the last mark that has been met first up to there, and the last such corner, as letters.
  std::vector<int> met_, corner_;
};

// Of every cut vertex, the element that takes its input vertex there: the inverse of the product of the
// rotations about the cones that are met after the latter and up to the former.
std::vector<int> elements_of_copies(const CutMesh& cut, const Walk& walk, WordTable& words) {
  std::vector<int> place(cut.source_vertex.size(), 0), element(cut.source_vertex.size(), 0);
  for (int b = 0; b < static_cast<int>(cut.boundary.size()); ++b) {
    const int v = cut.boundary[b], source = cut.source_vertex[v];
    place[v] = b;
    if (v != source) element[v] = words.inverse(words.number(walk.rotations_between(place[source], b)));
  }
  return element;
}

// Of every edge of a bank, the element that takes what lies beyond it to where it continues the face there.
std::map<CutEdge, int> changes_at_sides(const CutMesh& cut, const Walk& walk, WordTable& words) {
  std::map<CutEdge, int> changes;
  const int count = static_cast<int>(cut.boundary.size());
  for (std::size_t s = 0; s < cut.sides.size(); ++s) {
    const auto& [begin, partner] = cut.sides[s];
    if (partner <= static_cast<int>(s)) continue;
    const int end = s + 1 < cut.sides.size() ? cut.sides[s + 1].begin : count;
    const int other_begin = cut.sides[partner].begin, other_end = other_begin + end - begin;
    const int to_first = words.number(walk.rotations_between(begin, other_begin)),
              to_second = words.inverse(to_first);
    for (int k = begin; k < end; ++k) {
      const int back = other_end - (k - begin);
      changes[cut_edge(cut.boundary[k], cut.boundary[(k + 1) % count])] = to_first;
      changes[cut_edge(cut.boundary[back % count], cut.boundary[back - 1])] = to_second;
    }
  }
  return changes;
}

// Of every input vertex, the reflection in the mirror that it lies on: of the first copy that is met. The
// identity for corners, which are held, and inside.
std::vector<int> mirrors_of_vertices(const CutMesh& cut, const Walk& walk, WordTable& words) {
  std::vector<int> mirror(cut.source_vertex.size(), 0);
  for (int b = 0; b < static_cast<int>(cut.boundary.size()); ++b)
    if (const int v = cut.boundary[b]; v == cut.source_vertex[v] && walk.is_on_boundary(v))
      mirror[v] = walk.mirror_at(b, words);
  for (const int v : cut.marks) mirror[v] = 0;
  return mirror;
}

void add_mirror_images(const std::vector<int>& mirror, WordTable& words, EdgeWords& result) {
  const int count = static_cast<int>(result.edges.size());
  for (int e = 0; e < count; ++e) {
    const auto [i, j, t] = result.edges[e];
    if (mirror[i] == 0 && mirror[j] == 0) continue;
    const int image = words.product(mirror[i], words.product(t, mirror[j]));
    if (image == t) continue;
    result.mirrored.push_back(e);
    result.edges.push_back({i, j, image});
  }
}

}  // namespace

Eigen::VectorXd EdgeWords::weights(const Eigen::VectorXd& w) const {
  Eigen::VectorXd result(static_cast<Eigen::Index>(edges.size()));
  result.head(w.size()) = w;
  Eigen::Index image = w.size();
  for (const int e : mirrored) result[image++] = result[e] = w[e] / 2;
  return result;
}

EdgeWords edge_words(const Surface& surface, const IntrinsicTriangulation* triangulation,
                     const CutMesh& cut) {
  const Walk walk(surface, cut);
  WordTable words(walk.is_reflection());
  Frames frames(cut, elements_of_copies(cut, walk, words), words);
  frames.open_banks(surface.connectivity, cut, changes_at_sides(cut, walk, words));
  if (triangulation)
    for (const Flip& flip : triangulation->flips) frames.apply(flip);
  const Triangles& F = triangulation ? triangulation->F : surface.triangles;
  EdgeWords result;
  result.edges = edges_along(frames, F, triangulation ? triangulation->connectivity : surface.connectivity);
  add_mirror_images(mirrors_of_vertices(cut, walk, words), words, result);
  result.words = words.release();
  return result;
}

}  // namespace orbitutte
