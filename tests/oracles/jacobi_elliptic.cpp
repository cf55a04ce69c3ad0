// SPDX-License-Identifier: BSD-3-Clause
#include "oracles/jacobi_elliptic.hpp"

#include <array>
#include <cmath>
#include <numbers>

namespace tumble::oracles {

namespace {
// quadratic convergence: 12 halvings reach rounding for any k that is distinguishable from 1
constexpr int kStepsMax = 16;
}  // namespace

JacobiElliptic jacobi_elliptic(double u, double k) {
  std::array<double, kStepsMax + 1> a{}, c{};
  a[0] = 1.0;
  c[0] = k;
  double b = std::sqrt((1.0 - k) * (1.0 + k));
  int n = 0;
  while (n < kStepsMax && std::abs(c[n]) > 1e-17 * a[n]) {
    a[n + 1] = 0.5 * (a[n] + b);
    c[n + 1] = 0.5 * (a[n] - b);
    b = std::sqrt(a[n] * b);
    ++n;
  }
  double phi = std::ldexp(a[n] * u, n);
  for (; n > 0; --n) phi = 0.5 * (phi + std::asin(c[n] / a[n] * std::sin(phi)));
  const double sn = std::sin(phi);
  return {sn, std::cos(phi), std::sqrt(1.0 - k * k * sn * sn)};
}

double complete_elliptic_first(double k) {
  double a = 1.0, b = std::sqrt((1.0 - k) * (1.0 + k));
  for (int n = 0; n < kStepsMax && a - b > 1e-16 * a; ++n) {
    const double mean = 0.5 * (a + b);
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / (2.0 * a);
}

}  // namespace tumble::oracles
