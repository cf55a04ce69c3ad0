// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/common/same_compiler_settings.hpp"  // IWYU pragma: keep

namespace tumble {

/// RailPlane describes the saturation of one sensing element of a gyro as two parallel planes in the space of
/// compensated readings. The compensated readings y saturate at the planes row . y = b - r and row . y = b + r. The
/// sensing element measures the component of the rate along `row` and clips at the saturation limit r. The device clips
/// first and then compensates scale and misalignment, which tilts the two planes by a few percent. The device also
/// subtracts the element's bias, so the saturation limits of the two signs differ by 2 b. For an accelerometer, the
/// unit is m/s^2 instead of rad/s.
struct RailPlane {
  /// Sensing direction m_j: 1 along axis j of the element, and the cross-axis sensitivities along the other two axes.
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double distance_rad_s = 0.0;  ///< saturation limit r
  double offset_rad_s = 0.0;    ///< offset b; close to 0 if saturation of only one sign was observed
  /// Covariance of four quantities: the sensitivity to axis (j+1) % 3, the sensitivity to axis (j+2) % 3, r and b.
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::array<int, 2> samples{};   ///< number of samples on the negative and on the positive plane
  std::array<int, 2> segments{};  ///< number of runs of consecutive samples on each plane
  double deviation_rad_s = 0.0;   ///< root mean square distance of the samples from the plane
  double tolerance_rad_s = 0.0;   ///< readings closer to the plane than this, or beyond it, are clipped
  double log_odds = 0.0;          ///< natural log odds of saturation against unsaturated motion

  bool seen(int sign) const { return samples[sign > 0 ? 1 : 0] > 0; }
  /// Returns how far a reading is below the saturation plane of sign `sign` (-1 or 1) [rad/s]. The result is negative
  /// if the reading is beyond the plane.
  double margin_rad_s(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return distance_rad_s - sign * (row.dot(reading_rad_s) - offset_rad_s);
  }
  /// Returns true if a reading is at or beyond the plane with the sign `sign`. Returns false if no saturation with this
  /// sign was observed.
  bool holds(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return seen(sign) && margin_rad_s(reading_rad_s, sign) <= tolerance_rad_s;
  }
  /// Returns true if readings are so far beyond the plane that the plane cannot be a saturation limit.
  bool contradicted_by(std::span<const Eigen::Vector3d> readings_rad_s) const;
  bool operator==(const RailPlane&) const = default;
};

/// RailPlanes contains the saturation planes of the three sensing elements of a gyro or accelerometer. An entry is
/// empty if no saturation of the sensing element was observed.
struct RailPlanes {
  std::array<std::optional<RailPlane>, 3> element;
  bool any() const { return element[0] || element[1] || element[2]; }
  bool operator==(const RailPlanes&) const = default;
};

/// SensingDirections contains the directions along which the sensing elements of a gyro or accelerometer measure,
/// estimated from saturation planes. An unsaturated sensing element measures the component of the rate along its
/// sensing direction. A clipped sensing element gives a lower bound of the component along its sensing direction.
struct SensingDirections {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  Eigen::Vector3d slope_sigma = Eigen::Vector3d::Zero();  ///< standard deviation of both cross-axis sensitivities
  bool tilted() const { return rows != Eigen::Matrix3d::Identity(); }
  bool operator==(const SensingDirections&) const = default;
};
/// Returns the sensing directions of a gyro or accelerometer. A sensing element without a saturation plane has an
/// axis-aligned sensing direction with the standard deviation `unknown_sigma`.
SensingDirections sensing_directions(const RailPlanes& planes, double unknown_sigma);

/// ElementClipping contains the clipping of each sensing element in a sample: -1 at the negative limit, 1 at the
/// positive limit, 0 if unsaturated.
struct ElementClipping {
  std::array<std::int8_t, 3> sign{};
  bool any() const { return sign[0] != 0 || sign[1] != 0 || sign[2] != 0; }
  bool operator==(const ElementClipping&) const = default;
};

}  // namespace tumble
