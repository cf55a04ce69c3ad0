// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/carried.hpp"

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/report_rails.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"

namespace tumble::scenarios {

const Settings<HandHeldSmoother::Params>& carried_settings() {
  static const Settings<HandHeldSmoother::Params> all(HandHeldSmoother::Params{}, {.stated = {"gravity_m_s2"}});
  return all;
}

ClippedReadings find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::map<std::string, double>& health) {
  ClippingFinder::Params params;
  params.axis_aligned_rails = stated_rails(record);
  const ClippingFinder::Found found = ClippingFinder(params).find(samples);
  report_rails(found.rails, health);
  return to_clipped_readings(samples, found);
}

HandHeldSmoother::Params carried_params(const sim::Sensors& sensors, const sim::Values& parameters) {
  HandHeldSmoother::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  carried_settings().apply(parameters, params);
  return params;
}

Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters, std::vector<RateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health) {
  std::vector<ImuSample> samples;
  if (const Status status = bridge::primary_imu_samples(sensors, samples); !status.ok()) return status;
  const HandHeldSmoother::Params params = carried_params(sensors, parameters);
  const ClippedReadings known = find_clipped(sensors.imus.front(), samples, health);
  HandHeldSmoother::Report report;
  const Status status = HandHeldSmoother(params).estimate(samples, known.clipped(), rates, attitudes, report);
  if (!status.ok()) return status;
  known.mark_partly_saturated(rates);
  report_carried(report, health);
  return status;
}

void report_carried(const HandHeldSmoother::Report& report, std::map<std::string, double>& health) {
  health["iterations"] = report.iterations;
  health["converged"] = report.converged ? 1.0 : 0.0;
  health["hand_mahalanobis"] = report.hand_acceleration_ratio;
  health["revolutions_asked"] = report.revolutions_tested;
  health["revolutions_taken"] = report.revolutions_corrected;
  health["revolutions_open"] = report.revolutions_ambiguous;
  health["revolutions_failed"] = report.revolutions_failed;
}

}  // namespace tumble::scenarios
