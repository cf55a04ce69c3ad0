// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Bits of the gyro axes in a device's clip flags.
inline constexpr std::uint8_t kGyroClipFlags = 0b000111;

/// Determines the true rates of the primary gyro, and which of its samples are clipped.
///
/// All scores use this definition: axis j of a sample is clipped if the reading differs from its unclipped twin by more
/// than a tolerance. The twin has the same errors but no saturation. The tolerance is one standard deviation of the
/// gyro's white noise per sample, sqrt(density^2 / period), but at least 1e-6 rad/s; smaller losses do not matter.
/// With tilted sensing elements (sim/imu/elements.hpp), one clipped element also changes the other axes, by entries of
/// the inverse element matrix times its deficit. These axes count as clipped where the change exceeds the tolerance.
///
/// If the truth comes from a reference instrument (rates without unclipped twins: FORMAT.md, "References"), an axis is
/// clipped where the reference confirms saturation (reference_clipping.hpp). Samples without a reference rate are not
/// scored.
class ClippingTruth {
 public:
  struct Sample {
    Eigen::Vector3d rate_rad_s;  ///< true mean rate over the sample's window, true IMU axes
    std::uint8_t clipped_axes;   ///< bit j: axis j is clipped
  };

  /// Throws BadInput if sensors and truth do not belong together.
  ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth);

  /// Returns the truth at an instant. Between two samples the rate is interpolated, and the clipped axes are those of
  /// the sample whose window contains the instant. Empty outside the recording and where unknown. O(log N).
  std::optional<Sample> at(std::int64_t time_ns) const;

  /// Returns the sample whose window contains the instant; empty outside the recording. O(log N).
  std::optional<std::size_t> index_at(std::int64_t time_ns) const;

  std::size_t size() const { return record_->time_ns.size(); }
  /// Returns true if the truth comes from a reference instrument.
  bool is_reference() const { return !reference_axes_.empty(); }
  /// Returns true if the rate of a sample is known; only references have unknown rates.
  bool known(std::size_t index) const { return !is_reference() || truth_->rate_rad_s[index].allFinite(); }
  /// Returns the number of samples with known rate.
  std::size_t known_samples() const;
  /// Returns 0 where the rate is unknown.
  std::uint8_t clipped_axes(std::size_t index) const;
  /// Returns the largest difference of an axis to its unclipped twin, or to the reference.
  double depth_rad_s(std::size_t index) const;

 private:
  const sim::ImuRecord* record_;
  const sim::ImuTruth* truth_;
  double tolerance_rad_s_;
  std::vector<std::uint8_t> reference_axes_;
};

}  // namespace tumble::scenarios
