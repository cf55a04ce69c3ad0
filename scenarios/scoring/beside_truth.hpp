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

/// beside_truth.hpp pairs the poses and rates of an estimate with the truth, for several groups of metrics. Each result
/// is computed at its first use and cached for the estimate. All functions throw the exceptions of TruthTrack and
/// ClippingTruth.
namespace tumble::scenarios {

/// Returns the true motion of the estimate's frame.
const TruthTrack& truth_track(const ScoredEstimate& scored);

/// Returns the poses of the estimate, each with the true pose.
const PairedTrack& paired_track(const ScoredEstimate& scored);

/// Returns the true rates and the clipped axes of the primary gyro.
const ClippingTruth& clipping_truth(const ScoredEstimate& scored);

/// PairedRate is one estimated rate with the true rate.
struct PairedRate {
  const RateState* estimate = nullptr;         ///< points into the estimate
  std::optional<ClippingTruth::Sample> truth;  ///< empty if unknown
  std::size_t sample = 0;                      ///< index of the primary IMU's sample at this time, if known

  /// Returns the clipped axes (bit j: axis j), or 0 if the truth is unknown.
  std::uint8_t clipped_axes() const { return truth ? truth->clipped_axes : std::uint8_t{0}; }
  /// Returns the unclipped axes whose reading a clipped element disturbs (bit j: axis j), or 0 if the truth is unknown.
  std::uint8_t cross_axes() const { return truth ? truth->cross_axes : std::uint8_t{0}; }
  /// Returns whether the method reports a covariance of this rate.
  bool has_covariance() const { return estimate->covariance_rad2_s2.diagonal().maxCoeff() > 0.0; }
  /// Returns the estimated minus the true rate, in true IMU axes. The true rate must be known.
  Eigen::Vector3d error_rad_s() const { return estimate->w_WI_I_rad_s - truth->rate_rad_s; }
};

/// Pairs each rate of the estimate with the truth. The cost is O(N log N).
const std::vector<PairedRate>& paired_rates(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
