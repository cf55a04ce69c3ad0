// SPDX-License-Identifier: BSD-3-Clause
#include <vector>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/carried.hpp"
#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  (void)check_imu(sensors, samples, estimate);  // a warning, as for the filters
  std::vector<RateState> rates;
  estimate.status = run_carried(sensors, parameters, rates, estimate.attitudes, estimate.health);
  return estimate;
}

}  // namespace

Method attitude_tumble_batch() {
  MethodInfo info;
  info.name = "tumble_batch";
  info.kind = Kind::attitude;
  info.doc =
      "A smoother over the whole recording of a body that is carried: bounded acceleration, velocity and place, rest, "
      "clipped gyro axes as bounds.";
  info.source = "ours";
  info.settings = {&carried_settings()};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
