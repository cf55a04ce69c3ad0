// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "tumble/attitude/madgwick.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::array<sim::Parameter, 1> kParameters = {{
    {"gain_rad_s", 0.033, 0.0, 10.0, "rad/s", "speed of the tilt correction, as a quaternion rate (Madgwick, eq. 33)"},
}};

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;

  Madgwick::Params params;
  params.gain_rad_s = parameters.at("gain_rad_s");
  const Madgwick madgwick(params);
  Madgwick::State state;
  estimate.attitudes.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = madgwick.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, Eigen::Matrix3d::Zero()});
  }
  return estimate;
}

}  // namespace

Method attitude_madgwick() {
  MethodInfo info;
  info.name = "madgwick";
  info.kind = Kind::attitude;
  info.doc = "Madgwick's gradient filter on the primary IMU's gyro and accelerometer.";
  info.source = "S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays, 2010";
  info.parameters = kParameters;
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
