// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "tumble/mapping/registration.hpp"

namespace tumble {

/// Unknowns lists the estimated (free) unknowns of the registration, and their indices in the compact sums.
struct Registration::Unknowns {
  std::array<int, kUnknowns> free{};  ///< indices of the free unknowns, ascending
  int count = 0;
  bool deficit = false, calibration = false;

  /// The motion is always free; other unknowns are free if their variance is above 0.
  explicit Unknowns(const Matrix& covariance);

  /// Expands the compact sums to normal equations over all unknowns. Rows of fixed unknowns are 0.
  void expand(const Sums& sum, Matrix& H, Vector& g) const;
  /// Removes the fixed unknowns, so that their solution step is 0.
  void hold(Matrix& H, Vector& g) const;
  void clear_fixed_blocks(Matrix& M) const;
  void clear_fixed(Matrix& covariance) const;

 private:
  bool is_free(int unknown) const {
    return std::find(free.begin(), free.begin() + count, unknown) != free.begin() + count;
  }
};

}  // namespace tumble
