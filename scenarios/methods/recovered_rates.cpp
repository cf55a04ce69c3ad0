// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/recovered_rates.hpp"

#include <vector>

#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/report_rails.hpp"

namespace tumble::scenarios {

RecoveredRates recovered_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                  ReplacedReadings replaced, Estimate& estimate) {
  const RateSmoother::Params rate = stated_params(sensors.imus.front(), rate_tumble_settings().defaults());
  std::vector<AuxiliaryRecording> auxiliary_imus;
  if (!auxiliary_recordings(sensors, auxiliary_imus).ok()) auxiliary_imus.clear();
  RecoveredRates out = recover_rates(samples, auxiliary_imus, regime_params(sensors, rate), replaced);
  report_rails(out.rails, estimate.health);
  if (out.estimated) estimate.health["samples_recovered"] = static_cast<double>(out.replaced);
  return out;
}

}  // namespace tumble::scenarios
