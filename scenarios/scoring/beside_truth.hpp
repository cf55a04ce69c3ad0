// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/scoring/truth_track.hpp"

namespace tumble::scenarios {

const TruthTrack& truth_track(const ScoredEstimate& scored);

const PairedTrack& paired_track(const ScoredEstimate& scored);

const ClippingTruth& clipping_truth(const ScoredEstimate& scored);

struct PairedRate {
  const AngularRateState* estimate = nullptr;  ///< points into the estimate
  std::optional<ClippingTruth::Sample> truth;  ///< empty if unknown
  std::size_t sample = 0;                      ///< sample of the primary IMU

  std::uint8_t clipped_axes() const { return truth ? truth->clipped_axes : std::uint8_t{0}; }
  /// Returns the unclipped axes whose readings are wrong because another sensing element is clipped (bit j: axis j).
  /// The result is 0 if the truth is unknown.
  std::uint8_t cross_axes() const { return truth ? truth->cross_axes : std::uint8_t{0}; }
  bool has_covariance() const { return estimate->covariance_rad2_s2.diagonal().maxCoeff() > 0.0; }
  /// Returns the estimated minus the true rate, in true IMU axes. The true rate must be known.
  Eigen::Vector3d error_rad_s() const { return estimate->w_WI_I_rad_s - truth->rate_rad_s; }
};

const std::vector<PairedRate>& paired_rates(const ScoredEstimate& scored);

}  // namespace tumble::scenarios
