// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/recordings/import.hpp"
#include "sim/recording.hpp"

/// What a lidar's own rotation, from sweep to sweep, says of a gyro: unit, senses and axes, mounting, clock. Where a
/// body hardly tilts, carried by hand or driven, gravity shows none of them.
namespace tumble::scenarios {

/// How a lidar turned from one instant to another.
struct SeenRotation {
  std::int64_t from_ns = 0, to_ns = 0;
  Eigen::Vector3d rotation_L_rad = Eigen::Vector3d::Zero();  ///< rotation vector, lidar axes
};

/// Rotations between the ends of sweeps that follow each other, by `slam/constant_velocity`, which sees nothing but the
/// lidar: from ten spans of a dozen sweeps at most, evenly over the recording, each with a map of its own. Kept are
/// those between registered sweeps at 0.1 to 2 rad/s: slower ones tell noise, and faster ones bend the sweeps. Points
/// are those of `lidar`, or in `aside` where that is given. Some ten ms a sweep.
std::vector<SeenRotation> seen_rotations(const sim::LidarRecord& lidar, const PointStore* aside);

/// A signed permutation: axis i of what is meant is `sign[i]` times axis `axis[i]` of what is read.
struct SignedAxes {
  std::array<int, 3> axis{0, 1, 2};
  std::array<int, 3> sign{1, 1, 1};

  Eigen::Matrix3d matrix() const;
  std::string text() const;  ///< "(-x, y, z)"
};

/// A gyro against a lidar. Errors are medians over the pairs, as shares of the median rotation.
struct RotationAgreement {
  std::size_t pairs = 0;
  double unit = 1.0;        ///< of 1, 57.3 and 1/57.3: the factor from the gyro's integral to what the lidar saw
  double unit_error = 1.0;  ///< of the rotations' sizes, which no mounting changes
  double delay_s = 0.0;     ///< the lidar sees what the gyro told so much before, within half a second
  double error_as_read = 1.0;
  SignedAxes axes;  ///< those that fit best
  double axes_error = 1.0;
  double next_error = 1.0;  ///< of the axes that fit next best: near `axes_error` where the motion does not tell them
  Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< the rotation that fits best: what the lidar saw is
                                                               ///< `turned` times what the gyro says
  double turned_error = 1.0;
};

/// None where there are fewer than a dozen pairs that the gyro covers, or neither the axes as read nor others nor a
/// rotation bring the two within 30 %, in any unit. `imu` and `lidar` with their mountings. O(pairs).
std::optional<RotationAgreement> rotation_agreement(const sim::ImuRecord& imu, const sim::LidarRecord& lidar,
                                                    std::span<const SeenRotation> seen);

/// That as a remark: what agrees, or a caution that says what fits instead; "" where nothing is told. Throws BadInput
/// beginning with `where` for rates in the other unit.
std::string agreement_text(const std::string& where, const RotationAgreement& agreement, GyroUnit unit);

/// Remarks on each IMU of a recording that has a lidar and IMUs; none else. Throws BadInput as above, `where` its path.
std::vector<std::string> lidar_rotation_notes(const std::string& where, const Imported& recording, GyroUnit unit);

}  // namespace tumble::scenarios
