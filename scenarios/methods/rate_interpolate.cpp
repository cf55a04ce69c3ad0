// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/rate_baseline.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

namespace {

const Settings<baselines::ClippedBaseline::Params>& rate_interpolate_settings() {
  static const Settings<baselines::ClippedBaseline::Params> all(baselines::ClippedBaseline::Params{},
                                                                {.stated = {"gyro_noise_density"}});
  return all;
}

Estimate run_rate_interpolate(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_clipped_baseline(rate_interpolate_settings(), sensors, parameters);
}

}  // namespace

Method rate_interpolate() {
  MethodInfo info;
  info.name = "interpolate";
  info.kind = Kind::rate;
  info.doc =
      "Interpolates each clipped gap with a cubic that has the values and slopes of both ends and stays beyond the "
      "saturation limit. The method is made for short gaps without impact.";
  info.source = "textbook: cubic interpolation";
  info.settings = {&rate_interpolate_settings()};
  return make_method(std::move(info), run_rate_interpolate);
}

}  // namespace tumble::scenarios
