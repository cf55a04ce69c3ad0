// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string>

#include "sim/sensors.hpp"

/// imu_position.hpp estimates where a second IMU is mounted on a rigid body.
namespace tumble::scenarios {

/// ImuPosition is the position of a second IMU relative to the first IMU, in the axes of the first IMU.
struct ImuPosition {
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d sigma_m = Eigen::Vector3d::Zero();  ///< standard deviation of each component
  std::size_t samples = 0;                            ///< number of samples with sufficient rotation
  std::string problem;                                ///< explains why the position is unknown; empty: known
};

/// Estimates the position p of a second IMU with the same axes, by least squares. The difference of both specific
/// forces is a x p + w x (w x p) plus a bias, with rate w and angular acceleration a. The least-squares fit omits
/// samples near the largest gyro reading, because the gyro may be saturated. Cost: O(N) for N samples.
ImuPosition estimate_imu_position(const sim::ImuRecord& first, const sim::ImuRecord& second);

}  // namespace tumble::scenarios
