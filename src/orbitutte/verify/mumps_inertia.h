// SPDX-License-Identifier: MIT
// The inertia by MUMPS, in binaries built with it (ORBITUTTE_HAS_MUMPS).
#pragma once

#include <memory>

#include "orbitutte/verify/inertia.h"

namespace orbitutte {

/// The same as inertia_counter. The sequential MUMPS has global state, so counters take turns, on any thread.
std::unique_ptr<InertiaCounter> mumps_inertia_counter(const SymmetricMatrix& lower,
                                                      const Eigen::VectorXd& scale);

}  // namespace orbitutte
