// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sim/recording.hpp"
#include "tumble/angular_velocity/rate_smoother.hpp"
#include "tumble/common/imu.hpp"

namespace tumble::scenarios {

/// Probability that the body was hand-held, from the motion regimes of a recording.
struct CarriedBody {
  double clipped_max = 0.0;     ///< largest probability over segments of clipped samples
  std::optional<double> share;  ///< share of the samples, weighted by probability; empty if not estimated
};

/// Merges hand-held rates into `rates`, which come from a smoother that assumes flight and contact. Where the readings
/// indicate hand-held motion (RegimeEvidence), the result of the hand-held smoother is used. That smoother only runs if
/// a clipped sample is not clearly in flight or contact. Adds the shares of the regimes and `regime_carried_asked` to
/// `health`.
CarriedBody join_regimes(const sim::Sensors& sensors, std::span<const ImuSample> samples, const RateReport& report,
                         std::vector<RateState>& rates, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
