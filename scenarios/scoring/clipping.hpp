// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Bits of the gyro axes in the clip flags of a device.
inline constexpr std::uint8_t kGyroClipFlags = 0b000111;

/// Determines the true rates of the primary gyro, and which of its samples are clipped.
///
/// All scores use one definition: axis j of a sample is clipped if the reading differs from the unclipped reading by
/// more than a tolerance. The unclipped reading has the errors of the clipped reading but no saturation. The tolerance
/// is one standard deviation of the gyro's white noise per sample, sqrt(density^2 / period), but at least 1e-6 rad/s.
/// Smaller differences do not matter.
///
/// With tilted sensing elements (sim/imu/elements.hpp), one saturated element also changes the other axes. The change
/// is the saturation deficit of the element times an entry of the inverse misalignment matrix. An axis also counts as
/// clipped if its change by another element exceeds the tolerance.
///
/// If the truth comes from a reference instrument, it has rates without unclipped readings (FORMAT.md, "References").
/// In this case, an axis is clipped if the reference confirms saturation (reference_clipping.hpp). Samples without a
/// reference rate are not scored.
class ClippingTruth {
 public:
  struct Sample {
    Eigen::Vector3d rate_rad_s;  ///< true mean rate over the sample's window, true IMU axes
    std::uint8_t clipped_axes;   ///< bit j: axis j is clipped
  };

  /// Throws BadInput if the sensors and the truth do not belong together.
  ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth);

  /// Returns the true rate and the clipped axes at an instant. Between two samples the rate is interpolated, and the
  /// clipped axes belong to the sample whose averaging window contains the instant. Returns empty outside the recording
  /// and where the rate is unknown. O(log N).
  std::optional<Sample> at(std::int64_t time_ns) const;

  /// Returns the index of the sample whose averaging window contains the instant. Empty outside the recording. O(log
  /// N).
  std::optional<std::size_t> index_at(std::int64_t time_ns) const;

  std::size_t size() const { return record_->time_ns.size(); }
  /// Returns true if the truth comes from a reference instrument.
  bool is_reference() const { return !reference_axes_.empty(); }
  /// Returns true if the true rate of a sample is known. Only the rates of a reference can be unknown.
  bool known(std::size_t index) const { return !is_reference() || truth_->rate_rad_s[index].allFinite(); }
  /// Returns the number of samples with a known true rate.
  std::size_t known_samples() const;
  /// Returns the clipped axes of a sample, or 0 if its rate is unknown.
  std::uint8_t clipped_axes(std::size_t index) const;
  /// Returns the largest difference over the axes between the reading and the unclipped reading or reference.
  double depth_rad_s(std::size_t index) const;

 private:
  const sim::ImuRecord* record_;
  const sim::ImuTruth* truth_;
  double tolerance_rad_s_;
  std::vector<std::uint8_t> reference_axes_;
};

}  // namespace tumble::scenarios
