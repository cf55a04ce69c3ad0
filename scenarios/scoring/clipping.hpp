// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

inline constexpr std::uint8_t kGyroClipFlags = 0b000111;

/// ClippingTruth contains the true rates of the primary gyro, and the clipped axes of each sample.
///
/// Axis j of a sample is clipped if its sensing element is saturated. The saturation deficit of sensing element j is
/// component j of d = M (unclipped reading - delivered reading), with the misalignment matrix M. A sensing element is
/// saturated if clipping changes its reading by more than the standard deviation of the gyro noise (at least 1e-6
/// rad/s).
///
/// A saturated sensing element whose axis is not parallel to an output axis also changes the readings of the other
/// output axes (sim/imu/elements.hpp). An unclipped axis has a cross-axis error if the saturation of another sensing
/// element changes the reading of this axis by more than the gyro noise.
///
/// If the truth comes from a reference instrument, an axis counts as clipped if the reference confirms the saturation
/// (reference_clipping.hpp). For a reference instrument, cross-axis errors are unknown, and Sample::cross_axes is 0.
class ClippingTruth {
 public:
  struct Sample {
    Eigen::Vector3d rate_rad_s;  ///< averaging window's mean, true axes
    std::uint8_t clipped_axes;   ///< bit j: element j is saturated
    std::uint8_t cross_axes;     ///< bit j: unclipped with cross-axis error
  };

  ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth);

  /// Returns the interpolated true rate, and the clipped axes of the sample whose averaging window contains `time_ns`;
  /// empty if the true rate is unknown at `time_ns`.
  std::optional<Sample> at(std::int64_t time_ns) const;

  std::optional<std::size_t> index_at(std::int64_t time_ns) const;

  std::size_t size() const { return record_->time_ns.size(); }
  bool is_reference() const { return !reference_axes_.empty(); }
  bool known(std::size_t index) const { return !is_reference() || truth_->rate_rad_s[index].allFinite(); }
  std::size_t known_samples() const;
  std::uint8_t clipped_axes(std::size_t index) const;
  std::uint8_t cross_axes(std::size_t index) const;
  /// Returns the unclipped reading (or, without an unclipped reading, the reference rate) minus the gyro reading.
  Eigen::Vector3d lost_rad_s(std::size_t index) const;
  /// Returns the largest difference, over the axes, between the gyro reading and the unclipped reading or, without an
  /// unclipped reading, the reference rate.
  double depth_rad_s(std::size_t index) const;

 private:
  std::uint8_t beyond_tolerance(const Eigen::Vector3d& lost_rad_s) const;

  const sim::ImuRecord* record_;
  const sim::ImuTruth* truth_;
  Eigen::Matrix3d elements_ = Eigen::Matrix3d::Identity();  ///< misalignment
  double tolerance_rad_s_;
  std::vector<std::uint8_t> reference_axes_;
};

}  // namespace tumble::scenarios
