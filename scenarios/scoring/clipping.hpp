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
/// Axis j of a sample is clipped if its sensing element is saturated. The saturation deficit of element j is component
/// j of d = M (unclipped reading - delivered reading), with the misalignment matrix M. An element is saturated if its
/// deficit exceeds one standard deviation of the gyro's white noise per sample, sqrt(density^2 / period), and 1e-6
/// rad/s.
///
/// If the elements are tilted (sim/imu/elements.hpp), a saturated element also changes the readings of the other axes.
/// An unclipped axis has a cross-axis error if such a change exceeds the tolerance.
///
/// If the truth comes from a reference instrument, an axis is clipped if the reference confirms saturation
/// (reference_clipping.hpp), and cross-axis errors are unknown.
class ClippingTruth {
 public:
  struct Sample {
    Eigen::Vector3d rate_rad_s;  ///< true mean rate over the averaging window, true IMU axes
    std::uint8_t clipped_axes;   ///< bit j: the sensing element of axis j is saturated
    std::uint8_t cross_axes;     ///< bit j: axis j is unclipped and has a cross-axis error
  };

  ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth);

  /// Returns the interpolated true rate, and the clipped axes of the sample whose averaging window contains `time_ns`.
  /// Returns nothing outside the recording, and where the rate is unknown.
  std::optional<Sample> at(std::int64_t time_ns) const;

  std::optional<std::size_t> index_at(std::int64_t time_ns) const;

  std::size_t size() const { return record_->time_ns.size(); }
  bool is_reference() const { return !reference_axes_.empty(); }
  bool known(std::size_t index) const { return !is_reference() || truth_->rate_rad_s[index].allFinite(); }
  std::size_t known_samples() const;
  std::uint8_t clipped_axes(std::size_t index) const;
  std::uint8_t cross_axes(std::size_t index) const;
  /// Returns the largest difference, over the axes, between the reading and the unclipped reading (or the reference
  /// rate).
  double depth_rad_s(std::size_t index) const;

 private:
  Eigen::Vector3d lost_rad_s(std::size_t index) const;
  std::uint8_t beyond_tolerance(const Eigen::Vector3d& lost_rad_s) const;

  const sim::ImuRecord* record_;
  const sim::ImuTruth* truth_;
  Eigen::Matrix3d elements_ = Eigen::Matrix3d::Identity();  ///< M
  double tolerance_rad_s_;
  std::vector<std::uint8_t> reference_axes_;
};

}  // namespace tumble::scenarios
