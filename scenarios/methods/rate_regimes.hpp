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

/// Probability that the body was hand-held. A recording has three types of motion: flight, contact, hand-held.
struct CarriedBody {
  double clipped_max = 0.0;     ///< largest probability over segments of clipped samples
  std::optional<double> share;  ///< mean probability over the samples; empty if not estimated
};

/// Merges rates of hand-held motion into `rates`, which come from a smoother that assumes flight and contact. Where the
/// readings indicate hand-held motion (RegimeEvidence), the merged rates come from the hand-held smoother. The
/// hand-held smoother runs only if some clipped sample is not clearly in flight or contact. The function adds the
/// fraction of each motion type and `regime_carried_asked` to `health`.
CarriedBody join_regimes(const sim::Sensors& sensors, std::span<const ImuSample> samples, const RateReport& report,
                         std::vector<RateState>& rates, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
