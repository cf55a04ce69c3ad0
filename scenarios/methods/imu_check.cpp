// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/imu_check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "scenarios/methods/bridge.hpp"
#include "scenarios/recordings/rounded_stamps.hpp"
#include "tumble/angular_velocity/detail/flight_sense.hpp"
#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/attitude/detail/pivot_check.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/attitude/imu_plausibility.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kArmShareMin = 0.5;  // 1: matches the mountings; 0: no relation; -1: flipped sign
// Largest deviation of ImuMerge::arm_share() from 1. A larger deviation indicates a scale error of all IMUs.
// Centripetal force grows with the squared rate, so the limit corresponds to 3 % of gyro scale, three times the data
// sheet's scale error. In runs of `slip` without faults, arm_share() was 0.999 to 1.002.
constexpr double kArmShareOff = 0.06;
// Within these limits, the rotation of gravity confirms the gyro scale. If the force differences still contradict the
// mountings, the cause is a mounting or an accelerometer.
constexpr double kSlopeRight = 0.02, kSlopeAgreed = 0.99;
// Fraction of hand-held samples above which a recording counts as hand-held. Measured fractions are at least 0.91 for
// hand-held motion. For thrown bodies, the fractions are at most 0.25 with correct axes, and mostly below 0.6 with
// wrong axes (hill, throw, twirl, swing, seeds 99101 and 99102).
constexpr double kHeldShare = 0.8;

Status reported(Status status, Estimate& estimate) {
  if (!status.ok()) add_doubt({Doubt::About::readings}, estimate);
  return status;
}

/// Returns true if rates may be in degrees per second, by the criterion of RateReport::rate_unit_suspect.
bool unit_suspect(std::span<const ImuSample> samples) {
  return std::any_of(samples.begin(), samples.end(), [](const ImuSample& sample) {
    return sample.angular_velocity_rad_s.cwiseAbs().maxCoeff() > RateModelParams{}.rate_max_rad_s;
  });
}

double fastest_rad_s(std::span<const ImuSample> samples) {
  double fastest = 0.0;
  for (const ImuSample& sample : samples) fastest = std::max(fastest, sample.angular_velocity_rad_s.norm());
  return fastest;
}

/// Adds a matrix to the covariance of rate `k`.
void inflate_rate(std::size_t k, const Eigen::Matrix3d& by_rad2_s2, Estimate& estimate) {
  estimate.suspect_rad2_s2.resize(estimate.rates.size(), Eigen::Matrix3d::Zero());
  estimate.suspect_rad2_s2[k] += by_rad2_s2;
  estimate.rates[k].covariance_rad2_s2 += by_rad2_s2;
}

RestGravity rest_gravity(const sim::Sensors& sensors) {
  RestGravity::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.accel_range_m_s2 = sensors.imus.front().stated_accel_range_m_s2;
  return RestGravity(params);
}

Status check_rest_force(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate) {
  const RestGravity gravity = rest_gravity(sensors);
  RestGravity::State state;
  for (const ImuSample& sample : samples) gravity.step(sample, {}, state);
  estimate.health["imu_rest_force_share"] = gravity.size_share(state);
  return reported(gravity.size_verdict(state), estimate);
}

/// Calls check_imu(). Sets `gyro_right` to true if the rotation of gravity confirms the gyro scale.
Status check_turning(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate,
                     bool& gyro_right) {
  const Status of_rest = check_rest_force(sensors, samples, estimate);
  if (unit_suspect(samples)) add_doubt({Doubt::About::rate_unit}, estimate);
  if (are_rounded(sensors.imus.front().time_ns)) add_doubt({Doubt::About::stamps, 1e-3}, estimate);
  ImuPlausibility::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  // The merged IMUs of a sphere report rates beyond the range of one IMU.
  const double range_rad_s = sensors.imus.front().stated_gyro_range_rad_s;
  if (sensors.sphere_radius_m <= 0.0 && range_rad_s > 0.0) params.gyro_range_rad_s = unsaturated_range(range_rad_s);
  const ImuPlausibility plausibility(params);
  ImuPlausibility::State state;
  for (const ImuSample& sample : samples) plausibility.step(sample, state);
  estimate.health["imu_force_share"] = plausibility.force_share(state);
  estimate.health["imu_rotation_unexplained"] = plausibility.unexplained_share(state);
  estimate.health["imu_rotation_slope"] = plausibility.rotation_slope(state);
  estimate.health["imu_rotation_agreement"] = plausibility.rotation_agreement(state);
  gyro_right = std::abs(plausibility.rotation_slope(state) - 1.0) < kSlopeRight &&
               plausibility.rotation_agreement(state) > kSlopeAgreed;
  if (plausibility.frozen_s(state) > 0.0) estimate.health["imu_frozen_s"] = plausibility.frozen_s(state);
  if (const auto labels = plausibility.better_axis_labels(state)) {
    constexpr const char* kKeys[] = {"imu_accel_x_is", "imu_accel_y_is", "imu_accel_z_is"};
    for (std::size_t j = 0; j < 3; ++j) estimate.health[kKeys[labels->axis[j]]] = labels->sign[j] * (1.0 + double(j));
    if (labels->gyro_flipped) estimate.health["imu_gyro_flipped"] = 1.0;
  }
  const Status said = reported(plausibility.verdict(state), estimate);
  return said.ok() ? of_rest : said;
}

}  // namespace

Status check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate) {
  bool gyro_right = false;
  return check_turning(sensors, samples, estimate, gyro_right);
}

Status check_imus(const sim::Sensors& sensors, const MergedImus& imus, Estimate& estimate) {
  bool gyros_right = false;
  const MergedRecordings& merged = imus.merged;
  const Status own = check_turning(sensors, merged.samples, estimate, gyros_right);
  if (merged.other_sense) {
    estimate.health["imu_other_axes_share"] = merged.other_sense->share;
    add_doubt({Doubt::About::readings}, estimate);
  }
  if (!merged.arm_share) return own;
  estimate.health["imu_arm_share"] = *merged.arm_share;
  if (std::abs(*merged.arm_share - 1.0) > kArmShareOff && !gyros_right) add_doubt({Doubt::About::readings}, estimate);
  if (!own.ok() || *merged.arm_share >= kArmShareMin) return own;
  return reported(
      {Trouble::out_of_range,
       "difference between the forces of the IMUs, relative to the value predicted from rotation and lever arms",
       *merged.arm_share, kArmShareMin},
      estimate);
}

Status check_flights(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     std::optional<double> carried_share, Estimate& estimate) {
  if (sensors.sphere_radius_m > 0.0) return {};
  FlightSense::Params params;
  params.lever_arm_m = bridge::lever_arm_I_m(sensors.imus.front());
  params.gyro_range_rad_s = sensors.imus.front().stated_gyro_range_rad_s;
  const bool thrown = carried_share && *carried_share < kHeldShare;
  params.body = thrown ? FlightSense::Body::thrown : FlightSense::Body::may_be_hand_held;
  const FlightSense sense(params);
  FlightSense::State state;
  for (const ImuSample& sample : samples) sense.step(sample, state);
  const Status status = reported(sense.verdict(state), estimate);
  if (!status.ok()) add_doubt({Doubt::About::flights, status.value}, estimate);
  return status;
}

Status check_rotation_between_rests(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                    std::span<const RateState> rates, Estimate& estimate) {
  const RestGravity gravity = rest_gravity(sensors);
  RestGravity::State state;
  for (std::size_t k = 0; k < std::min(samples.size(), rates.size()); ++k) gravity.step(samples[k], rates[k], state);
  estimate.health["rest_gravity_missed_rad"] = state.miss_rad;
  estimate.health["rest_gravity_missed_sigma_rad"] = state.miss_sigma_rad;
  estimate.health["rest_velocity_share"] = state.velocity_share;
  estimate.health["rest_velocity_allowed_share"] = state.velocity_allowed_share;
  return reported(gravity.verdict(state), estimate);
}

Status check_rotation_about_pivots(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                   std::span<const RateState> rates, Estimate& estimate) {
  PivotCheck::Params params;
  params.gravity_m_s2 = sensors.gravity_m_s2;
  params.accel_range_m_s2 = sensors.imus.front().stated_accel_range_m_s2;
  const PivotCheck pivots(params);
  const PivotCheck::Found found = pivots.find(samples, rates);
  estimate.health["pivot_evidence"] = found.evidence;
  estimate.health["pivot_segments"] = static_cast<double>(found.counted);
  if (std::isfinite(found.scale_sigma)) {
    estimate.health["pivot_scale"] = found.scale;
    estimate.health["pivot_scale_sigma"] = found.scale_sigma;
  }
  return reported(pivots.verdict(found), estimate);
}

bool check_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples, std::optional<double> carried_share,
                 Estimate& estimate) {
  const Status of_flights = check_flights(sensors, samples, carried_share, estimate);
  const Status of_readings = check_imu(sensors, samples, estimate);
  const Status of_rates = check_rotation_between_rests(sensors, samples, estimate.rates, estimate);
  const Status of_pivots = check_rotation_about_pivots(sensors, samples, estimate.rates, estimate);
  return of_flights.ok() && of_readings.ok() && of_rates.ok() && of_pivots.ok();
}

void inflate_rates(Estimate& estimate) {
  for (std::size_t k = 0; k < estimate.rates.size(); ++k)
    inflate_rate(k, estimate.rates[k].w_WI_I_rad_s.squaredNorm() * Eigen::Matrix3d::Identity(), estimate);
  add_doubt({Doubt::About::rates}, estimate);
}

std::vector<FrozenAxis> report_frozen_axes(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                           Estimate& estimate) {
  std::vector<FrozenAxis> all = find_frozen_axes(sensors.imus.front(), samples);
  for (const FrozenAxis& frozen : all) {
    const Doubt doubt{Doubt::About::unit_frozen, seconds(frozen.from_ns - samples.front().time_ns),
                      sensors.imus.front().name + "_" + to_string(frozen)};
    if (!has_doubt(doubt, estimate)) add_doubt(doubt, estimate);  // keep the earliest time
    add_doubt({Doubt::About::readings}, estimate);
  }
  return all;
}

void inflate_frozen_rates(std::span<const FrozenAxis> frozen, std::span<const ImuSample> samples, Estimate& estimate) {
  const double sigma_rad_s = fastest_rad_s(samples);
  for (const FrozenAxis& axis : frozen) {
    if (axis.triad != Triad::gyro) continue;
    Eigen::Matrix3d by_rad2_s2 = Eigen::Matrix3d::Zero();
    by_rad2_s2(axis.axis, axis.axis) = sigma_rad_s * sigma_rad_s;
    for (std::size_t k = 0; k < estimate.rates.size(); ++k) {
      const TimeNs time_ns = estimate.rates[k].time_ns;
      if (time_ns >= axis.from_ns && time_ns <= axis.to_ns) inflate_rate(k, by_rad2_s2, estimate);
    }
  }
}

}  // namespace tumble::scenarios
