// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/common/detail/compiled_alike.hpp"  // IWYU pragma: keep

namespace tumble {

/// The rail of one sensing element of a gyro, as the device's readings show it: the two planes row . y = b - r and
/// row . y = b + r. The element senses along `row` and clips there; the device then compensates scale and misalignment,
/// so that the plane is tilted in the readings y by a few percent, and takes its bias off, so that the signs differ. Of
/// an accelerometer's element it is the same with m/s^2 for rad/s in all that follows.
struct RailPlane {
  /// m_j: 1 along the element's own axis j, the slopes along the other two.
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double distance_rad_s = 0.0;  ///< r
  double offset_rad_s = 0.0;    ///< b; held near 0 where one sign alone was seen
  /// Of (slope along axis (j+1) % 3, slope along (j+2) % 3, r, b).
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::array<int, 2> samples{};   ///< on the plane of the negative and of the positive sign; 0: this sign was not seen
  std::array<int, 2> segments{};  ///< runs of such samples
  double deviation_rad_s = 0.0;   ///< root mean square of the samples about the plane
  double tolerance_rad_s = 0.0;   ///< a reading within this of the plane, or beyond it, is clipped
  double log_odds = 0.0;          ///< natural logarithm of: a rail, against a motion that only looks like one

  bool seen(int sign) const { return samples[sign > 0 ? 1 : 0] > 0; }
  /// How far a reading lies short of the plane of `sign` (-1 or 1); negative: beyond it [rad/s].
  double short_of(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return distance_rad_s - sign * (row.dot(reading_rad_s) - offset_rad_s);
  }
  /// Whether a reading is at, or beyond, the plane of `sign`; never where that sign was not seen.
  bool holds(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return seen(sign) && short_of(reading_rad_s, sign) <= tolerance_rad_s;
  }
  /// Whether readings lie so far beyond it that it is none.
  bool contradicted_by(std::span<const Eigen::Vector3d> readings_rad_s) const;
  bool operator==(const RailPlane&) const = default;
};

/// The rails of a gyro; none where no rail was seen.
struct RailPlanes {
  std::array<std::optional<RailPlane>, 3> element;
  bool any() const { return element[0] || element[1] || element[2]; }
  bool operator==(const RailPlanes&) const = default;
};

/// Along what the elements of a triad sense, as far as their rails tell: free ones measure, and clipped ones bound,
/// what is along their rows.
struct ElementRows {
  Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
  Eigen::Vector3d slope_sigma = Eigen::Vector3d::Zero();  ///< of each row, one of its two slopes
  bool tilted() const { return rows != Eigen::Matrix3d::Identity(); }
  bool operator==(const ElementRows&) const = default;
};
/// Rows of elements that no plane is known of are upright, with a deviation of `unknown_sigma`.
ElementRows element_rows(const RailPlanes& planes, double unknown_sigma);

/// Per element of a sample: -1 or 1 where it is at that rail, 0 where it is free.
struct ElementClipping {
  std::array<std::int8_t, 3> sign{};
  bool any() const { return sign[0] != 0 || sign[1] != 0 || sign[2] != 0; }
  bool operator==(const ElementClipping&) const = default;
};

}  // namespace tumble
