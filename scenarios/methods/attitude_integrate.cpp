// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "tumble/attitude/strapdown.hpp"

namespace tumble::scenarios {

namespace {

Estimate run(const sim::Sensors& sensors, const sim::Values&, const OracleInput&) {
  return run_attitude_filter<Strapdown>(sensors, Strapdown::Params{});
}

}  // namespace

Method attitude_integrate() {
  MethodInfo info;
  info.name = "integrate";
  info.kind = Kind::attitude;
  info.doc = "Integration of the primary IMU's gyro alone, levelled by its first sample.";
  info.source = "textbook strapdown";
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
