// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "oracles/gaussian.hpp"

namespace tumble {

/// Rows along which the elements of a drawn device sense: 1 on the diagonal, `sigma` beside it.
inline Eigen::Matrix3d drawn_rows(std::uint64_t seed, double sigma) {
  oracles::Gaussian noise(seed + 7000);
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) rows(i, j) += i == j ? 0.0 : sigma * noise();
  }
  return rows;
}

}  // namespace tumble
