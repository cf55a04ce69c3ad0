// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>

#include "scenarios/errors.hpp"
#include "scenarios/methods/position_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/sphere_attitude.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::int64_t kEdgeNs = 400'000'000;
constexpr double kLevelTiltRad = 0.005;  // smaller tilts of the floor count as level

bool prepare(const char* method, const sim::Sensors& sensors, MergedImus& imus, Estimate& estimate) {
  estimate.frame = Frame::centre;
  estimate.status = merge_imus(sensors, imus);
  if (!estimate.status.ok()) return false;
  require_sphere(method, sensors);
  return true;
}

std::size_t physics_index(const sim::Truth& truth, std::int64_t time_ns, std::size_t count) {
  return std::min(static_cast<std::size_t>(std::max<std::int64_t>(time_ns, 0) / truth.period_ns), count - 1);
}

/// Omits parameters that are not needed because the attitude is exact.
const Settings<RollingSmoother::Params>& settings_with_attitude() {
  static const Settings<RollingSmoother::Params> all =
      oracle_settings({"gyro_range_rad_s", "tilt_sigma_rad", "gyro_bias_sigma_rad_s", "gyro_scale_sigma",
                       "attitude_walk_rad_sqrts", "rate_error_sqrts", "gyro_bias_walk_rad_s_sqrts"});
  return all;
}

const Settings<RollingSmoother::Params>& settings_with_contact() {
  static const Settings<RollingSmoother::Params> all = oracle_settings({});
  return all;
}

Estimate run_exact_attitude(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  Estimate estimate;
  MergedImus imus;
  if (!prepare("position/oracle", sensors, imus, estimate)) return estimate;
  const sim::Truth& truth = *oracle.truth;
  const std::vector<std::int64_t>& times_ns = sensors.imus.front().time_ns;
  if (truth.imus.empty() || truth.imus.front().rate_rad_s.size() != times_ns.size() || truth.q_WB.empty()) {
    throw BadInput("the truth does not belong to this recording: it has no rates of the primary IMU");
  }
  const Eigen::Matrix3d R_BI = truth.imus.front().T_BI.linear();
  std::size_t next = 0;
  for (ImuSample& sample : imus.samples) {  // average over readings of the primary IMU
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    const std::size_t first = next;
    while (next < times_ns.size() && times_ns[next] <= sample.time_ns) sum += truth.imus.front().rate_rad_s[next++];
    if (next > first) sample.angular_velocity_rad_s = R_BI * (sum / static_cast<double>(next - first));
  }
  RollingSmoother::Params params = rolling_smoother_params(sensors, imus, settings_with_attitude(), parameters);
  params.filter.q_WI_start =
      truth.q_WB[physics_index(truth, imus.samples.front().time_ns, truth.q_WB.size())].normalized();
  params.filter.gyro_range_rad_s = 1e3;
  params.filter.expert.prior.tilt_sigma_rad = 0.0;
  params.filter.expert.prior.gyro_bias_sigma_rad_s = 0.0;
  params.filter.expert.prior.gyro_scale_sigma = 0.0;
  params.filter.expert.noise.attitude_walk_rad_sqrts = 1e-9;
  params.filter.expert.noise.rate_error_sqrts = 1e-9;
  params.filter.expert.noise.gyro_bias_walk_rad_s_sqrts = 1e-9;
  smooth(params, imus, {}, estimate);
  return estimate;
}

/// Changes short intervals of `incline` to bumps, because an edge tilts the contact normal only briefly.
void edges_are_bumps(std::int64_t period_ns, std::vector<RollingMode>& modes) {
  for (std::size_t begin = 0; begin < modes.size();) {
    std::size_t end = begin;
    while (end < modes.size() && modes[end] == RollingMode::incline) ++end;
    if (static_cast<std::int64_t>(end - begin) * period_ns < kEdgeNs) {
      std::fill(modes.begin() + static_cast<std::ptrdiff_t>(begin), modes.begin() + static_cast<std::ptrdiff_t>(end),
                RollingMode::bump);
    }
    begin = std::max(end, begin + 1);
  }
}

/// Returns the mode of each sample from the contact labels and contact normals of the truth.
std::vector<RollingMode> true_modes(const sim::Truth& truth, const std::vector<ImuSample>& samples) {
  std::vector<RollingMode> at_step(truth.label.size(), RollingMode::grip);
  for (const sim::ContactTruth& contact : truth.contacts) {
    if (contact.normal_W.z() < std::cos(kLevelTiltRad)) {
      at_step[physics_index(truth, contact.time_ns, at_step.size())] = RollingMode::incline;
    }
  }
  for (std::size_t k = 0; k < at_step.size(); ++k) {
    if (truth.label[k] == sim::ContactLabel::air) at_step[k] = RollingMode::bump;
    if (truth.label[k] == sim::ContactLabel::slip || truth.label[k] == sim::ContactLabel::slide) {
      at_step[k] = RollingMode::slip;
    }
  }
  edges_are_bumps(truth.period_ns, at_step);
  std::vector<RollingMode> modes;
  modes.reserve(samples.size());
  for (const ImuSample& sample : samples)
    modes.push_back(at_step[physics_index(truth, sample.time_ns, at_step.size())]);
  return modes;
}

Estimate run_exact_contact(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput& oracle) {
  Estimate estimate;
  MergedImus imus;
  if (!prepare("position/oracle_contact", sensors, imus, estimate)) return estimate;
  if (oracle.truth->label.empty()) throw BadInput("the truth has no contact states");
  RollingSmoother::Params params = rolling_smoother_params(sensors, imus, settings_with_contact(), parameters);
  smooth(params, imus, true_modes(*oracle.truth, imus.samples), estimate);
  return estimate;
}

}  // namespace

Method position_oracle() {
  MethodInfo info;
  info.name = "oracle";
  info.kind = Kind::position;
  info.doc =
      "Bound: our smoother with the exact attitude at all times; shows the error of the other sensors and of the "
      "contact.";
  info.ours = true;
  info.settings = {&settings_with_attitude()};
  info.needs_truth = true;
  info.robots = {"sphere"};
  return make_method(std::move(info), at_sample_times<run_exact_attitude>);
}

Method position_oracle_contact() {
  MethodInfo info;
  info.name = "oracle_contact";
  info.kind = Kind::position;
  info.doc =
      "Bound: our smoother with the true contact state (grip, slip or none) at all times; shows the error of the "
      "sensors.";
  info.ours = true;
  info.settings = {&settings_with_contact()};
  info.needs_truth = true;
  info.robots = {"sphere"};
  return make_method(std::move(info), at_sample_times<run_exact_contact>);
}

}  // namespace tumble::scenarios
