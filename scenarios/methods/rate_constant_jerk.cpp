// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/methods/rate_baseline.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::array<sim::Parameter, 2> kParameters = {{
    {"snap_psd_rad2_s7", 1e9, 1e-12, 1e15, "rad^2/s^7", "density of the white angular snap that drives the jerk"},
    {"rate_sigma_rad_s", 20.0, 1e-3, 1e4, "rad/s", "deviation of the rate in the long run, which bounds long gaps"},
}};

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_clipped_baseline({.kind = baselines::ClippedBaseline::Kind::constant_jerk,
                               .snap_psd = parameters.at("snap_psd_rad2_s7"),
                               .rate_sigma_rad_s = parameters.at("rate_sigma_rad_s")},
                              sensors);
}

}  // namespace

Method rate_constant_jerk() {
  MethodInfo info;
  info.name = "constant_jerk";
  info.kind = Kind::rate;
  info.doc =
      "A smoother per axis whose angular jerk is a random walk and whose rate stays bounded, clipped readings as "
      "bounds. Made for swings that pass the rail once, without impacts while they are clipped.";
  info.source = "textbook: Rauch, Tung and Striebel 1965 with a constant-jerk model (Matern 5/2)";
  info.parameters = kParameters;
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
