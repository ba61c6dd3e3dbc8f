// SPDX-License-Identifier: MIT
// The families of Euclidean orbifolds that can be embedded, told apart from the library's table.
#pragma once

#include <string>
#include <vector>

namespace orbitutte::test {

/// One of each family: no order is free.
inline std::vector<std::string> planar_signatures() {
  return {"333", "442", "632", "2222", "*333", "*442", "*632", "*2222"};
}

}  // namespace orbitutte::test
