// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/rolling/rolling_odometry.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::array<sim::Parameter, 1> kParameters = {{
    {"rest_s", 1.0, 0.01, 60.0, "s", "length of the rest at the start: gyro bias and tilt are its means"},
}};

struct Rest {
  Eigen::Vector3d gyro_bias_rad_s;
  Eigen::Vector3d specific_force_m_s2;
};

Rest mean_over_rest(std::span<const ImuSample> samples, double rest_s) {
  Rest rest{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  double count = 0.0;
  for (const ImuSample& sample : samples) {
    if (seconds(sample.time_ns - samples.front().time_ns) > rest_s) break;
    rest.gyro_bias_rad_s += sample.angular_velocity_rad_s;
    rest.specific_force_m_s2 += sample.specific_force_m_s2;
    count += 1.0;
  }
  rest.gyro_bias_rad_s /= count;
  rest.specific_force_m_s2 /= count;
  return rest;
}

Estimate run(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  if (!(sensors.sphere_radius_m > 0.0)) throw BadInput("method position/rolling needs a sphere: sphere_radius_m is 0");

  // bias and tilt from the rest before the motion
  const Rest rest = mean_over_rest(samples, parameters.at("rest_s"));
  const Strapdown strapdown{Strapdown::Params{}};
  Strapdown::State attitude;
  estimate.status = level(rest.specific_force_m_s2, attitude.q_WI);
  if (!estimate.status.ok()) return estimate;
  attitude.started = true;
  attitude.last_time_ns = samples.front().time_ns;

  RollingOdometry::Params params;
  params.radius_m = sensors.sphere_radius_m;
  const RollingOdometry odometry(params);
  RollingOdometry::State position;
  const Eigen::Quaterniond q_IB(sensors.imus.front().T_BI.linear().transpose());
  estimate.poses.reserve(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    ImuSample sample = samples[k];
    sample.angular_velocity_rad_s -= rest.gyro_bias_rad_s;
    if (k > 0) estimate.status = strapdown.step(sample, attitude);
    if (estimate.status.ok()) {
      estimate.status = odometry.step(sample.time_ns, sample.angular_velocity_rad_s, attitude.q_WI, position);
    }
    if (!estimate.status.ok()) return estimate;
    PoseState pose;
    pose.time_ns = sample.time_ns;
    pose.p_WA_m = position.p_WG_m;
    pose.q_WA = attitude.q_WI * q_IB;
    pose.v_WA_m_s = position.v_WG_m_s;
    estimate.poses.push_back(pose);
  }
  return estimate;
}

}  // namespace

Method position_rolling() {
  MethodInfo info;
  info.name = "rolling";
  info.kind = Kind::position;
  info.doc = "Rolling without slip on a level plane: attitude by integration after the gyro's bias at rest, v = r w x n.";
  info.source = "textbook rolling constraint";
  info.parameters = kParameters;
  info.robots = {"sphere"};
  return make_method(std::move(info), run);
}

}  // namespace tumble::scenarios
