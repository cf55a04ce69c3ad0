// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_registry.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"

namespace tumble::scenarios {

namespace {

std::span<const sim::Parameter> parameters_with_excess() {
  static const std::vector<sim::Parameter> all =
      joined_parameters({slam_parameters(), excess_parameters(), calibration_parameters()});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  std::vector<ImuSample> samples;
  Estimate estimate =
      begin_with_rates(sensors, samples, [&](Estimate& out) { return railed_rates(sensors, samples, out.rates); });
  if (estimate.status.ok())
    run_slam_chain(sensors, samples, parameters, {.excess_rate = true, .calibration = true}, estimate);
  return estimate;
}

}  // namespace

Status railed_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::vector<RateState>& out) {
  const sim::ImuRecord& record = sensors.imus.front();
  RailDetector::Params params;
  if (record.stated_gyro_range_rad_s > 0.0) params.stated_gyro_rad_s = record.stated_gyro_range_rad_s;
  if (record.stated_accel_range_m_s2 > 0.0) params.stated_accel_m_s2 = record.stated_accel_range_m_s2;
  RailDetector::State state;
  std::vector<Clipping> clipping(samples.size());
  RailDetector(params).classify_all(samples, state, clipping);

  if (const Status status = raw_rates(sensors, samples, out); !status.ok()) return status;
  for (std::size_t k = 0; k < out.size(); ++k) {
    out[k].clipped_axes = clipping[k].gyro;
    out[k].source = clipping[k].gyro ? RateSource::bounded_only : RateSource::measured;
  }
  return {};
}

Method slam_tumble_gyro_only() {
  return rig_slam(
      {.name = "tumble_gyro_only",
       .doc =
           "The chain of tumble with the clipped gyro: the excess of clipped axes comes from the registration alone.",
       .source = "ours",
       .parameters = parameters_with_excess()},
      run);
}

}  // namespace tumble::scenarios
