// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble::oracles {

/// Jacobi elliptic functions sn(u, k), cn(u, k), dn(u, k).
struct JacobiElliptic {
  double sn, cn, dn;
};

/// Computed by the arithmetic-geometric mean and descending Landen transformations (Abramowitz & Stegun 16.4); modulus
/// 0 <= k < 1. Accurate to about 1e-14 (1 + |u|).
JacobiElliptic jacobi_elliptic(double u, double k);

/// Complete elliptic integral of the first kind K(k), 0 <= k < 1, by the arithmetic-geometric mean.
double complete_elliptic_first(double k);

}  // namespace tumble::oracles
