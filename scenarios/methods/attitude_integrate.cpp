// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "tumble/attitude/strapdown.hpp"

namespace tumble::scenarios {

namespace {

Estimate run(const sim::Sensors& sensors, const sim::Values&, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;

  const Strapdown strapdown{Strapdown::Params{}};
  Strapdown::State state;
  estimate.attitudes.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = strapdown.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, Eigen::Matrix3d::Zero()});
  }
  return estimate;
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
