// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/rolling/autogain_fusion.hpp"
#include "scenarios/baselines/rolling/rolling_odometry.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/attitude/detail/strapdown.hpp"

namespace tumble::scenarios {

namespace {

PoseState centre_pose(const sim::Sensors& sensors, TimeNs time_ns, const Eigen::Quaterniond& q_WI,
                      const Eigen::Vector3d& p_WG_m, const Eigen::Vector3d& v_WG_m_s) {
  PoseState pose;
  pose.time_ns = time_ns;
  pose.position_W_m = p_WG_m;
  pose.orientation_W = q_WI * Eigen::Quaterniond(sensors.imus.front().T_BI.linear().transpose());
  pose.velocity_W_m_s = v_WG_m_s;
  return pose;
}

struct RestParams {
  double rest_s = 1.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rest_s, {"rest_s", "s", 0.01, 60.0,
                     "duration of the initial rest; the mean readings during this rest give gyro bias and tilt",
                     ParameterAudience::common_use});
  }
};

ImuSample mean_over_rest(std::span<const ImuSample> samples, double rest_s) {
  ImuSample rest;
  rest.angular_velocity_rad_s = rest.specific_force_m_s2 = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (const ImuSample& sample : samples) {
    if (seconds(sample.time_ns - samples.front().time_ns) > rest_s) break;
    rest.angular_velocity_rad_s += sample.angular_velocity_rad_s;
    rest.specific_force_m_s2 += sample.specific_force_m_s2;
    count += 1.0;
  }
  rest.angular_velocity_rad_s /= count;
  rest.specific_force_m_s2 /= count;
  return rest;
}

const Settings<baselines::RollingOdometry::Params>& position_rolling_settings() {
  static const Settings<baselines::RollingOdometry::Params> all(baselines::RollingOdometry::Params{},
                                                                {.stated = {"radius_m"}});
  return all;
}

/// The first `rest_s` seconds at rest determine gyro bias and tilt; later attitudes come from integrating the gyro.
Estimate run_position_rolling(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  require_sphere("position/rolling", sensors);
  const ImuSample rest = mean_over_rest(samples, default_settings<RestParams>().read(parameters).rest_s);
  const Strapdown strapdown{Strapdown::Params{}};
  Strapdown::State attitude;
  estimate.status = inclination_from_force(rest.specific_force_m_s2, attitude.q_WI);
  if (!estimate.status.ok()) return estimate;
  attitude.started = true;
  attitude.last_time_ns = samples.front().time_ns;
  baselines::RollingOdometry::Params params;
  params.radius_m = sensors.sphere_radius_m;
  position_rolling_settings().apply(parameters, params);
  const baselines::RollingOdometry odometry(params);
  baselines::RollingOdometry::State state;
  estimate.poses.reserve(samples.size());
  for (ImuSample& sample : samples) {
    sample.angular_velocity_rad_s -= rest.angular_velocity_rad_s;
    if (!estimate.poses.empty()) estimate.status = strapdown.step(sample, attitude);
    if (estimate.status.ok())
      estimate.status = odometry.step(sample.time_ns, sample.angular_velocity_rad_s, attitude.q_WI, state);
    if (!estimate.status.ok()) return estimate;
    estimate.poses.push_back(centre_pose(sensors, sample.time_ns, attitude.q_WI, state.p_WG_m, state.v_WG_m_s));
  }
  return estimate;
}

const Settings<baselines::AutogainFusion::Params>& fusion_settings() {
  static const Settings<baselines::AutogainFusion::Params> all(
      baselines::AutogainFusion::Params{}, {.stated = {"radius_m", "gravity_m_s2"},
                                            .fixed = {"autogain_*"},
                                            .beside = default_settings<baselines::Autogain::Params>().rows(),
                                            .prefix = "fusion_"});
  return all;
}

Estimate run_position_autogain_fusion(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  std::vector<ImuSample> samples;
  estimate.status = bridge::primary_imu_samples(sensors, samples);
  if (!estimate.status.ok()) return estimate;
  require_sphere("position/autogain_fusion", sensors);
  baselines::AutogainFusion::Params params;
  params.radius_m = sensors.sphere_radius_m;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  fusion_settings().apply(parameters, params);
  params.autogain = default_settings<baselines::Autogain::Params>().read(parameters);
  const baselines::Autogain autogain(params.autogain);
  const baselines::AutogainFusion fusion(params);
  baselines::Autogain::State attitude;
  baselines::AutogainFusion::State state;
  estimate.poses.reserve(samples.size());
  for (const ImuSample& sample : samples) {
    estimate.status = autogain.step(sample, attitude);
    if (estimate.status.ok()) estimate.status = fusion.step(sample, attitude.q_WI, state);
    if (!estimate.status.ok()) return estimate;
    estimate.poses.push_back(centre_pose(sensors, sample.time_ns, attitude.q_WI, state.p_WG_m, state.v_WG_m_s));
  }
  return estimate;
}

}  // namespace

Method position_rolling() {
  return make_method(
      {.name = "rolling",
       .kind = Kind::position,
       .doc = "Integrates the gyro after subtraction of the bias measured at rest. Computes the velocity of a sphere "
              "that rolls without slip on a level plane: r w x n (r: radius, w: rate, n: plane normal).",
       .source = "textbook rolling constraint",
       .settings = {&default_settings<RestParams>(), &position_rolling_settings()},
       .robots = {"sphere"}},
      run_position_rolling);
}

Method position_autogain_fusion() {
  return make_method(
      {.name = "autogain_fusion",
       .kind = Kind::position,
       .doc = "Averages the rolling velocity and the velocity from integrated acceleration. The integrated velocity is "
              "limited to a multiple of the rolling velocity. The attitude comes from attitude/autogain.",
       .source = "Zevering et al., IMU-based pose-estimation for spherical robots, IEEE MFI 2021, eqs 2-13",
       .settings = {&default_settings<baselines::Autogain::Params>(), &fusion_settings()},
       .robots = {"sphere"}},
      run_position_autogain_fusion);
}

}  // namespace tumble::scenarios
