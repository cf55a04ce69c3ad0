// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_regimes.hpp"

#include <utility>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/carried.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "tumble/attitude/regime_smoother.hpp"

namespace tumble::scenarios {

CarriedBody join_regimes(const sim::Sensors& sensors, std::span<const ImuSample> samples, const RateReport& report,
                         std::vector<RateState>& rates, std::map<std::string, double>& health) {
  RegimeSmoother::Params params;
  params.rate.model.nominal.lever_arm_m = bridge::lever_arm_I_m(sensors.imus.front());
  params.rate.rails = stated_rails(sensors.imus.front());
  params.evidence.gravity_m_s2 = params.carried.gravity_m_s2 = sensors.gravity_m_s2;
  RegimeSmoother::Report joined;
  joined.rate = report;
  RegimeSmoother(params).join(samples, rates, joined);
  if (!joined.judged) return {};
  health["regime_flight_share"] = joined.shares.flight;
  health["regime_contact_share"] = joined.shares.contact;
  health["regime_carried_share"] = joined.shares.carried;
  health["regime_carried_clipped_max"] = joined.carried_clipped_max;
  health["regime_carried_asked"] = joined.carried_asked ? 1.0 : 0.0;
  const CarriedBody out{joined.carried_clipped_max, joined.shares.carried};
  if (!joined.carried_asked) return out;
  std::map<std::string, double> of_carried;
  report_carried(joined.carried, of_carried);
  for (const auto& [name, value] : of_carried) health["carried_" + name] = value;
  return out;
}

}  // namespace tumble::scenarios
