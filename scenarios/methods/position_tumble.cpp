// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"
#include "tumble/odometry/expert_params.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kRollingLagS = 1.0;
constexpr TimeNs kHealthPeriodNs = 100'000'000;       // time between two calls of health()
constexpr double kSpinsM_s = 0.2, kSpinsShare = 0.3;  // speed differences of a slip

Settings<RollingOdometry::Params> rolling_settings(double lag_s, std::vector<std::string> fixed) {
  RollingOdometry::Params params;
  params.radius_m = presets::kSphereRadius_m;
  params.lag_s = lag_s;
  fixed.insert(fixed.end(),
               {"rolling_radius_m", "rolling_gravity_m_s2", "rolling_lever_arm_*", "rolling_gyro_range_rad_s",
                "rolling_accel_range_m_s2", "rolling_lag_s", "rolling_rate_max_hz"});
  return Settings<RollingOdometry::Params>(
      params, {.stated = {"radius_m", "gravity_m_s2", "centre_sigma_m", "rolling_gyro_bias_sigma_rad_s",
                          "rolling_accel_bias_sigma_m_s2", "rolling_tilt_sigma_rad", "rolling_accel_scale_sigma",
                          "rolling_gyro_scale_sigma", "rolling_accel_delay_sigma_s", "rolling_incline_begins_per_s"},
               .fixed = std::move(fixed)});
}

const Settings<RollingOdometry::Params>& rolling_whole_settings() {
  static const auto all = rolling_settings(RollingOdometry::kWholeRecording, {"lag_s"});
  return all;
}

const Settings<RollingOdometry::Params>& rolling_lag_settings() {
  static const auto all = rolling_settings(kRollingLagS, {});
  return all;
}

const Settings<RollingOdometry::Params>& rolling_live_settings() {
  static const auto all = rolling_settings(0.0, {"lag_s"});
  return all;
}

/// During a short flight, a sphere counts as slipping if the rolling speed and the speed of the centre differ.
bool spins(double radius_m, const RollingOdometry::Pose& pose) {
  const double rolling_m_s = radius_m * (pose.pose.orientation_W * pose.angular_velocity_B_rad_s).head<2>().norm();
  const double speed_m_s = pose.pose.velocity_W_m_s.norm();
  return std::abs(rolling_m_s - speed_m_s) > std::max(kSpinsM_s, kSpinsShare * std::max(rolling_m_s, speed_m_s));
}

sim::ContactLabel slip_or_slide(double radius_m, const RollingOdometry::Pose& pose) {
  const Eigen::Vector3d rolling_m_s =
      radius_m * (pose.pose.orientation_W * pose.angular_velocity_B_rad_s).cross(Eigen::Vector3d::UnitZ());
  return rolling_m_s.norm() > pose.pose.velocity_W_m_s.head<2>().norm() ? sim::ContactLabel::slip
                                                                        : sim::ContactLabel::slide;
}

sim::ContactLabel contact_label(double radius_m, const RollingOdometry::Pose& pose) {
  if (!may_slip(pose.contact_mode)) return sim::ContactLabel::grip;
  if (pose.contact_mode == ContactMode::bump_or_flight && !spins(radius_m, pose)) return sim::ContactLabel::air;
  return slip_or_slide(radius_m, pose);
}

RollingOdometry::Params stated_params(const sim::Sensors& sensors, const SphereImus& units,
                                      RollingOdometry::Params params) {
  params.radius_m = sensors.sphere_radius_m;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  for (const ImuRecording& unit : units.recordings) params.imus.push_back({unit.data_sheet, unit.T_BI});
  if (sensors.imus.front().device.empty()) params.widen_priors_for_unknown_imus();
  return params;
}

void append_pose(const RollingOdometry::Pose& pose, double radius_m, Estimate& estimate) {
  estimate.poses.push_back(pose.pose);
  estimate.contacts.push_back(contact_label(radius_m, pose));
  estimate.uncertain.push_back(pose.position_uncertain);
  const auto count = [&](const char* key, bool counts) {
    if (counts) estimate.health[key] += 1.0;
  };
  count("samples_uncertain", pose.position_uncertain);
  count("samples_slip", pose.contact_mode == ContactMode::slip);
  count("samples_bump", pose.contact_mode == ContactMode::bump_or_flight);
  count("samples_incline", pose.contact_mode == ContactMode::incline);
  count("samples_rough", pose.contact_mode == ContactMode::rough);
  count("samples_rest", pose.at_rest);
}

void report_lever_arm(const MergedImuRecording& whole, Estimate& estimate) {
  if (whole.recordings.lever_arm_agreement)
    estimate.health["lever_arm_agreement"] = *whole.recordings.lever_arm_agreement;
}

/// Returns the samples of each IMU. An IMU that bridge::imu_samples() rejects delivers only its usable samples.
std::vector<bridge::DeliveredSamples> delivered_samples(const sim::Sensors& sensors, const SphereImus& units) {
  std::vector<bridge::DeliveredSamples> out;
  for (std::size_t k = 0; k < units.names.size(); ++k) {
    const auto record = std::ranges::find(sensors.imus, units.names[k], &sim::ImuRecord::name);
    bridge::DeliveredSamples& unit = out.emplace_back();
    if (bridge::delivered_samples(*record, unit).ok()) continue;
    unit = {.samples = units.recordings[k].samples, .arrival_ns = {}};
    for (const ImuSample& sample : unit.samples) unit.arrival_ns.push_back(sample.time_ns);
  }
  return out;
}

Status replay_imus(const std::vector<bridge::DeliveredSamples>& units, RollingOdometry& odometry, double radius_m,
                   std::span<const std::string> names, Estimate& estimate) {
  TimeNs checked_ns = 0;
  SensorHealth found;
  const auto collect = [&] {
    while (const std::optional<RollingOdometry::Pose> pose = odometry.take()) append_pose(*pose, radius_m, estimate);
    if (estimate.poses.empty() || estimate.poses.back().time_ns < checked_ns + kHealthPeriodNs) return;
    checked_ns = estimate.poses.back().time_ns;
    found.add_current_and_end_others(odometry.health());
  };
  std::vector<std::size_t> next(units.size(), 0);
  while (true) {
    std::optional<std::size_t> first;  // index of the IMU whose next sample arrives first
    TimeNs first_ns = std::numeric_limits<TimeNs>::max();
    for (std::size_t k = 0; k < units.size(); ++k) {
      if (next[k] == units[k].samples.size() || units[k].arrival_ns[next[k]] >= first_ns) continue;
      first = k;
      first_ns = units[k].arrival_ns[next[k]];
    }
    if (!first) break;
    // The estimator rejects the first sample after a gap until a second sample confirms the time stamp, so the error
    // `gap` is ignored here.
    const Status status = odometry.add_imu(*first, units[*first].samples[next[*first]++]);
    if (!status.ok() && status.error_code != ErrorCode::gap) estimate.health["rejected_readings"] += 1.0;
    collect();
  }
  const Status status = odometry.finish();
  collect();
  found.add_current_and_end_others(odometry.health());
  add_findings(found, names, estimate);
  return status;
}

void report_counters(const RollingOdometry& odometry, const RollingOdometry::Params& params, Estimate& estimate) {
  if (odometry.restart_count() > 0) estimate.health["gaps"] = static_cast<double>(odometry.restart_count());
  if (odometry.rejected_readings() > 0)
    estimate.health["rejected_readings"] += static_cast<double>(odometry.rejected_readings());
  if (params.lag_s > 0.0) estimate.centre_B_m = odometry.sphere_calibration().sphere_centre_B_m;
}

Estimate roll_along(const char* method, const Settings<RollingOdometry::Params>& settings, const sim::Sensors& sensors,
                    const sim::Values& parameters) {
  Estimate estimate;
  estimate.frame = Frame::centre;
  require_sphere(method, sensors);
  SphereImus units;
  estimate.status = sphere_imus(sensors, units);
  if (!estimate.status.ok()) return estimate;
  RollingOdometry::Params params = stated_params(sensors, units, settings.defaults());
  settings.apply(parameters, params);
  RollingOdometry odometry(params);
  estimate.status = replay_imus(delivered_samples(sensors, units), odometry, params.radius_m, units.names, estimate);
  estimate.health["imus"] = static_cast<double>(params.imus.size());
  if (odometry.whole_recording_result() != nullptr) report_lever_arm(*odometry.whole_recording_result(), estimate);
  report_beyond_range(units.beyond_range, estimate);
  report_counters(odometry, params, estimate);
  return estimate;
}

Estimate roll_whole(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return roll_along("position/tumble", rolling_whole_settings(), sensors, parameters);
}

Estimate roll_lag(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return roll_along("position/tumble_lag", rolling_lag_settings(), sensors, parameters);
}

Estimate roll_live(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  return roll_along("position/tumble_live", rolling_live_settings(), sensors, parameters);
}

Method position_method(std::string name, std::string doc, const Settings<RollingOdometry::Params>& settings,
                       RunCore run) {
  return make_method({.name = std::move(name),
                      .kind = Kind::position,
                      .doc = std::move(doc),
                      .ours = true,
                      .settings = {&settings},
                      .robots = {"sphere"}},
                     run);
}

}  // namespace

Method position_tumble() {
  return position_method("tumble",
                         "Runs RollingOdometry (public API) on the whole recording. This inertial smoother uses "
                         "rolling as a velocity measurement and distinguishes grip, slip, bumps and slopes.",
                         rolling_whole_settings(), roll_whole);
}

Method position_tumble_lag() {
  return position_method(
      "tumble_lag",
      "Runs RollingOdometry with a fixed lag: each pose also uses the data of the following lag_s seconds.",
      rolling_lag_settings(), roll_lag);
}

Method position_tumble_live() {
  return position_method("tumble_live", "Runs RollingOdometry live: each pose uses only past data.",
                         rolling_live_settings(), roll_live);
}

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
  fixed.insert(fixed.end(), {"lag_s", "rate_max_hz"});
  return Settings<RollingSmoother::Params>(
      params, {.stated = {"radius_m", "gravity_m_s2", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m",
                          "gyro_range_rad_s", "accel_range_m_s2", "gyro_bias_sigma_rad_s", "accel_bias_sigma_m_s2",
                          "tilt_sigma_rad", "accel_scale_sigma", "gyro_scale_sigma", "accel_delay_sigma_s",
                          "lever_arm_sigma_m", "incline_begins_per_s"},
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
                 .angular_velocity_B_rad_s = e.w_WI_I_rad_s,
                 .contact_mode = e.mode,
                 .at_rest = e.at_rest,
                 .position_uncertain = e.position_uncertain},
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
                      .doc = "Gives an upper bound of the accuracy: the smoother of position/tumble receives the true "
                             "attitude. Errors of the accelerometer and of the contact state remain.",
                      .ours = true,
                      .settings = {&settings_with_attitude()},
                      .needs_truth = true,
                      .robots = {"sphere"}},
                     at_sample_times<run_exact_attitude>);
}

}  // namespace tumble::scenarios
