// SPDX-License-Identifier: MIT
// Complex numbers of more digits than doubles have.
#pragma once

#include <complex>

#include "orbitutte/geometry/precise.h"

namespace orbitutte {

using Complex = std::complex<double>;

/// re + i im.
struct PreciseComplex {
  Precise re, im;
};

inline PreciseComplex operator+(const PreciseComplex& a, const PreciseComplex& b) {
  return {a.re + b.re, a.im + b.im};
}

inline PreciseComplex operator-(const PreciseComplex& a, const PreciseComplex& b) {
  return {a.re - b.re, a.im - b.im};
}

inline PreciseComplex operator*(const PreciseComplex& a, const PreciseComplex& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}

inline PreciseComplex operator/(const PreciseComplex& a, const PreciseComplex& b) {
  const Precise square = b.re * b.re + b.im * b.im;
  return {(a.re * b.re + a.im * b.im) / square, (a.im * b.re - a.re * b.im) / square};
}

inline PreciseComplex with_digits(const Complex& number) {
  return {Precise(number.real()), Precise(number.imag())};
}

inline Complex to_double(const Complex& number) { return number; }
inline Complex to_double(const PreciseComplex& number) {
  return {number.re.convert_to<double>(), number.im.convert_to<double>()};
}

}  // namespace orbitutte
