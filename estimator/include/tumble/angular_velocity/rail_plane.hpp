// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/common/detail/compiled_alike.hpp"  // IWYU pragma: keep

namespace tumble {

/// Saturation of one sensing element of a gyro, seen in the compensated readings y as two planes: row . y = b - r and
/// row . y = b + r. The element senses along `row` and clips there. The device then compensates scale and misalignment,
/// which tilts the plane by a few percent, and subtracts its bias, so the two signs differ. The same holds for an
/// accelerometer's element, with m/s^2 instead of rad/s.
struct RailPlane {
  /// m_j: 1 along the element's axis j, slopes along the other two.
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double distance_rad_s = 0.0;  ///< r
  double offset_rad_s = 0.0;    ///< b; close to 0 if only one sign was observed
  /// Covariance of (slope along axis (j+1) % 3, slope along (j+2) % 3, r, b).
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::array<int, 2> samples{};   ///< samples on the negative and on the positive plane; 0: not observed
  std::array<int, 2> segments{};  ///< number of runs of such samples
  double deviation_rad_s = 0.0;   ///< root mean square distance of the samples from the plane
  double tolerance_rad_s = 0.0;   ///< readings within this distance of the plane, or beyond it, are clipped
  double log_odds = 0.0;          ///< natural log odds of saturation against a motion that looks similar

  bool seen(int sign) const { return samples[sign > 0 ? 1 : 0] > 0; }
  /// Returns the distance of a reading below the plane of `sign` (-1 or 1); negative: beyond it [rad/s].
  double short_of(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return distance_rad_s - sign * (row.dot(reading_rad_s) - offset_rad_s);
  }
  /// Returns whether a reading is at or beyond the plane of `sign`; false if that sign was not observed.
  bool holds(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return seen(sign) && short_of(reading_rad_s, sign) <= tolerance_rad_s;
  }
  /// Returns whether readings lie so far beyond the plane that it cannot be a saturation level.
  bool contradicted_by(std::span<const Eigen::Vector3d> readings_rad_s) const;
  bool operator==(const RailPlane&) const = default;
};

/// Saturation planes of a gyro; empty where no saturation was observed.
struct RailPlanes {
  std::array<std::optional<RailPlane>, 3> element;
  bool any() const { return element[0] || element[1] || element[2]; }
  bool operator==(const RailPlanes&) const = default;
};

/// Sensing directions of a triad's elements, as determined from saturation planes. Free (unsaturated) elements measure
/// the component along their rows; clipped elements bound this component.
struct ElementRows {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  Eigen::Vector3d slope_sigma = Eigen::Vector3d::Zero();  ///< standard deviation of each of the two slopes of a row
  bool tilted() const { return rows != Eigen::Matrix3d::Identity(); }
  bool operator==(const ElementRows&) const = default;
};
/// Returns the rows of the elements. Elements without a plane have axis-aligned rows with a standard deviation of
/// `unknown_sigma`.
ElementRows element_rows(const RailPlanes& planes, double unknown_sigma);

/// State of each element in a sample: -1 or 1 if clipped at that side, 0 if free.
struct ElementClipping {
  std::array<std::int8_t, 3> sign{};
  bool any() const { return sign[0] != 0 || sign[1] != 0 || sign[2] != 0; }
  bool operator==(const ElementClipping&) const = default;
};

}  // namespace tumble
