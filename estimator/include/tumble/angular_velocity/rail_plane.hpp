// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/common/detail/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble {

/// RailPlane describes the saturation of one sensing element of a gyro. The compensated readings y saturate at two
/// planes, row . y = b - r and row . y = b + r. The sensing element measures the component of the rate along `row` and
/// clips at the saturation level r. After clipping, the device compensates scale and misalignment, which tilts the two
/// planes by a few percent. The device also subtracts the element's bias, so the saturation levels of the two signs
/// differ by 2 b. For a sensing element of an accelerometer, the unit is m/s^2 instead of rad/s.
struct RailPlane {
  /// Direction m_j: 1 along axis j of the element, and the cross-axis sensitivities along the other two axes.
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double distance_rad_s = 0.0;  ///< saturation level r
  double offset_rad_s = 0.0;    ///< offset b; close to 0 if only one sign was observed
  /// Covariance of the sensitivity to axis (j+1) % 3, the sensitivity to axis (j+2) % 3, r and b, in this order.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::array<int, 2> samples{};   ///< number of samples on the negative and on the positive plane
  std::array<int, 2> segments{};  ///< number of runs of consecutive samples on each plane
  double deviation_rad_s = 0.0;   ///< root mean square distance of the samples from the plane
  double tolerance_rad_s = 0.0;   ///< readings within this distance of the plane, or beyond it, are clipped
  double log_odds = 0.0;          ///< natural log odds of saturation against unsaturated motion

  bool seen(int sign) const { return samples[sign > 0 ? 1 : 0] > 0; }
  /// Returns the distance of a reading below the plane of `sign` (-1 or 1) [rad/s]. A negative distance means that the
  /// reading is beyond the plane.
  double margin_rad_s(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return distance_rad_s - sign * (row.dot(reading_rad_s) - offset_rad_s);
  }
  /// Returns whether a reading is at or beyond the plane of `sign`. Returns false if no saturation with this sign was
  /// observed.
  bool holds(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return seen(sign) && margin_rad_s(reading_rad_s, sign) <= tolerance_rad_s;
  }
  /// Returns whether some readings are so far beyond the plane that the plane cannot be a saturation level.
  bool contradicted_by(std::span<const Eigen::Vector3d> readings_rad_s) const;
  bool operator==(const RailPlane&) const = default;
};

/// RailPlanes contains the saturation planes of the three sensing elements of a gyro. An entry is empty if no
/// saturation of the sensing element was observed.
struct RailPlanes {
  std::array<std::optional<RailPlane>, 3> element;
  bool any() const { return element[0] || element[1] || element[2]; }
  bool operator==(const RailPlanes&) const = default;
};

/// SensingDirections contains the directions along which the sensing elements of a triad (gyro or accelerometer)
/// measure, as determined from saturation planes. Unsaturated sensing elements measure the component of the rate along
/// their sensing directions. Clipped sensing elements provide a lower bound of the component along their sensing
/// directions.
struct SensingDirections {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  Eigen::Vector3d slope_sigma = Eigen::Vector3d::Zero();  ///< deviation of both cross-axis sensitivities
  bool tilted() const { return rows != Eigen::Matrix3d::Identity(); }
  bool operator==(const SensingDirections&) const = default;
};
/// Returns the directions along which the sensing elements of a triad (gyro or accelerometer) measure. A sensing
/// element without a saturation plane has an axis-aligned direction with the standard deviation `unknown_sigma`.
SensingDirections sensing_directions(const RailPlanes& planes, double unknown_sigma);

/// ElementClipping contains the state of each sensing element in a sample. The state is -1 if clipped at the negative
/// saturation level, 1 if clipped at the positive saturation level, and 0 if unsaturated.
struct ElementClipping {
  std::array<std::int8_t, 3> sign{};
  bool any() const { return sign[0] != 0 || sign[1] != 0 || sign[2] != 0; }
  bool operator==(const ElementClipping&) const = default;
};

}  // namespace tumble
