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

/// Whether a hand held the body, as the regimes of a recording have it.
struct CarriedBody {
  double clipped_max = 0.0;     ///< largest probability that it did throughout a segment of clipped samples
  std::optional<double> share;  ///< of the samples, by probability; none: nothing was judged
};

/// Where the readings say that the body was carried (RegimeEvidence), the smoother of carried bodies has the word:
/// `rates`, those of a smoother that believes in flight and contact, with what it tells of its run, are joined with
/// those of the other. It is asked only where it may matter: where a clipped sample is not clearly in flight or
/// contact. Adds the shares of the regimes to `health`, `regime_carried_asked` with them.
CarriedBody join_regimes(const sim::Sensors& sensors, std::span<const ImuSample> samples, const RateReport& report,
                         std::vector<RateState>& rates, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
