// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// Of a device's clip flags those of its gyro's axes.
inline constexpr std::uint8_t kGyroClipFlags = 0b000111;

/// What the primary gyro should have read, and where its rail took something away.
///
/// Definition, used by every score: axis j of a sample is clipped when the reading differs from its unclipped twin (the
/// same errors, no rail) by more than one standard deviation of the gyro's white noise per sample, sqrt(density^2 /
/// period), or 1e-6 rad/s if that is larger. What the rail takes away below the noise is nobody's loss. Behind tilted
/// sensing elements (sim/imu/elements.hpp) this holds of the axes beside a clipped element too, which lose entries of
/// the inverse of the elements' matrix times its deficit: they count as clipped where that shows above the noise.
///
/// Where the truth is another instrument's (rates without unclipped twins: FORMAT.md, "References"), clipped are the
/// axes at a rail that the reference confirms (reference_clipping.hpp), and samples that it does not know are not
/// scored.
class ClippingTruth {
 public:
  struct Sample {
    Eigen::Vector3d rate_rad_s;  ///< true mean rate over the sample's window, true IMU axes
    std::uint8_t clipped_axes;   ///< bit j: axis j is clipped
  };

  /// Throws BadInput when sensors and truth do not belong together.
  ClippingTruth(const sim::Sensors& sensors, const sim::Truth& truth);

  /// The truth at an instant: exactly at a sample's stamp its own; between two stamps the rate is interpolated and the
  /// axes are those of the sample whose window holds the instant. Nothing outside of the recording, nor where it is not
  /// known. O(log N).
  std::optional<Sample> at(std::int64_t time_ns) const;

  /// The sample whose window holds the instant. Nothing outside of the recording. O(log N).
  std::optional<std::size_t> index_at(std::int64_t time_ns) const;

  std::size_t size() const { return record_->time_ns.size(); }
  /// Whether the truth is a reference's.
  bool is_reference() const { return !reference_axes_.empty(); }
  /// Whether the rate of a sample is known: always but for a reference.
  bool known(std::size_t index) const { return !is_reference() || truth_->rate_rad_s[index].allFinite(); }
  /// Samples whose rate is known.
  std::size_t known_samples() const;
  /// None where the rate is not known.
  std::uint8_t clipped_axes(std::size_t index) const;
  /// What the rail took from the axis that lost most, against the unclipped twin (or the reference).
  double depth_rad_s(std::size_t index) const;

 private:
  const sim::ImuRecord* record_;
  const sim::ImuTruth* truth_;
  double tolerance_rad_s_;
  std::vector<std::uint8_t> reference_axes_;
};

}  // namespace tumble::scenarios
