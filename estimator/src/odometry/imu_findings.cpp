// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/imu_findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tumble/angular_velocity/detail/flight_sign_check.hpp"
#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/attitude/imu_merge.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble {

namespace {

using Kind = HealthFinding::Kind;

constexpr const char* kImu = "imu";
constexpr double kSlopeTolerance = 0.02, kSlopeAgreementMin = 0.99;
// A recording counts as hand-held if at least this fraction of its samples is classified as hand-held. The fraction was
// at least 0.91 for hand-held motion. For thrown bodies, it was at most 0.25 with correct axes, and mostly below 0.6
// with wrong axes.
constexpr double kRepeatedFraction = 0.8;

double largest_rate_rad_s(std::span<const ImuSample> samples) {
  double largest = 0.0;
  for (const ImuSample& sample : samples)
    largest = std::max(largest, sample.angular_velocity_rad_s.cwiseAbs().maxCoeff());
  return largest;
}

double rate_max_so_far_rad_s(std::span<const ImuSample> samples) {
  double fastest = 0.0;
  for (const ImuSample& sample : samples) fastest = std::max(fastest, sample.angular_velocity_rad_s.norm());
  return fastest;
}

RestGravity rest_gravity(const CheckedImu& imu) {
  RestGravity::Params params;
  params.gravity_m_s2 = imu.gravity_m_s2;
  params.accel_range_m_s2 = imu.accel_range_m_s2;
  return RestGravity(params);
}

/// Returns an error if the specific forces seem to be in g instead of m/s^2 (RateReport::force_unit_suspect).
Status force_unit(std::span<const ImuSample> samples) {
  constexpr double kLeast_m_s2 = 0.5, kMost_m_s2 = 2.0;
  std::vector<double> forces;
  for (const ImuSample& sample : samples) forces.push_back(sample.specific_force_m_s2.norm());
  if (forces.empty()) return {};
  const auto middle = forces.begin() + static_cast<std::ptrdiff_t>(forces.size() / 2);
  std::nth_element(forces.begin(), middle, forces.end());
  if (!(*middle > kLeast_m_s2 && *middle < kMost_m_s2)) return {};
  return {ErrorCode::out_of_range, "median of the specific force in m/s^2", *middle, kMost_m_s2};
}

/// Returns the kind of the finding that ImuPlausibility::verdict() reports.
Kind kind_of(const ImuPlausibility& plausibility, const ImuPlausibility::State& state, const Status& verdict) {
  if (verdict.value == plausibility.force_ratio(state)) return Kind::force_at_rest;
  if (plausibility.frozen_s(state) > 0.0) return Kind::frozen_sensor;
  return plausibility.better_axis_labels(state) ? Kind::axes_or_signs : Kind::rotation;
}

/// Returns an error if the rates seem to be in degrees per second instead of rad/s (RateReport::rate_unit_suspect).
Status rate_unit(std::span<const ImuSample> samples) {
  const double largest = largest_rate_rad_s(samples), most = RateModelParams{}.rate_max_rad_s;
  return largest > most ? Status{ErrorCode::out_of_range, "angular_velocity_rad_s", largest, most} : Status{};
}

}  // namespace

ImuPlausibility::Params plausibility_params(double gravity_m_s2, double gyro_range_rad_s) {
  ImuPlausibility::Params params;
  params.gravity_m_s2 = std::max(gravity_m_s2, 1e-3);
  if (gyro_range_rad_s > 0.0) params.gyro_range_rad_s = unsaturated_range(gyro_range_rad_s);
  return params;
}

void add_findings(const ImuPlausibility& plausibility, const ImuPlausibility::State& state, const std::string& sensor,
                  SensorHealth& health) {
  const Status verdict = plausibility.verdict(state);
  const Kind kind = kind_of(plausibility, state, verdict);
  health.add(kind, verdict, sensor, "", {}, kind == Kind::force_at_rest ? 1.0 : 0.0);
}

bool confirms_gyro(const ImuPlausibility& plausibility, const ImuPlausibility::State& state) {
  return std::abs(plausibility.rotation_slope(state) - 1.0) < kSlopeTolerance &&
         plausibility.rotation_agreement(state) > kSlopeAgreementMin;
}

void ImuFindings::add(const ImuFindings& other) {
  health.add(other.health);
  frozen_axes.insert(frozen_axes.end(), other.frozen_axes.begin(), other.frozen_axes.end());
  if (other.readings) readings = other.readings;
  if (other.rests) rests = other.rests;
  if (other.pivots) pivots = other.pivots;
}

ImuFindings check_readings(const CheckedImu& imu, std::span<const ImuSample> samples) {
  const RestGravity gravity = rest_gravity(imu);
  RestGravity::State at_rest;
  const ImuPlausibility plausibility(plausibility_params(imu.gravity_m_s2, imu.merged ? 0.0 : imu.gyro_range_rad_s));
  ImuPlausibility::State state;
  for (const ImuSample& sample : samples) {
    gravity.step(sample, {}, at_rest);
    plausibility.step(sample, state);
  }
  ImuFindings out;
  out.readings = {gravity.magnitude_error_ratio(at_rest),         plausibility.force_ratio(state),
                  plausibility.unexplained_rotation_ratio(state), plausibility.rotation_slope(state),
                  plausibility.rotation_agreement(state),         plausibility.frozen_s(state),
                  plausibility.better_axis_labels(state),         confirms_gyro(plausibility, state)};
  out.health.add(Kind::rate_unit, rate_unit(samples), kImu);
  out.health.add(Kind::force_unit, force_unit(samples), kImu);
  add_findings(plausibility, state, kImu, out.health);
  out.health.add(Kind::force_at_rest, gravity.magnitude_verdict(at_rest), kImu, "", {}, 1.0);
  return out;
}

ImuFindings check_flights(const CheckedImu& imu, std::span<const ImuSample> samples,
                          std::optional<double> carried_share) {
  FlightSignCheck::Params params;
  params.lever_arm_m = imu.lever_arm_I_m;
  params.gyro_range_rad_s = imu.gyro_range_rad_s;
  const bool thrown = carried_share && *carried_share < kRepeatedFraction;
  params.body = thrown ? FlightSignCheck::Body::thrown : FlightSignCheck::Body::may_be_hand_held;
  const FlightSignCheck sense(params);
  FlightSignCheck::State state;
  for (const ImuSample& sample : samples) sense.step(sample, state);
  ImuFindings out;
  out.health.add(Kind::flight_forces, sense.verdict(state), kImu);
  return out;
}

ImuFindings check_rests(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates) {
  const RestGravity gravity = rest_gravity(imu);
  ImuFindings out;
  RestGravity::State& state = out.rests.emplace();
  for (std::size_t k = 0; k < std::min(samples.size(), rates.size()); ++k) gravity.step(samples[k], rates[k], state);
  const Status magnitude = gravity.magnitude_verdict(state);
  out.health.add(magnitude.ok() ? Kind::rotation : Kind::force_at_rest, gravity.verdict(state), kImu, "", {},
                 magnitude.ok() ? 0.0 : 1.0);
  return out;
}

ImuFindings check_pivots(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates) {
  PivotCheck::Params params;
  params.gravity_m_s2 = imu.gravity_m_s2;
  params.accel_range_m_s2 = imu.accel_range_m_s2;
  const PivotCheck pivots(params);
  ImuFindings out;
  out.pivots = pivots.find(samples, rates);
  out.health.add(Kind::rotation, pivots.verdict(*out.pivots), kImu);
  return out;
}

ImuFindings check_frozen(const CheckedImu& imu, std::span<const ImuSample> samples) {
  FrozenAxes::Params params;
  params.gyro_range_rad_s = imu.gyro_range_rad_s;
  params.accel_range_m_s2 = imu.accel_range_m_s2;
  ImuFindings out;
  out.frozen_axes = find_frozen_axes(FrozenAxes(params), samples);
  for (const FrozenAxis& axis : out.frozen_axes) add_finding(Kind::frozen_axis, kImu, axis, out.health);
  return out;
}

ImuFindings check_merged(const CheckedImu& imu, const MergedRecordings& merged) {
  ImuFindings out;
  out.health.add(merged.faults);
  out.add(check_readings(imu, merged.samples));
  ImuMerge::add_findings(merged.mislabelled_axes, merged.lever_arm_agreement, out.readings->gyro_confirmed, out.health);
  return out;
}

ImuFindings check_recording(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates,
                            std::optional<double> carried_share) {
  ImuFindings out = check_flights(imu, samples, carried_share);
  out.add(check_readings(imu, samples));
  out.add(check_rests(imu, samples, rates));
  out.add(check_pivots(imu, samples, rates));
  out.add(check_frozen(imu, samples));
  return out;
}

std::vector<Eigen::Matrix3d> suspect_covariance(const ImuFindings& findings, std::span<const ImuSample> samples,
                                                std::span<const RateState> rates) {
  std::vector<Eigen::Matrix3d> out;
  if (findings.health.invalidates_estimate()) {
    for (const RateState& rate : rates) out.emplace_back(rate.w_WI_I_rad_s.squaredNorm() * Eigen::Matrix3d::Identity());
  }
  const double sigma_rad_s = rate_max_so_far_rad_s(samples);
  for (const FrozenAxis& axis : findings.frozen_axes) {
    if (axis.triad != Triad::gyro) continue;
    out.resize(rates.size(), Eigen::Matrix3d::Zero());
    for (std::size_t k = 0; k < rates.size(); ++k) {
      if (rates[k].time_ns >= axis.from_ns && rates[k].time_ns <= axis.to_ns)
        out[k](axis.axis, axis.axis) += sigma_rad_s * sigma_rad_s;
    }
  }
  return out;
}

}  // namespace tumble
