// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/registration.hpp"

/// room_map.hpp provides the maps and priors of the registration tests.
namespace tumble::test {

/// Returns a map sampled from a room's surfaces by stationary sensors at three positions.
inline VoxelMap map_of(const Room& room, double noise_m = 0.0) {
  VoxelMap map({0.5, 0.1});
  Motion still;
  still.rest_s = 1e9;
  for (int place = 0; place < 9; ++place) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    const int column = place % 3, row = place / 3;
    T.translation() = Eigen::Vector3d(1.5 * (column - 1), 1.0 * (row - 1), 0.2 * place);
    // three attitudes, so that the rings cross
    T.linear() = so3::exp(0.7 * place * Eigen::Vector3d(1.0, 0.5, 0.2)).toRotationMatrix();
    for (const LidarPoint& point : make_sweep(room, still, T, place, noise_m)) {
      map.insert((T * point.position_L_m.cast<double>()).cast<float>(), 0.02f, 0,
                 static_cast<std::uint32_t>(place * 16 + point.ring));
    }
  }
  return map;
}

/// Returns a prior with an uncertain pose and a known velocity.
inline Registration::Prior loose_prior(double sigma_m, double sigma_rad) {
  Registration::Prior prior;
  prior.covariance.diagonal().head<3>().setConstant(sigma_m * sigma_m);
  prior.covariance.diagonal().segment<3>(3).setConstant(sigma_rad * sigma_rad);
  prior.covariance.diagonal().segment<3>(6).setConstant(1e-6);
  return prior;
}

}  // namespace tumble::test
