// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>
#include <string>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/methods/position_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "tumble/odometry/detail/merge_recordings.hpp"
#include "tumble/odometry/rolling_expert_params.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble::scenarios {

namespace {

struct Prepared {
  std::vector<ImuSample> samples;
  RollingSmoother::Params params;
};

bool prepare(const sim::Sensors& sensors, Prepared& out, Estimate& estimate) {
  estimate.frame = Frame::centre;
  SphereImus units;
  MergedImus imus;
  estimate.status = sphere_imus(sensors, units);
  if (estimate.status.ok()) estimate.status = merge_imus(sensors, imus);
  if (!estimate.status.ok()) return false;
  require_sphere("position/oracle", sensors);
  RollingOdometry::Params params;
  params.lag_s = RollingOdometry::kWholeRecording;
  out.params = rolling_smoother_params(stated_params(sensors, units, params), imus.merged);
  out.samples = std::move(imus.merged.samples);
  return true;
}

Settings<RollingSmoother::Params> oracle_settings(std::vector<std::string> fixed) {
  RollingSmoother::Params params;
  params.filter.radius_m = presets::kSphereRadius_m;
  fixed.insert(fixed.end(), {"lag_s", "rate_max_hz", "known_distance_*"});
  return Settings<RollingSmoother::Params>(
      params, {.stated = {"radius_m", "gravity_m_s2", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m",
                          "gyro_range_rad_s", "accel_range_m_s2", "recovered_rate_sigma_rad_s", "gyro_bias_sigma_rad_s",
                          "accel_bias_sigma_m_s2", "tilt_sigma_rad", "accel_scale_sigma", "gyro_scale_sigma",
                          "accel_delay_sigma_s", "lever_arm_sigma_m", "incline_begins_per_s"},
               .fixed = std::move(fixed)});
}

void smooth(const Prepared& prepared, Estimate& estimate) {
  const RollingSmoother smoother(prepared.params);
  const auto state = std::make_unique<RollingSmoother::State>();
  std::vector<RollingEstimate> done;
  for (const ImuSample& sample : prepared.samples) {
    estimate.status = smoother.step(sample, *state, done);
    if (!estimate.status.ok()) return;
  }
  const auto take = [&](const RollingEstimate& e) {
    append_pose({.pose = {e.time_ns, e.sphere_centre_W_m, e.q_WI, e.sphere_velocity_W_m_s, e.covariance},
                 .angular_velocity_rad_s = e.w_WI_I_rad_s,
                 .mode = e.mode,
                 .at_rest = e.at_rest,
                 .uncertain = e.uncertain},
                prepared.params.filter.radius_m, estimate);
  };
  std::for_each(done.begin(), done.end(), take);
  smoother.finish(*state, take);
  estimate.centre_B_m = -state->constants.lever_arm_error_m;
}

std::size_t physics_index(const sim::Truth& truth, std::int64_t time_ns, std::size_t count) {
  return std::min(static_cast<std::size_t>(std::max<std::int64_t>(time_ns, 0) / truth.period_ns), count - 1);
}

const Settings<RollingSmoother::Params>& settings_with_attitude() {
  static const Settings<RollingSmoother::Params> all =
      oracle_settings({"gyro_range_rad_s", "tilt_sigma_rad", "gyro_bias_sigma_rad_s", "gyro_scale_sigma",
                       "attitude_walk_rad_sqrts", "rate_error_sqrts", "gyro_bias_walk_rad_s_sqrts"});
  return all;
}

Estimate run_exact_attitude(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  Estimate estimate;
  Prepared imus;
  if (!prepare(sensors, imus, estimate)) return estimate;
  const sim::Truth& truth = *oracle.truth;
  const std::vector<std::int64_t>& times_ns = sensors.imus.front().time_ns;
  if (truth.imus.empty() || truth.imus.front().rate_rad_s.size() != times_ns.size() || truth.q_WB.empty()) {
    throw BadInput("the truth lacks rates for all samples of the primary IMU, so it does not belong to this recording");
  }
  const Eigen::Matrix3d R_BI = truth.imus.front().T_BI.linear();
  std::size_t next = 0;
  for (ImuSample& sample : imus.samples) {  // mean of the primary IMU's readings
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::size_t first = next;
    while (next < times_ns.size() && times_ns[next] <= sample.time_ns) sum += truth.imus.front().rate_rad_s[next++];
    if (next > first) sample.angular_velocity_rad_s = R_BI * (sum / static_cast<double>(next - first));
  }
  RollingSmoother::Params& params = imus.params;
  settings_with_attitude().apply(parameters, params);
  params.filter.q_WI_start =
      truth.q_WB[physics_index(truth, imus.samples.front().time_ns, truth.q_WB.size())].normalized();
  params.filter.gyro_range_rad_s = 1e3;
  params.filter.expert.prior.tilt_sigma_rad = 0.0;
  params.filter.expert.prior.gyro_bias_sigma_rad_s = 0.0;
  params.filter.expert.prior.gyro_scale_sigma = 0.0;
  params.filter.expert.noise.attitude_walk_rad_sqrts = 1e-9;
  params.filter.expert.noise.rate_error_sqrts = 1e-9;
  params.filter.expert.noise.gyro_bias_walk_rad_s_sqrts = 1e-9;
  smooth(imus, estimate);
  return estimate;
}

}  // namespace

Method position_oracle() {
  return make_method({.name = "oracle",
                      .kind = Kind::position,
                      .doc = "Gives an upper bound of the accuracy: our smoother receives the true attitude. Errors of "
                             "the accelerometer and "
                             "of the contact state remain.",
                      .ours = true,
                      .settings = {&settings_with_attitude()},
                      .needs_truth = true,
                      .robots = {"sphere"}},
                     at_sample_times<run_exact_attitude>);
}

}  // namespace tumble::scenarios
