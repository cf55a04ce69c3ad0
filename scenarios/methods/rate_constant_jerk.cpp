// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

// Parameters of the other models of ClippedBaseline have no effect, so users cannot set them.
const Settings<baselines::ClippedBaseline::Params>& rate_constant_jerk_settings() {
  static const Settings<baselines::ClippedBaseline::Params> all(
      {.kind = baselines::ClippedBaseline::Kind::constant_jerk},
      {.stated = {"gyro_noise_density"}, .fixed = {"acceleration_psd_rad2_s3"}});
  return all;
}

Estimate run_rate_constant_jerk(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_clipped_baseline(rate_constant_jerk_settings(), sensors, parameters);
}

}  // namespace

Method rate_constant_jerk() {
  MethodInfo info;
  info.name = "constant_jerk";
  info.kind = Kind::rate;
  info.doc =
      "Smooths each axis with a random walk of the angular jerk; clipped readings are lower bounds of the rate. The "
      "method is made for motions that exceed the saturation limit once, without impacts while clipped.";
  info.source = "textbook: smoother of Rauch, Tung and Striebel (1965) with a constant-jerk model (Matern 5/2)";
  info.settings = {&rate_constant_jerk_settings()};
  return make_method(std::move(info), run_rate_constant_jerk);
}

}  // namespace tumble::scenarios
