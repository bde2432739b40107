// SPDX-License-Identifier: GPL-3.0-or-later
// Solid harmonics, for multipole expansions about a center (in the notation of Dehnen 2014):
//   1 / |t - h| = sum over l of U_l^0(h) V_l^0(t) + 2 sum over m > 0 of Re(conj U_l^m(h) V_l^m(t)),
//   |h| < |t|,  with U_l^m = r^l P_l^m e^(i m phi) / (l + m)!  (regular),
//   V_l^m = (l - m)! P_l^m e^(i m phi) / r^(l + 1)  (irregular), 0 <= m <= l.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <utility>

#include <sinew/core/vector.h>

namespace sinew {

/// One coefficient for each degree l <= top and 0 <= m <= l; those of negative m follow.
template <int top>
class Harmonics {
 public:
  using Number = std::complex<double>;

  static constexpr int place(int l, int m) { return m * (2 * top + 3 - m) / 2 + l - m; }
  static constexpr std::size_t size = (top + 1) * (top + 2) / 2;

  Number& operator()(int l, int m) { return at_[place(l, m)]; }
  const Number& operator()(int l, int m) const { return at_[place(l, m)]; }

  void add(double factor, const Harmonics& other) {
    for (std::size_t i = 0; i < size; ++i) at_[i] += factor * other.at_[i];
  }

  /// 0 where m is out of range.
  Number any(int l, int m) const {
    if (m > l || -m > l) return 0;
    if (m >= 0) return (*this)(l, m);
    return (m % 2 == 0 ? 1.0 : -1.0) * std::conj((*this)(l, -m));
  }

 private:
  std::array<Number, size> at_{};  ///< values, one m after the other
};

/// Without the special cases of infinities.
inline std::complex<double> product(const std::complex<double>& a, const std::complex<double>& b) {
  return {a.real() * b.real() - a.imag() * b.imag(), a.real() * b.imag() + a.imag() * b.real()};
}

/// U_l^m(h).
template <int top>
Harmonics<top> regular_harmonics(const Vec3& h) {
  Harmonics<top> u;
  const double square = h.squaredNorm();
  u(0, 0) = 1;
  for (int m = 0; m <= top; ++m) {
    if (m > 0) u(m, m) = product({h.x() / (2 * m), h.y() / (2 * m)}, u(m - 1, m - 1));
    for (int l = m + 1; l <= top; ++l) {
      const std::complex<double> before = l > m + 1 ? u(l - 2, m) : 0;
      u(l, m) = ((2 * l - 1) * h.z() * u(l - 1, m) - square * before) / (l * l - m * m + 0.0);
    }
  }
  return u;
}

/// (a . grad) U_l^m, from U.
template <int top>
Harmonics<top> derivative_along(const Vec3& a, const Harmonics<top>& u) {
  Harmonics<top> result;
  const std::complex<double> half(a.x() / 2, a.y() / 2);
  for (int l = 1; l <= top; ++l)
    for (int m = 0; m <= l; ++m)
      result(l, m) = a.z() * u.any(l - 1, m) + product(half, u.any(l - 1, m - 1)) -
                     product(std::conj(half), u.any(l - 1, m + 1));
  return result;
}

/// Moments about another center, from which the old one lies at `shift`: those of degree 0 are 0.
template <int top>
Harmonics<top> shifted_moments(const Harmonics<top>& moments, const Vec3& shift) {
  const Harmonics<top> u = regular_harmonics<top>(shift);
  Harmonics<top> result;
  for (int l = 1; l <= top; ++l)
    for (int m = 0; m <= l; ++m)
      for (int k = 0; k < l; ++k)
        for (int n = std::max(-k, m - l + k); n <= std::min(k, m + l - k); ++n)
          result(l, m) += product(u.any(k, n), moments.any(l - k, m - n));
  return result;
}

/// The point at which irregular harmonics are summed: V_l^m = (x + i y)^m v_l^m with real v.
struct IrregularPoint {
  double z, inverse;           ///< z / r^2, 1 / r^2
  double first;                ///< v_m^m
  std::complex<double> power;  ///< (x + i y)^m
};

/// The terms of one m, unrolled.
template <int top, int m>
double terms_of_order(const Harmonics<top>& moments, const IrregularPoint& at) {
  double before = 0, now = at.first, real = 0, imaginary = 0;
#pragma GCC unroll 16
  for (int l = m; l <= top; ++l) {
    const std::complex<double>& moment = moments(l, m);
    real += now * moment.real();
    imaginary += now * moment.imag();
    const double next = (2 * l + 1) * at.z * now - (l * l - m * m) * at.inverse * before;
    before = now;
    now = next;
  }
  return (m > 0 ? 2 : 1) * (real * at.power.real() + imaginary * at.power.imag());
}

/// The field of moments M at t: the sum of 1 / |t - h| above with M in place of U.
template <int top>
double field_of(const Harmonics<top>& moments, const Vec3& t) {
  const double inverse = 1 / t.squaredNorm();
  IrregularPoint at{t.z() * inverse, inverse, std::sqrt(inverse), 1};
  double sum = 0;
  const auto add = [&]<int m>(std::integral_constant<int, m>) {
    sum += terms_of_order<top, m>(moments, at);
    at.power = product(at.power, {t.x(), t.y()});
    at.first *= (2 * m + 1) * inverse;
  };
  [&]<int... m>(std::integer_sequence<int, m...>) { (add(std::integral_constant<int, m>()), ...); }
  (std::make_integer_sequence<int, top + 1>());
  return sum;
}

}  // namespace sinew
