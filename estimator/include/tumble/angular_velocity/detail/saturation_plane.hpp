// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <span>

#include "tumble/common/types.hpp"

namespace tumble {

/// SaturationPlane contains the two parallel planes on which the output readings lie while one sensing element of a
/// gyro is saturated: row . reading = offset -+ limit. The two planes are tilted if the device clips first and then
/// compensates scale and misalignment. The device also subtracts the bias of the sensing element, which shifts both
/// planes. For an accelerometer, the unit is m/s^2 instead of rad/s.
struct SaturationPlane {
  /// sensing direction of the element: 1 along its own axis j, and a cross-axis sensitivity along each other axis
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double saturation_limit_rad_s = 0.0;  ///< saturation limit
  double offset_rad_s = 0.0;            ///< close to 0 if saturation of only one sign was observed
  /// covariance of the sensitivity to axis (j+1) % 3, the sensitivity to axis (j+2) % 3, limit, and offset
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::array<int, 2> samples{};   ///< number of samples on the negative and on the positive plane
  std::array<int, 2> segments{};  ///< number of runs of consecutive samples on each plane
  double deviation_rad_s = 0.0;   ///< root mean square distance of the samples from the plane
  double tolerance_rad_s = 0.0;   ///< readings closer to the plane than this, or beyond it, are clipped
  double log_odds = 0.0;          ///< natural log odds of saturation against unsaturated motion

  bool was_reached(int sign) const { return samples[sign > 0 ? 1 : 0] > 0; }
  /// Returns how far a reading is below the plane with the given sign (-1 or 1) [rad/s]. The result is negative if the
  /// reading is beyond the plane.
  double distance_to_plane_rad_s(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return saturation_limit_rad_s - sign * (row.dot(reading_rad_s) - offset_rad_s);
  }
  /// Returns true if a reading is at or beyond the plane of the given sign. Returns false if no saturation of this sign
  /// was observed. See rails.md (R54), (R55).
  bool is_saturated(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return was_reached(sign) && distance_to_plane_rad_s(reading_rad_s, sign) <= tolerance_rad_s;
  }
  /// Returns true if readings are so far beyond the plane that the plane cannot be a saturation limit.
  bool is_contradicted_by_readings(std::span<const Eigen::Vector3d> readings_rad_s) const;
  bool operator==(const SaturationPlane&) const = default;
};

/// One plane per sensing element; empty if no saturation of the element was observed.
struct SaturationPlanes {
  std::array<std::optional<SaturationPlane>, 3> sensing_axis;
  bool any_plane_found() const { return sensing_axis[0] || sensing_axis[1] || sensing_axis[2]; }
  bool operator==(const SaturationPlanes&) const = default;
};

/// SensingDirections contains the directions along which the sensing elements of a sensor measure, one row per element.
struct SensingDirections {
  Eigen::Matrix3d sensing_directions = Eigen::Matrix3d::Identity();
  Eigen::Vector3d cross_axis_slope_sigma =
      Eigen::Vector3d::Zero();  ///< standard deviation of both cross-axis sensitivities
  bool has_misaligned_axes() const { return sensing_directions != Eigen::Matrix3d::Identity(); }
  bool operator==(const SensingDirections&) const = default;
};
/// A sensing element without a plane of saturated readings has an axis-aligned sensing direction with the standard
/// deviation `unknown_sigma`.
SensingDirections sensing_directions(const SaturationPlanes& planes, double unknown_sigma);

}  // namespace tumble
