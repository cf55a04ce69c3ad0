// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/autogain.hpp"
#include "scenarios/baselines/attitude/complementary.hpp"
#include "scenarios/baselines/attitude/madgwick.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/attitude/detail/vqf.hpp"

namespace tumble::scenarios {

namespace {

template <typename Filter>
Estimate run_attitude_filter(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  const Filter filter(default_settings<typename Filter::Params>().read(parameters));
  Estimate estimate;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  typename Filter::State state;
  estimate.attitudes.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = filter.step(sample, state);
    if (!estimate.status.ok()) return estimate;
    estimate.attitudes.push_back({sample.time_ns, state.q_WI, Eigen::Matrix3d::Zero()});
  }
  return estimate;
}

template <typename Filter>
Method attitude_filter(std::string name, std::string doc, std::string source) {
  return make_method({.name = std::move(name),
                      .kind = Kind::attitude,
                      .doc = std::move(doc),
                      .source = std::move(source),
                      .settings = {&default_settings<typename Filter::Params>()}},
                     run_attitude_filter<Filter>);
}

}  // namespace

Method attitude_integrate() {
  return attitude_filter<Strapdown>(
      "integrate", "Integrates the gyro of the primary IMU; the first accelerometer reading gives the initial tilt.",
      "textbook strapdown integration");
}

Method attitude_madgwick() {
  return attitude_filter<baselines::Madgwick>(
      "madgwick", "Applies Madgwick's gradient-descent filter to gyro and accelerometer of the primary IMU.",
      "S. Madgwick, An efficient orientation filter for inertial and inertial/magnetic sensor arrays, 2010");
}

Method attitude_complementary() {
  return attitude_filter<baselines::Complementary>(
      "complementary",
      "Integrates the gyro and corrects the tilt with the direction of the specific force, with one time constant.",
      "textbook complementary filter");
}

Method attitude_autogain() {
  return attitude_filter<baselines::Autogain>(
      "autogain",
      "Combines a step of Madgwick's filter and a step of a complementary filter; the angular rate determines the "
      "weights. The filter is made for rolling spheres.",
      "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021, eqs 2-5");
}

/// The default parameters of VQF are the values of its authors.
Method attitude_vqf() {
  return attitude_filter<Vqf>("vqf",
                              "Applies a low-pass filter to the specific force in a nearly inertial frame. Estimates "
                              "the gyro bias at rest and in motion. Uses no magnetometer.",
                              "D. Laidig, T. Seel, VQF, Information Fusion 91, 2023");
}

}  // namespace tumble::scenarios
