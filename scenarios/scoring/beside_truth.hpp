// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/scored_estimate.hpp"
#include "scenarios/scoring/truth_track.hpp"

/// An estimate's poses and rates beside the truth, as several families score them. Each is made when first asked for
/// and once for an estimate; all throw what TruthTrack and ClippingTruth throw.
namespace tumble::scenarios {

/// The true motion of the estimate's frame.
const TruthTrack& truth_track(const ScoredEstimate& scored);

/// The estimate's poses beside it.
const PairedTrack& paired_track(const ScoredEstimate& scored);

/// What the primary gyro should have read.
const ClippingTruth& clipping_truth(const ScoredEstimate& scored);

/// One rate of an estimate beside the truth.
struct PairedRate {
  const RateState* estimate = nullptr;         ///< one of the estimate's
  std::optional<ClippingTruth::Sample> truth;  ///< nothing where it is not known
  std::size_t sample = 0;  ///< of the primary IMU, whose window holds the instant; where it is known

  /// Bit j: axis j is clipped. None where the truth is not known.
  std::uint8_t clipped_axes() const { return truth ? truth->clipped_axes : std::uint8_t{0}; }
  /// Estimate minus truth, true IMU axes, where that is known.
  Eigen::Vector3d error_rad_s() const { return estimate->w_WI_I_rad_s - truth->rate_rad_s; }
};

/// Parallel to the estimate's rates. O(N log N).
const std::vector<PairedRate>& paired_rates(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
