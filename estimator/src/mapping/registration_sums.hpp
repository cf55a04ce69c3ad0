// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <array>

#include "tumble/mapping/registration.hpp"

namespace tumble {

/// Which of the unknowns are estimated, and where they stand in the compact sums.
struct Registration::Unknowns {
  std::array<int, kUnknowns> free{};  ///< their numbers, ascending
  int count = 0;
  bool deficit = false, calibration = false;

  /// Motion always; of the rest what has a variance.
  explicit Unknowns(const Matrix& covariance);

  /// The sums as normal equations over all unknowns, rows of the held ones 0.
  void expand(const Sums& sum, Matrix& H, Vector& g) const;
  /// Cuts the held ones off: their step is 0.
  void hold(Matrix& H, Vector& g) const;
  void cut_held(Matrix& M) const;
  void clear_held(Matrix& covariance) const;

 private:
  bool is_free(int unknown) const {
    return std::find(free.begin(), free.begin() + count, unknown) != free.begin() + count;
  }
};

}  // namespace tumble
