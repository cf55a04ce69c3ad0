// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/imu_findings.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/flight_sign_check.hpp"
#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/attitude/imu_plausibility.hpp"
#include "tumble/odometry/imu_sheet.hpp"

namespace tumble {

namespace {

using Kind = ImuFinding::Kind;

constexpr double kSlopeTolerance = 0.02, kSlopeAgreementMin = 0.99;
// Fraction of hand-held samples above which a recording counts as hand-held. Measured fractions are at least 0.91 for
// hand-held motion. For thrown bodies, the fractions are at most 0.25 with correct axes, and mostly below 0.6 with
// wrong axes.
constexpr double kRepeatedFraction = 0.8;

void add_finding(Kind kind, const Status& status, std::span<const ImuSample> samples, ImuFindings& out) {
  if (!status.ok()) out.all.push_back({kind, status, samples.empty() ? 0 : samples.front().time_ns, {}});
}

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

/// Returns the error of a rate in degrees per second, by the criterion of RateReport::rate_unit_suspect.
Status rate_unit(std::span<const ImuSample> samples) {
  const double largest = largest_rate_rad_s(samples), most = RateModelParams{}.rate_max_rad_s;
  return largest > most ? Status{ErrorCode::out_of_range, "angular_velocity_rad_s", largest, most} : Status{};
}

}  // namespace

bool ImuFindings::Readings::confirms_gyro() const {
  return std::abs(rotation_slope - 1.0) < kSlopeTolerance && rotation_agreement > kSlopeAgreementMin;
}

bool ImuFindings::contradict() const {
  return std::any_of(all.begin(), all.end(), [](const ImuFinding& finding) {
    return finding.kind != Kind::rate_unit && finding.kind != Kind::frozen_axis;
  });
}

void ImuFindings::add(const ImuFindings& other) {
  all.insert(all.end(), other.all.begin(), other.all.end());
  if (other.readings) readings = other.readings;
  if (other.rests) rests = other.rests;
  if (other.pivots) pivots = other.pivots;
}

ImuFindings check_readings(const CheckedImu& imu, std::span<const ImuSample> samples) {
  const RestGravity gravity = rest_gravity(imu);
  RestGravity::State at_rest;
  ImuPlausibility::Params params;
  params.gravity_m_s2 = imu.gravity_m_s2;
  if (!imu.merged && imu.gyro_range_rad_s > 0.0) params.gyro_range_rad_s = unsaturated_range(imu.gyro_range_rad_s);
  const ImuPlausibility plausibility(params);
  ImuPlausibility::State state;
  for (const ImuSample& sample : samples) {
    gravity.step(sample, {}, at_rest);
    plausibility.step(sample, state);
  }
  ImuFindings out;
  out.readings = {gravity.magnitude_error_ratio(at_rest),         plausibility.force_ratio(state),
                  plausibility.unexplained_rotation_ratio(state), plausibility.rotation_slope(state),
                  plausibility.rotation_agreement(state),         plausibility.frozen_s(state),
                  plausibility.better_axis_labels(state)};
  add_finding(Kind::rate_unit, rate_unit(samples), samples, out);
  add_finding(Kind::gravity_rotation_mismatch, plausibility.verdict(state), samples, out);
  add_finding(Kind::rest_force, gravity.magnitude_verdict(at_rest), samples, out);
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
  add_finding(Kind::flight, sense.verdict(state), samples, out);
  return out;
}

ImuFindings check_rests(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates) {
  const RestGravity gravity = rest_gravity(imu);
  ImuFindings out;
  RestGravity::State& state = out.rests.emplace();
  for (std::size_t k = 0; k < std::min(samples.size(), rates.size()); ++k) gravity.step(samples[k], rates[k], state);
  add_finding(Kind::rest_rotation_mismatch, gravity.verdict(state), samples, out);
  return out;
}

ImuFindings check_pivots(const CheckedImu& imu, std::span<const ImuSample> samples, std::span<const RateState> rates) {
  PivotCheck::Params params;
  params.gravity_m_s2 = imu.gravity_m_s2;
  params.accel_range_m_s2 = imu.accel_range_m_s2;
  const PivotCheck pivots(params);
  ImuFindings out;
  out.pivots = pivots.find(samples, rates);
  add_finding(Kind::pivot_rotation_mismatch, pivots.verdict(*out.pivots), samples, out);
  return out;
}

ImuFindings check_frozen(const CheckedImu& imu, std::span<const ImuSample> samples) {
  FrozenAxes::Params params;
  params.gyro_range_rad_s = imu.gyro_range_rad_s;
  params.accel_range_m_s2 = imu.accel_range_m_s2;
  ImuFindings out;
  for (const FrozenAxis& axis : find_frozen_axes(FrozenAxes(params), samples)) {
    const Status status{ErrorCode::out_of_range, "seconds for which an axis repeats one reading",
                        seconds(axis.to_ns - axis.from_ns), params.frozen_s};
    out.all.push_back({Kind::frozen_axis, status, axis.from_ns, axis});
  }
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
  if (findings.contradict()) {
    for (const RateState& rate : rates) out.emplace_back(rate.w_WI_I_rad_s.squaredNorm() * Eigen::Matrix3d::Identity());
  }
  const double sigma_rad_s = rate_max_so_far_rad_s(samples);
  for (const ImuFinding& finding : findings.all) {
    const FrozenAxis& axis = finding.axis;
    if (finding.kind != Kind::frozen_axis || axis.triad != Triad::gyro) continue;
    out.resize(rates.size(), Eigen::Matrix3d::Zero());
    for (std::size_t k = 0; k < rates.size(); ++k) {
      if (rates[k].time_ns >= axis.from_ns && rates[k].time_ns <= axis.to_ns)
        out[k](axis.axis, axis.axis) += sigma_rad_s * sigma_rad_s;
    }
  }
  return out;
}

}  // namespace tumble
