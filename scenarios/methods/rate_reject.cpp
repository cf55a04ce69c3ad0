// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/methods/rate_baseline.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::array<sim::Parameter, 2> kParameters = {{
    {"acceleration_psd_rad2_s3", 1e3, 1e-12, 1e12, "rad^2/s^3",
     "density of the white angular acceleration that drives the rate; 1000 as in Point-LIO's configurations"},
    kTiltedRails,
}};

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_clipped_baseline({.kind = baselines::ClippedBaseline::Kind::reject,
                               .tilted_rails = parameters.at("tilted_rails") > 0.5,
                               .acceleration_psd = parameters.at("acceleration_psd_rad2_s3")},
                              sensors);
}

}  // namespace

Method rate_reject() {
  MethodInfo info;
  info.name = "reject";
  info.kind = Kind::rate;
  info.doc =
      "Clipped rows are dropped and the rate is a random walk pinned by its process noise alone, forward in time. Made "
      "for gaps shorter than the time between two corrections by a lidar, which this stage does not have.";
  info.source = "He et al., Point-LIO, Advanced Intelligent Systems 2023: its treatment of saturated readings";
  info.parameters = kParameters;
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
