// SPDX-License-Identifier: MIT
// Numbers of two doubles: exact enough for nearly all signs that doubles leave open, and much faster
// than the numbers of precise.h.
//
// Follows M. Joldes, J.-M. Muller, V. Popescu, "Tight and rigorous error bounds for basic building blocks of
// double-word arithmetic", ACM Transactions on Mathematical Software 44 (2017): algorithms 6, 12 and 17.
#pragma once

#include <cmath>

namespace orbitutte {

/// The sum of two doubles, of which the second is at most half a unit in the last place of the first. With u
/// = 2^-53, sums and differences are right to 3 u^2 of themselves, products to 5 u^2, unless they are so
/// small that the second double underflows (below 1e-290). Vectors and matrices of Eigen may hold them.
class DoubleDouble {
 public:
  /// u^2.
  static constexpr double unit = 0x1p-106;

  DoubleDouble() = default;
  DoubleDouble(double x) : high_(x) {}

  /// x + y, exactly.
  static DoubleDouble sum(double x, double y) {
    const double sum = x + y, part = sum - x;
    return {sum, (x - (sum - part)) + (y - part)};
  }

  /// The nearest double.
  explicit operator double() const { return high_; }
  double high() const { return high_; }
  double low() const { return low_; }

  DoubleDouble operator-() const { return {-high_, -low_}; }
  friend DoubleDouble operator+(const DoubleDouble& x, const DoubleDouble& y) {
    const DoubleDouble highs = sum(x.high_, y.high_), lows = sum(x.low_, y.low_);
    const DoubleDouble most = ordered_sum(highs.high_, highs.low_ + lows.high_);
    return ordered_sum(most.high_, lows.low_ + most.low_);
  }
  friend DoubleDouble operator-(const DoubleDouble& x, const DoubleDouble& y) { return x + -y; }
  friend DoubleDouble operator*(const DoubleDouble& x, const DoubleDouble& y) {
    const double product = x.high_ * y.high_, rest = std::fma(x.high_, y.high_, -product);
    const double across = std::fma(x.high_, y.low_, std::fma(x.low_, y.high_, x.low_ * y.low_));
    return ordered_sum(product, rest + across);
  }
  /// Right to 16 u^2 of itself.
  friend DoubleDouble operator/(const DoubleDouble& x, const DoubleDouble& y) {
    const double most = x.high_ / y.high_, rest = (x - DoubleDouble(most) * y).high_ / y.high_;
    return ordered_sum(most, rest);
  }
  DoubleDouble& operator+=(const DoubleDouble& y) { return *this = *this + y; }
  DoubleDouble& operator-=(const DoubleDouble& y) { return *this = *this - y; }
  DoubleDouble& operator*=(const DoubleDouble& y) { return *this = *this * y; }

  friend bool operator==(const DoubleDouble& x, const DoubleDouble& y) {
    return x.high_ == y.high_ && x.low_ == y.low_;
  }
  friend bool operator<(const DoubleDouble& x, const DoubleDouble& y) {
    return x.high_ < y.high_ || (x.high_ == y.high_ && x.low_ < y.low_);
  }

 private:
  DoubleDouble(double high, double low) : high_(high), low_(low) {}

  // Of numbers of which the first is not the smaller one.
  static DoubleDouble ordered_sum(double x, double y) {
    const double sum = x + y;
    return {sum, y - (sum - x)};
  }

  double high_ = 0, low_ = 0;
};

}  // namespace orbitutte
