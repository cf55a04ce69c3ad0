// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "tumble/mapping/detail/registration.hpp"

namespace tumble {

struct Registration::Unknowns {
  std::array<int, kUnknowns> free_unknowns{};  ///< indices of the free unknowns, ascending
  int count = 0;
  bool deficit_free = false, calibration_free = false;

  /// The unknowns of the motion (position, attitude, velocity) are always free. A saturation deficit or calibration
  /// constant is free if its prior variance is above 0.
  explicit Unknowns(const Matrix& covariance);

  /// Expands vectors and matrices over the free unknowns to all unknowns, with zeros for fixed unknowns.
  void expand_to_all_unknowns(const Sums& sum, Matrix& H, Vector& g) const;
  /// Changes the normal equations such that the solution for each fixed unknown is 0.
  void fix_constrained_unknowns(Matrix& H, Vector& g) const;
  void clear_fixed_blocks(Matrix& M) const;
  void clear_fixed(Matrix& covariance) const;

 private:
  bool is_free_unknown(int unknown) const {
    return std::find(free_unknowns.begin(), free_unknowns.begin() + count, unknown) != free_unknowns.begin() + count;
  }
};

}  // namespace tumble
