// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "tumble/attitude/detail/imu_merge_state.hpp"

namespace tumble {

/// RigidBodyImuForces contains the mean specific forces of several IMUs on one rigid body over a window, in body axes:
/// imu_merge.md (I6), (I7).
struct RigidBodyImuForces {
  static constexpr std::size_t kImuCount = ImuMergeState::kImus;

  std::array<bool, kImuCount> imu_present{};
  std::array<Eigen::Vector3d, kImuCount> position_m{}, force_m_s2{};
  std::array<double, kImuCount> peak_m_s2{};  ///< largest component of the IMU's readings in the window
  std::array<double, kImuCount> force_change_m_s2{};
  Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero(), acceleration_rad_s2 = Eigen::Vector3d::Zero();
  double uncertainty_rad_s2 = 0.0;         ///< standard deviation of the angular acceleration
  double unsaturated_peak_max_m_s2 = 0.0;  ///< an IMU with smaller readings counts as unsaturated
  double tolerated_saturation_m_s2 = 0.0;  ///< tolerated specific-force difference to other IMUs

  struct AgreeingImuForces {
    std::size_t imu = 0;
    int agreeing_imu_count = -1;
  };

  Eigen::Vector3d misfit(std::size_t k, std::size_t j) const {
    const Eigen::Vector3d d = position_m[k] - position_m[j];
    return force_m_s2[k] - force_m_s2[j] - acceleration_rad_s2.cross(d) - rate_rad_s.cross(rate_rad_s.cross(d));
  }

  bool forces_agree(std::size_t k, std::size_t j) const {
    if (std::max(peak_m_s2[k], peak_m_s2[j]) < unsaturated_peak_max_m_s2) return true;
    const Eigen::Vector3d d = position_m[k] - position_m[j], e = misfit(k, j);
    return std::abs(e.dot(d)) <= tolerated_saturation_m_s2 * d.norm() &&
           e.norm() <= tolerated_saturation_m_s2 + uncertainty_rad_s2 * d.norm();
  }

  /// Returns the IMU that agrees with the largest number of other IMUs. If several IMUs agree with equally many IMUs,
  /// returns the IMU whose specific force changed least.
  AgreeingImuForces largest_agreeing_set() const {
    AgreeingImuForces best;
    for (std::size_t k = 0; k < kImuCount; ++k) {
      if (!imu_present[k]) continue;
      int others = 0;
      for (std::size_t j = 0; j < kImuCount; ++j) others += imu_present[j] && j != k && forces_agree(k, j);
      if (others > best.agreeing_imu_count ||
          (others == best.agreeing_imu_count && force_change_m_s2[k] < force_change_m_s2[best.imu]))
        best = {k, others};
    }
    return best;
  }

  /// Returns the change of the angular acceleration that minimises the specific-force differences between the IMUs:
  /// imu_merge.md (I7).
  Eigen::Vector3d mean_imu_acceleration() const {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (std::size_t k = 0; k < kImuCount; ++k) {
      for (std::size_t j = 0; j < k; ++j) {
        if (!imu_present[k] || !imu_present[j]) continue;
        const Eigen::Vector3d d = position_m[k] - position_m[j];
        A += d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose();
        b += d.cross(misfit(k, j));
      }
    }
    // IMUs on one line leave one component of the angular acceleration undetermined
    return A.completeOrthogonalDecomposition().solve(b);
  }
};

}  // namespace tumble
