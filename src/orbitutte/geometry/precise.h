// SPDX-License-Identifier: MIT
// Numbers of more digits than doubles have, for places where a map shrinks below what doubles resolve.
#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>

#include "orbitutte/types.h"

namespace orbitutte {

/// A floating-point number with a significand of so many bits.
template <int bits>
using PreciseNumber = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<bits, boost::multiprecision::digit_base_2>,
    boost::multiprecision::et_off>;

/// Enough for edges of 1e-60.
using Precise = PreciseNumber<320>;

/// Enough for edges of 1e-290.
using MorePrecise = PreciseNumber<1152>;

/// Enough for the exact sums of doubles.
using MostPrecise = PreciseNumber<2304>;

template <typename Real>
using Vector3Of = Eigen::Matrix<Real, 3, 1>;

template <typename Real>
using Matrix3Of = Eigen::Matrix<Real, 3, 3>;

}  // namespace orbitutte
