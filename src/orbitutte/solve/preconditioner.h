// SPDX-License-Identifier: MIT
// What the optimiser asks of a linear system.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// An approximate inverse of the Hessian of the energy.
class Preconditioner {
 public:
  virtual ~Preconditioner() = default;

  /// Its product with a gradient (n x 3), feasible: n x 3.
  virtual Points precondition(const Points& gradient) const = 0;

 protected:
  Preconditioner() = default;
  Preconditioner(const Preconditioner&) = default;
  Preconditioner(Preconditioner&&) = default;
  Preconditioner& operator=(const Preconditioner&) = default;
  Preconditioner& operator=(Preconditioner&&) = default;
};

}  // namespace orbitutte
