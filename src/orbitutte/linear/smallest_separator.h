// SPDX-License-Identifier: MIT
// The fewest vertices that separate the two sides of a band. Private to linear/.
#pragma once

#include <vector>

namespace orbitutte {

/// A strip of a graph between two sides. The vertices of the band are 0 .. count() - 1.
struct Band {
  /// The neighbours of vertex v in the band are neighbor[start[v]] .. neighbor[start[v + 1] - 1].
  std::vector<int> start, neighbor;
  /// Does the vertex belong to the first side's end of the band, to the second's?
  std::vector<char> first, second;

  int count() const { return static_cast<int>(first.size()); }
};

/// Where vertices of a band lie.
enum class PlaceInBand : char { before, within, behind };

/// The place of every vertex of the band with regard to the smallest set of its vertices that leaves no path
/// from the first side to the second, or the one nearest to the first side if several are as small. As many
/// paths that share no vertex join the sides (K. Menger, 1927); a band with nothing but the ends of the edges
/// between two sides gives a smallest vertex cover of these (A. Pothen, H. Simon, K.-P. Liou, SIAM J. Matrix
/// Anal. Appl. 11 (1990)), a wider one a shorter separator (C. Ashcraft, J. Liu, SIAM J. Matrix Anal. Appl.
/// 19 (1998)).
std::vector<PlaceInBand> smallest_separator(const Band& band);

}  // namespace orbitutte
