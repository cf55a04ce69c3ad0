// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "tumble/common/types.hpp"

namespace tumble {

enum class Triad : std::uint8_t { gyro, accelerometer };

/// unit: rad/s for the gyro, m/s^2 for the accelerometer
inline const Eigen::Vector3d& triad_reading_of(const ImuSample& sample, Triad triad) {
  return triad == Triad::gyro ? sample.angular_velocity_rad_s : sample.specific_force_m_s2;
}

/// Lowest accepted saturation limit, as a fraction of the stated range: rails.md (R67). The heuristic margin covers
/// sensors that saturate below the range in their data sheet.
inline constexpr double kStatedRailMin = 0.85;

/// Readings within this margin below a saturation limit may be saturated, as a fraction of the limit: rails.md (R54),
/// (R75), rate_stream.md (R93). The margin covers scale errors, tilted saturation planes, and motion between two
/// readings.
inline constexpr double kNearRailRatio = 0.02;

/// maximum difference of readings that count as equal, as a fraction of the saturation limit
inline constexpr double kEqualReadingsRatio = 2e-5;

/// While one sensing element of a gyro is saturated, the readings (x, y, z) are on one of two planes: row . reading =
/// offset -+ limit. The planes are tilted relative to the output axes if the sensor clips first, and then compensates
/// scale and misalignment. The compensation of the element's bias shifts both planes. For an accelerometer, the unit is
/// m/s^2 instead of rad/s.
struct SaturationPlane {
  /// sensing direction of the element: 1 along its own axis j, and the cross-axis sensitivity along each other axis
  Eigen::Vector3d row = Eigen::Vector3d::Zero();
  double saturation_limit_rad_s = 0.0;
  double offset_rad_s = 0.0;  ///< shift of both planes; close to 0 if only one plane was observed
  /// covariance of the sensitivities to axes (j+1) % 3 and (j+2) % 3, limit, and offset, in this order
  Eigen::Matrix4d covariance = Eigen::Matrix4d::Zero();
  std::array<int, 2> samples{};   ///< on the plane of negative, and of positive saturation
  std::array<int, 2> segments{};  ///< runs of consecutive samples on each plane
  double deviation_rad_s = 0.0;   ///< root mean square distance of the samples from the plane
  double tolerance_rad_s = 0.0;   ///< readings less than this below the plane count as clipped
  double log_odds = 0.0;          ///< log odds of saturation against unsaturated motion

  bool was_reached(int sign) const { return samples[sign > 0 ? 1 : 0] > 0; }
  /// Returns how far a reading is below the plane of negative (-1) or positive (1) saturation [rad/s]; negative if the
  /// reading is beyond the plane.
  double distance_to_plane_rad_s(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return saturation_limit_rad_s - sign * (row.dot(reading_rad_s) - offset_rad_s);
  }
  /// Returns true if a reading is at or beyond the plane of the given sign. Returns false if no saturation of this sign
  /// was observed. See rails.md (R54), (R55).
  bool is_saturated(const Eigen::Vector3d& reading_rad_s, int sign) const {
    return was_reached(sign) && distance_to_plane_rad_s(reading_rad_s, sign) <= tolerance_rad_s;
  }
  /// Returns true if readings are so far beyond the plane that it cannot be a saturation limit.
  bool is_contradicted_by_readings(std::span<const Eigen::Vector3d> readings_rad_s) const;
  bool operator==(const SaturationPlane&) const = default;
};

/// One plane per sensing element; empty if no saturation of the element was observed.
struct SaturationPlanes {
  std::array<std::optional<SaturationPlane>, 3> sensing_axis;
  bool any_plane_found() const { return sensing_axis[0] || sensing_axis[1] || sensing_axis[2]; }
  bool operator==(const SaturationPlanes&) const = default;
};

/// Directions along which the three sensing elements of a gyro or accelerometer measure, one row per element.
struct SensingDirections {
  Eigen::Matrix3d sensing_directions = Eigen::Matrix3d::Identity();
  Eigen::Vector3d cross_axis_slope_sigma =
      Eigen::Vector3d::Zero();  ///< standard deviation of both cross-axis sensitivities of each element
  bool has_misaligned_axes() const { return sensing_directions != Eigen::Matrix3d::Identity(); }
  bool operator==(const SensingDirections&) const = default;
};
/// Returns the sensing directions that the saturation planes determine. An element without saturation plane gets its
/// output axis as direction, with the standard deviation `unknown_sigma`.
SensingDirections sensing_directions(const SaturationPlanes& planes, double unknown_sigma);

/// Lower bounds of the gyro's saturation limits, per sensing element and sign: rails.md (R75).
class MinSaturationLevels {
 public:
  void add(const Eigen::Vector3d& rate_rad_s);
  /// Returns true if the reading of the sensing element `axis` is certainly below the saturation limit.
  bool is_below_min_saturation_level(const Eigen::Vector3d& rate_rad_s, Eigen::Index axis) const;
  bool operator==(const MinSaturationLevels&) const = default;

 private:
  std::array<Eigen::Vector3d, 2> min_levels_rad_s_{Eigen::Vector3d::Zero(),
                                                   Eigen::Vector3d::Zero()};  // negative side, positive side
};

}  // namespace tumble
