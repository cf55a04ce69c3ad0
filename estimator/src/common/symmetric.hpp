// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// Replaces P by (P + P^T) / 2 in place, because a copy of the matrix would need too much stack.
template <class Matrix>
void make_symmetric(Matrix& P) {
  for (int j = 0; j < P.cols(); ++j) {
    for (int i = 0; i < j; ++i) P(i, j) = P(j, i) = 0.5 * (P(i, j) + P(j, i));
  }
}

}  // namespace tumble
