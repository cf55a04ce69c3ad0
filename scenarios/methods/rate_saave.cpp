// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_saave.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "tumble/angular_velocity/detail/saave.hpp"

namespace tumble::scenarios {

namespace {

std::vector<std::string> stated_lever_arm() {
  return {"lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m"};
}

Estimate run_rate_saave(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (estimate.status.ok())
    estimate.status = saave_rates(sensors, samples, saave_settings(), parameters, estimate.rates);
  count_sources(estimate.rates, estimate.health);
  return estimate;
}

}  // namespace

SaturationAwareRateEstimator::Params saave_defaults() {
  SaturationAwareRateEstimator::Params params;
  params.lever_arm_m = presets::rig_lever_arm_m();
  params.saturation_point_rad_s = presets::kRigSaturationPoint_rad_s;
  return params;
}

const Settings<SaturationAwareRateEstimator::Params>& saave_settings() {
  static const Settings<SaturationAwareRateEstimator::Params> all(saave_defaults(), {.stated = stated_lever_arm()});
  return all;
}

Settings<SaturationAwareRateEstimator::Params> other_saave_settings(std::span<const sim::Parameter> others) {
  return Settings<SaturationAwareRateEstimator::Params>(
      saave_defaults(), {.stated = stated_lever_arm(), .beside = others, .prefix = "rate_"});
}

Status saave_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                   const Settings<SaturationAwareRateEstimator::Params>& settings, const sim::Values& parameters,
                   std::vector<AngularRateState>& out) {
  SaturationAwareRateEstimator::Params params = settings.defaults();
  params.lever_arm_m = bridge::lever_arm_I_m(sensors.imus.front());
  settings.apply(parameters, params);
  out.clear();
  return SaturationAwareRateEstimator(params).estimate(samples, out);
}

Method rate_saave() {
  MethodInfo info;
  info.name = "saave";
  info.kind = Kind::rate;
  info.doc =
      "Estimates the clipped axis from the centripetal force in free flight, then applies a smoother with white noise "
      "on jerk. docs/papers/rig.md compares the errors with those of the ICRA 2024 paper.";
  info.source = "Deschenes et al., Saturation-Aware Angular Velocity Estimation, ICRA 2024";
  info.settings = {&saave_settings()};
  info.robots = {"rig", "pendulum", "sphere"};
  return make_method(std::move(info), run_rate_saave);
}

}  // namespace tumble::scenarios
