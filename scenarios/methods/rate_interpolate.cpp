// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/methods/rate_baseline.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::array<sim::Parameter, 1> kParameters = {{kTiltedRails}};

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_clipped_baseline(
      {.kind = baselines::ClippedBaseline::Kind::interpolate, .tilted_rails = parameters.at("tilted_rails") > 0.5},
      sensors);
}

}  // namespace

Method rate_interpolate() {
  MethodInfo info;
  info.name = "interpolate";
  info.kind = Kind::rate;
  info.doc =
      "A cubic over each clipped gap, value and slope continued from both sides and held beyond the rail. Made for "
      "gaps that are short beside the motion, without impacts in them.";
  info.source = "textbook: cubic interpolation";
  info.parameters = kParameters;
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
