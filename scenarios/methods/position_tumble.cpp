// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <memory>

#include "scenarios/methods/imu_check.hpp"
#include "scenarios/methods/position_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/robot_presets.hpp"
#include "scenarios/methods/sample_times.hpp"
#include "scenarios/methods/sphere_attitude.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kCentreSigmaM = 6e-3;
constexpr double kLagS = 1.0;
constexpr double kSpinsM_s = 0.2, kSpinsShare = 0.3;  // excess speed at which a hop counts as slip
constexpr int kRecoveringUnits = 3;                   // number of IMUs that can recover a rate beyond the range
constexpr double kRecoveredSigmaRadS = 1.0;
constexpr double kUnknownRadiusShare = 0.05;  // prior of a radius that a known distance calibrates
// Prior standard deviations for a device without a data sheet, mounted anywhere in the sphere.
constexpr double kUnknownGyroBiasRadS = 5e-3, kUnknownAccelBiasMS2 = 0.4, kUnknownScale = 0.01, kUnknownDelayS = 5e-3,
                 kUnknownLeverArmM = 0.05;
constexpr double kUnknownInclinePerS = 1e-9;  // its accelerometer bias resembles a slope, so the floor is assumed level

/// Returns the library's defaults for the sphere in `models/`. The lever-arm prior is wider than the default, because
/// the lever arm is stated from the centre of mass instead of the sphere's centre.
RollingSmoother::Params defaults(double lag_s = RollingSmoother::kWholeRun) {
  RollingSmoother::Params params;
  params.filter.radius_m = presets::kSphereRadius_m;
  params.filter.lever_arm_sigma_m = kCentreSigmaM;
  params.lag_s = lag_s;
  return params;
}

/// Returns the parameters that the sensors state or that depend on the number of sensors.
std::vector<std::string> stated() {
  return {"radius_m", "gravity_m_s2", "lever_arm_x_m", "lever_arm_y_m", "lever_arm_z_m", "gyro_range_rad_s",
          "accel_range_m_s2", "recovered_rate_sigma_rad_s",
          // the following parameters depend on whether the device is known
          "gyro_bias_sigma_rad_s", "accel_bias_sigma_m_s2", "tilt_sigma_rad", "accel_scale_sigma", "gyro_scale_sigma",
          "accel_delay_sigma_s", "lever_arm_sigma_m", "incline_begins_per_s"};
}

/// Parameters of the live filter, and the threshold for reporting a slip.
struct LiveParams {
  RollingParams filter;
  double slip_claimed_from = 0.5;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.filter);
    visit(p.slip_claimed_from,
          {"slip_claimed_from", "1", 0.0, 1.0,
           "probability of slip or bump, over all hypotheses, from which the more probable one is reported",
           Rank::first});
  }
};

const Settings<LiveParams>& live_settings() {
  static const Settings<LiveParams> all({.filter = defaults().filter}, {.stated = stated()});
  return all;
}

const Settings<RollingSmoother::Params>& lag_settings() {
  static const Settings<RollingSmoother::Params> all = [] {
    std::vector<std::string> names = stated();
    names.emplace_back("rate_max_hz");
    return Settings<RollingSmoother::Params>(defaults(kLagS), {.stated = names, .fixed = {"known_distance_*"}});
  }();
  return all;
}

/// Widens the priors of a device without a data sheet.
void widen_unknown(const sim::Sensors& sensors, RollingParams& params) {
  if (!sensors.imus.front().device.empty()) return;
  params.expert.prior.gyro_bias_sigma_rad_s = std::max(params.expert.prior.gyro_bias_sigma_rad_s, kUnknownGyroBiasRadS);
  params.expert.prior.accel_bias_sigma_m_s2 = std::max(params.expert.prior.accel_bias_sigma_m_s2, kUnknownAccelBiasMS2);
  params.expert.prior.tilt_sigma_rad =
      std::max(params.expert.prior.tilt_sigma_rad, kUnknownAccelBiasMS2 / params.gravity_m_s2);
  params.expert.prior.accel_scale_sigma = std::max(params.expert.prior.accel_scale_sigma, kUnknownScale);
  params.expert.prior.gyro_scale_sigma = std::max(params.expert.prior.gyro_scale_sigma, kUnknownScale);
  params.expert.prior.accel_delay_sigma_s = std::max(params.expert.prior.accel_delay_sigma_s, kUnknownDelayS);
  params.lever_arm_sigma_m = std::max(params.lever_arm_sigma_m, kUnknownLeverArmM);
  params.expert.modes.incline_begins_per_s = std::min(params.expert.modes.incline_begins_per_s, kUnknownInclinePerS);
}

/// Sets the parameters that the sensors state. The lever arm is stated from the centre of mass; the offset from the
/// centre of mass to the sphere's centre is estimated.
void set_stated(const sim::Sensors& sensors, const MergedImus& imus, RollingParams& params) {
  params.radius_m = sensors.sphere_radius_m;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.lever_arm_m = imus.lever_arm_m;
  params.gyro_range_rad_s = imus.gyro_range_rad_s;
  params.accel_range_m_s2 = imus.accel_range_m_s2;
  if (imus.units >= kRecoveringUnits) params.expert.rails.recovered_rate_sigma_rad_s = kRecoveredSigmaRadS;
  widen_unknown(sensors, params);
}

PoseState body_pose(TimeNs time_ns, const Eigen::Quaterniond& q_WB, const Eigen::Vector3d& p_WG_m,
                    const Eigen::Vector3d& v_WG_m_s) {
  PoseState pose;
  pose.time_ns = time_ns;
  pose.p_WA_m = p_WG_m;
  pose.q_WA = q_WB;
  pose.v_WA_m_s = v_WG_m_s;
  return pose;
}

/// Returns true if the sphere rotates faster than it travels. A hop during which the sphere rotates too fast belongs to
/// a slip.
bool spins(double radius_m, const PoseState& pose, const ImuSample& sample) {
  const double rolling_m_s = radius_m * (pose.q_WA * sample.angular_velocity_rad_s).head<2>().norm();
  const double speed_m_s = pose.v_WA_m_s.norm();
  return std::abs(rolling_m_s - speed_m_s) > std::max(kSpinsM_s, kSpinsShare * std::max(rolling_m_s, speed_m_s));
}

sim::ContactLabel contact_label(RollingMode mode, double radius_m, const PoseState& pose, const ImuSample& sample) {
  if (!slips(mode)) return sim::ContactLabel::grip;
  if (mode == RollingMode::bump && !spins(radius_m, pose, sample)) return sim::ContactLabel::air;
  return slip_or_slide(radius_m, pose.q_WA, sample.angular_velocity_rad_s, pose.v_WA_m_s);
}

/// Appends the contact mode of the newest pose.
void add_contact(RollingMode mode, bool at_rest, bool uncertain, double radius_m, const ImuSample& sample,
                 Estimate& estimate) {
  estimate.contacts.push_back(contact_label(mode, radius_m, estimate.poses.back(), sample));
  estimate.uncertain.push_back(uncertain);
  if (uncertain) estimate.health["samples_uncertain"] += 1.0;
  if (mode == RollingMode::slip) estimate.health["samples_slip"] += 1.0;
  if (mode == RollingMode::bump) estimate.health["samples_bump"] += 1.0;
  if (mode == RollingMode::incline) estimate.health["samples_incline"] += 1.0;
  if (mode == RollingMode::rough) estimate.health["samples_rough"] += 1.0;
  if (at_rest) estimate.health["samples_rest"] += 1.0;
}

/// Merges the IMUs of the sphere. Returns false on failure; `estimate.status` then states the reason.
bool merged(const char* method, const sim::Sensors& sensors, MergedImus& imus, Estimate& estimate) {
  estimate.frame = Frame::centre;
  estimate.status = merge_imus(sensors, imus);
  for (const Doubt& unit : imus.out) add_doubt(unit, estimate);
  if (!estimate.status.ok()) return false;
  require_sphere(method, sensors);
  estimate.status = check_imus(sensors, imus, estimate);
  if (!estimate.status.ok()) return false;
  estimate.health["imus"] = imus.units;
  estimate.health["imu_readings_left_out"] = imus.left_out;
  estimate.health["imu_offset_max_s"] = imus.offset_max_s;
  estimate.health["imus_at_other_times"] = imus.resampled;
  if (imus.beyond_range > 0.0) add_doubt({Doubt::About::beyond_range, imus.beyond_range}, estimate);
  for (const MergedImus::Unit& unit : imus.each) {
    estimate.health[unit.name + "_time_offset_s"] = unit.time_offset_s;
    estimate.health[unit.name + "_time_offset_sigma_s"] = unit.time_offset_sigma_s;
    estimate.health[unit.name + "_rate_bias_rad_s"] = unit.rate_bias_rad_s;
  }
  return true;
}

/// Returns the contact mode that the live filter reports over all hypotheses.
RollingMode claimed_mode(const RollingFilter::State& state, double claimed_from) {
  const bool claimed = state.slip_probability >= claimed_from;
  if (claimed == slips(state.mode)) return state.mode;
  if (!claimed) return RollingMode::grip;
  return 2.0 * state.bump_probability > state.slip_probability ? RollingMode::bump : RollingMode::slip;
}

/// Reports problems with the sample times and the start.
void report_samples(const RollingFilter::State& state, Estimate& estimate) {
  if (state.gaps > 0) {
    estimate.health["gaps_bridged"] = static_cast<double>(state.gaps);
    estimate.health["gap_longest_s"] = state.gap_longest_s;
  }
  if (state.started_in_motion) estimate.health["started_in_motion"] = 1.0;
}

Estimate run_live(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  MergedImus imus;
  if (!merged("position/tumble_live", sensors, imus, estimate)) return estimate;
  LiveParams params = live_settings().defaults();
  set_stated(sensors, imus, params.filter);
  live_settings().apply(parameters, params);
  const RollingFilter filter(params.filter);
  // heap allocation, because 430 KiB are too large for a worker's stack
  const auto state = std::make_unique<RollingFilter::State>();
  estimate.poses.reserve(imus.samples.size());
  for (const ImuSample& sample : imus.samples) {
    estimate.status = filter.step(sample, *state);
    if (!estimate.status.ok()) return estimate;
    PoseState pose = body_pose(sample.time_ns, state->q_WI, state->p_WG_m, state->v_WG_m_s);
    pose.covariance.topLeftCorner<3, 3>() = state->position_covariance_m2;
    estimate.poses.push_back(pose);
    add_contact(claimed_mode(*state, params.slip_claimed_from), state->at_rest, state->uncertain,
                params.filter.radius_m, sample, estimate);
  }
  report_samples(*state, estimate);
  return estimate;
}

Estimate run_lag(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  MergedImus imus;
  if (!merged("position/tumble_lag", sensors, imus, estimate)) return estimate;
  RollingSmoother::Params params = lag_settings().defaults();
  const TimeNs period_ns = sensors.imus.front().period_ns;
  if (period_ns > 0) params.rate_max_hz = std::max(params.rate_max_hz, 1.1 / seconds(period_ns));
  set_stated(sensors, imus, params.filter);
  lag_settings().apply(parameters, params);
  smooth(params, imus, {}, estimate);
  return estimate;
}

Estimate run_whole(const sim::Sensors& sensors, const sim::Values& parameters, const OracleInput&) {
  Estimate estimate;
  MergedImus imus;
  if (!merged("position/tumble", sensors, imus, estimate)) return estimate;
  RollingSmoother::Params params = rolling_smoother_params(sensors, imus, position_settings(), parameters);
  if (params.known_distance_m > 0.0 && params.filter.radius_sigma_m == 0.0) {
    params.filter.radius_sigma_m = kUnknownRadiusShare * params.filter.radius_m;
  }
  smooth(params, imus, {}, estimate);
  return estimate;
}

}  // namespace

const Settings<RollingSmoother::Params>& position_settings() {
  static const Settings<RollingSmoother::Params> all(defaults(), {.stated = stated(), .fixed = {"lag_s"}});
  return all;
}

Settings<RollingSmoother::Params> oracle_settings(std::vector<std::string> fixed) {
  fixed.insert(fixed.end(), {"lag_s", "known_distance_*"});
  return Settings<RollingSmoother::Params>(defaults(), {.stated = stated(), .fixed = std::move(fixed)});
}

RollingSmoother::Params rolling_smoother_params(const sim::Sensors& sensors, const MergedImus& imus,
                                                const Settings<RollingSmoother::Params>& settings,
                                                const sim::Values& parameters) {
  RollingSmoother::Params params = settings.defaults();
  set_stated(sensors, imus, params.filter);
  settings.apply(parameters, params);
  return params;
}

void smooth(const RollingSmoother::Params& params, const MergedImus& imus, std::span<const RollingMode> known,
            Estimate& estimate) {
  const RollingSmoother smoother(params);
  const auto state = std::make_unique<RollingSmoother::State>();
  estimate.poses.reserve(imus.samples.size());
  const auto take = [&](const RollingEstimate& e) {  // called once per sample
    const ImuSample& sample = imus.samples[estimate.poses.size()];
    PoseState pose = body_pose(e.time_ns, e.q_WI, e.p_WG_m, e.v_WG_m_s);
    pose.covariance = e.covariance;
    estimate.poses.push_back(pose);
    add_contact(e.mode, e.at_rest, e.uncertain, params.filter.radius_m, sample, estimate);
  };
  std::vector<RollingEstimate> block;
  for (const ImuSample& sample : imus.samples) {
    estimate.status = smoother.step(sample, *state, block);
    if (!estimate.status.ok()) break;
    std::for_each(block.begin(), block.end(), take);
    block.clear();
  }
  if (known.empty()) {
    smoother.finish(*state, take);
  } else {
    smoother.finish(known, *state, take);
  }
  report_samples(state->live, estimate);
  // The lever arm was stated from the centre of mass, so the estimated error of the lever arm gives the position of the
  // sphere's centre.
  estimate.centre_B_m = -state->constants.lever_arm_error_m;
  estimate.health["centre_x_m"] = estimate.centre_B_m.x();
  estimate.health["centre_y_m"] = estimate.centre_B_m.y();
  estimate.health["centre_z_m"] = estimate.centre_B_m.z();
  if (params.filter.radius_sigma_m > 0.0) {
    estimate.health["radius_m"] = params.filter.radius_m + state->constants.radius_error_m;
    estimate.health["radius_sigma_m"] = state->radius_sigma_m;
  }
}

Method position_tumble() {
  MethodInfo info;
  info.name = "tumble";
  info.kind = Kind::position;
  info.doc =
      "Inertial filter with rolling as a velocity measurement and with the hypotheses grip, slip, bump and slope; "
      "smoothed over the whole recording.";
  info.ours = true;
  info.settings = {&position_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), at_sample_times<run_whole>);
}

Method position_tumble_lag() {
  MethodInfo info;
  info.name = "tumble_lag";
  info.kind = Kind::position;
  info.doc = "The method position/tumble with a fixed lag: each pose is smoothed with the data of that lag.";
  info.ours = true;
  info.settings = {&lag_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), at_sample_times<run_lag>);
}

Method position_tumble_live() {
  MethodInfo info;
  info.name = "tumble_live";
  info.kind = Kind::position;
  info.doc = "The method position/tumble live: each pose uses past data only.";
  info.ours = true;
  info.settings = {&live_settings()};
  info.robots = {"sphere"};
  return make_method(std::move(info), at_sample_times<run_live>);
}

}  // namespace tumble::scenarios
