// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>

namespace tumble::mapping {

inline Eigen::Vector3i voxel_cube_of(const Eigen::Vector3f& p, float cubes_per_m) {
  return (p * cubes_per_m).array().floor().cast<int>();
}

}  // namespace tumble::mapping
