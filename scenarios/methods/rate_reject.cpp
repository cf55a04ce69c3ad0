// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

// Parameters of the other models of ClippedBaseline have no effect, so users cannot set them.
const Settings<baselines::ClippedBaseline::Params>& rate_reject_settings() {
  static const Settings<baselines::ClippedBaseline::Params> all(
      {.kind = baselines::ClippedBaseline::Kind::reject},
      {.stated = {"gyro_noise_density"}, .fixed = {"snap_psd_rad2_s7", "rate_sigma_rad_s"}});
  return all;
}

Estimate run_rate_reject(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_clipped_baseline(rate_reject_settings(), sensors, parameters);
}

}  // namespace

Method rate_reject() {
  MethodInfo info;
  info.name = "reject";
  info.kind = Kind::rate;
  info.doc =
      "Drops clipped readings and predicts the rate as a random walk with the given process noise, forward in time. In "
      "the original system, a lidar corrects the rate; this method has no lidar.";
  info.source = "He et al., Point-LIO, Advanced Intelligent Systems 2023: treatment of saturated readings";
  info.settings = {&rate_reject_settings()};
  return make_method(std::move(info), run_rate_reject);
}

}  // namespace tumble::scenarios
