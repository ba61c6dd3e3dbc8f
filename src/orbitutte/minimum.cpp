// SPDX-License-Identifier: MIT
#include "orbitutte/minimum.h"

namespace orbitutte {

std::string name(Termination termination) {
  switch (termination) {
    case Termination::converged:
      return "converged";
    case Termination::max_iterations:
      return "max_iterations";
    case Termination::line_search_failed:
      return "line_search_failed";
  }
  return {};
}

}  // namespace orbitutte
