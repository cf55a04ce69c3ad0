// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/attitude_filter.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/attitude/complementary.hpp"

namespace tumble::scenarios {

namespace {

const Settings<Complementary::Params>& settings() {
  static const Settings<Complementary::Params> all(Complementary::Params{});
  return all;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return run_attitude_filter<Complementary>(sensors, settings().read(parameters));
}

}  // namespace

Method attitude_complementary() {
  MethodInfo info;
  info.name = "complementary";
  info.kind = Kind::attitude;
  info.doc =
      "The gyro integrated, levelled towards the specific force by the smallest rotation with one time constant.";
  info.source = "textbook complementary filter";
  info.settings = {&settings()};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
