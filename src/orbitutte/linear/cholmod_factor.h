// SPDX-License-Identifier: MIT
// CHOLMOD behind sparse_factor.h. Private to linear/ and solve/; its supernodal module is GPL.
#pragma once

#include <memory>

#include "orbitutte/linear/sparse_factor.h"

namespace orbitutte {

#ifdef ORBITUTTE_HAS_CHOLMOD
std::unique_ptr<SparseFactor> cholmod_factorize(const SparseMatrix& lower);
template <typename Real>
Elimination<Real> cholmod_eliminate(const SparseMatrix& lower, long trailing);
#endif

}  // namespace orbitutte
