// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// kGyroClipFlags contains the bits of the gyro axes in the clip flags of an IMU.
inline constexpr std::uint8_t kGyroClipFlags = 0b000111;

/// ClippingTruth contains the true rates of the primary gyro, and the clipped axes of each sample.
///
/// All scores use one definition: axis j of a sample is clipped if its sensing element is saturated. The saturation
/// deficit of element j is component j of d = M (unclipped reading - delivered reading), with the misalignment matrix
/// M. The unclipped reading has all errors of the delivered reading except saturation. Element j is saturated if its
/// deficit exceeds a tolerance: one standard deviation of the gyro's white noise per sample, sqrt(density^2 / period),
/// but at least 1e-6 rad/s.
///
/// If the elements are tilted (sim/imu/elements.hpp), a saturated element also changes the readings of the other axes:
/// by its saturation deficit times entries of the inverse of M. An unclipped axis has a cross-axis error if such a
/// change exceeds the tolerance.
///
/// If the truth comes from a reference instrument, it contains rates, but no unclipped readings (FORMAT.md,
/// "References"). An axis is then clipped if the reference confirms saturation (reference_clipping.hpp), and cross-axis
/// errors are unknown. The scores ignore samples without a reference rate.
class ClippingTruth {
 public:
  struct Sample {
    Eigen::Vector3d rate_rad_s;  ///< true mean rate over the averaging window, true IMU axes
    std::uint8_t clipped_axes;   ///< bit j: the sensing element of axis j is saturated
    std::uint8_t cross_axes;     ///< bit j: axis j is unclipped and has a cross-axis error
  };

  /// Throws BadInput if the sensors and the truth belong to different recordings.
  ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth);

  /// Returns the true rate and the clipped axes at `time_ns`. The rate is interpolated between two samples. The clipped
  /// axes are those of the sample whose averaging window contains the time. Returns nothing outside the recording, and
  /// where the rate is unknown. The cost is O(log N).
  std::optional<Sample> at(std::int64_t time_ns) const;

  /// Returns the index of the sample whose averaging window contains `time_ns`; empty outside the recording. The cost
  /// is O(log N).
  std::optional<std::size_t> index_at(std::int64_t time_ns) const;

  std::size_t size() const { return record_->time_ns.size(); }
  /// Returns true if the truth comes from a reference instrument.
  bool is_reference() const { return !reference_axes_.empty(); }
  /// Returns true if the true rate of a sample is known; only a reference has unknown rates.
  bool known(std::size_t index) const { return !is_reference() || truth_->rate_rad_s[index].allFinite(); }
  /// Returns the number of samples with a known true rate.
  std::size_t known_samples() const;
  /// Returns the clipped axes of a sample, or 0 if its rate is unknown.
  std::uint8_t clipped_axes(std::size_t index) const;
  /// Returns the unclipped axes of a sample that have a cross-axis error.
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
