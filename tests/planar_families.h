// SPDX-License-Identifier: MIT
// The families of Euclidean orbifolds that can be embedded, told apart from the library's table.
#pragma once

#include <string>
#include <vector>

namespace orbitutte::test {

/// One of each family whose tile is known: no order is free.
inline std::vector<std::string> planar_signatures() { return {"333", "442", "632", "*333", "*442", "*632"}; }

/// Those whose tile has the shape of the surface.
inline std::vector<std::string> free_planar_signatures() { return {"2222", "*2222"}; }

}  // namespace orbitutte::test
