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

/// ClippingTruth computes the true rates of the primary gyro, and which of its samples are clipped.
///
/// All scores use one definition: axis j of a sample is clipped if its sensing element is saturated. The saturation
/// deficit of element j is the difference d_j of d = M (unclipped reading - delivered reading), with the misalignment
/// matrix M. The unclipped reading has the errors of the delivered reading but no saturation. Sensing element j is
/// saturated if its saturation deficit exceeds a tolerance. The tolerance is one standard deviation of the gyro's white
/// noise per sample, sqrt(density^2 / period), but at least 1e-6 rad/s. The scores ignore saturation deficits below the
/// tolerance.
///
/// If the elements are tilted (sim/imu/elements.hpp), a saturated element also changes the readings of the other axes.
/// The readings of the other axes change by the saturation deficit times entries of the inverse of M. An axis has a
/// cross-axis error if another element changes its reading by more than the tolerance, while its element is
/// unsaturated. An axis with a cross-axis error does not count as clipped.
///
/// If the truth comes from a reference instrument, it contains rates, but no unclipped readings (FORMAT.md,
/// "References"). With a reference, an axis is clipped if the reference confirms saturation (reference_clipping.hpp).
/// With a reference, cross-axis errors are unknown. The scores ignore samples without a reference rate.
class ClippingTruth {
 public:
  struct Sample {
    Eigen::Vector3d rate_rad_s;  ///< true mean rate over the sample's window, true IMU axes
    std::uint8_t clipped_axes;   ///< bit j: the element of axis j is beyond its rail
    std::uint8_t cross_axes;     ///< bit j: axis j has a cross-axis error of a clipped element
  };

  /// Throws BadInput if the sensors and the truth belong to different recordings.
  ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth);

  /// Returns the true rate and the clipped axes at the time `time_ns`. The rate is interpolated between two samples;
  /// the clipped axes are those of the sample whose averaging window contains the time. Returns nothing outside the
  /// recording and where the rate is unknown. The cost is O(log N).
  std::optional<Sample> at(std::int64_t time_ns) const;

  /// Returns the index of the sample whose averaging window contains `time_ns`, or nothing outside the recording. The
  /// cost is O(log N).
  std::optional<std::size_t> index_at(std::int64_t time_ns) const;

  std::size_t size() const { return record_->time_ns.size(); }
  /// Returns whether the truth comes from a reference instrument.
  bool is_reference() const { return !reference_axes_.empty(); }
  /// Returns whether the true rate of a sample is known. Only the rates of a reference can be unknown.
  bool known(std::size_t index) const { return !is_reference() || truth_->rate_rad_s[index].allFinite(); }
  /// Returns the number of samples with a known true rate.
  std::size_t known_samples() const;
  /// Returns the clipped axes of a sample, or 0 if its rate is unknown.
  std::uint8_t clipped_axes(std::size_t index) const;
  /// Returns the axes of a sample that have a cross-axis error. A clipped axis never has a cross-axis error.
  std::uint8_t cross_axes(std::size_t index) const;
  /// Returns the largest difference over the axes between the reading and the unclipped reading (or the reference
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
