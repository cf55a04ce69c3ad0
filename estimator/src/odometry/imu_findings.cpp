// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/odometry/detail/imu_findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "tumble/angular_velocity/detail/flight_sign_check.hpp"
#include "tumble/attitude/detail/imu_merge.hpp"
#include "tumble/attitude/detail/pivot_check.hpp"
#include "tumble/attitude/detail/rest_gravity.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

namespace {

using Kind = HealthFinding::Kind;

constexpr const char* kImu = "imu";
constexpr double kSlopeTolerance = 0.02, kSlopeAgreementMin = 0.99;
// The body counts as hand-held if at least the fraction kRepeatedFraction of the samples is classified as hand-held. In
// recordings of hand-held motion, at least 91 % of the samples are classified as hand-held. In recordings of throws,
// mostly less than 60 % of the samples are classified as hand-held, even with wrongly labelled sensor axes.
constexpr double kRepeatedFraction = 0.8;

double rate_max_so_far_rad_s(std::span<const ImuSample> samples) {
  double fastest = 0.0;
  for (const ImuSample& sample : samples) fastest = std::max(fastest, sample.angular_velocity_rad_s.norm());
  return fastest;
}

RestGravity rest_gravity(const ImuDescription& imu) {
  return RestGravity({.gravity_m_s2 = imu.gravity_m_s2, .accel_range_m_s2 = imu.accel_range_m_s2});
}

Status check_force_at_rest(const ImuDescription& imu, std::span<const ImuSample> samples) {
  const RestGravity gravity = rest_gravity(imu);
  RestGravity::GravityMagnitudeState state;
  for (const ImuSample& sample : samples) gravity.step(sample, state);
  return gravity.gravity_magnitude_verdict(state);
}

/// Returns whether the rotation measured by the gyro agrees with the rotation of the specific-force vector.
bool check_readings(const ImuDescription& imu, std::span<const ImuSample> samples, SensorHealth& health) {
  const ImuPlausibility plausibility(plausibility_setup(imu.gravity_m_s2, imu.gyro_range_rad_s));
  ImuPlausibility::State state;
  for (const ImuSample& sample : samples) plausibility.step(sample, state);
  add_findings(plausibility, state, kImu, health);
  health.add(Kind::wrong_force_magnitude_at_rest, check_force_at_rest(imu, samples), kImu);
  if (!imu.is_merged) {  // several IMUs are assumed to be on a sphere, which does not rotate about a pivot
    const PivotMotionCheck pivots =
        PivotMotionCheck::of(samples, imu.gravity_m_s2, imu.gyro_range_rad_s, imu.accel_range_m_s2);
    health.add(Kind::inconsistent_rotation, pivots.verdict(), kImu);
  }
  return confirms_gyro(plausibility, state);
}

void check_flight_forces(const ImuDescription& imu, std::span<const ImuSample> samples,
                         std::optional<double> carried_share, SensorHealth& health) {
  const bool thrown = carried_share && *carried_share < kRepeatedFraction;
  const FlightSignCheck sense({.motion_type = thrown ? FlightSignCheck::BodyMotionType::always_thrown
                                                     : FlightSignCheck::BodyMotionType::possibly_hand_held,
                               .lever_arm_m = imu.lever_arm_I_m,
                               .gyro_range_rad_s = imu.gyro_range_rad_s});
  FlightSignCheck::State state;
  for (const ImuSample& sample : samples) sense.step(sample, state);
  health.add(Kind::inverted_accel_in_flight, sense.verdict(state), kImu);
}

/// Checks whether the estimated angular rates rotate the gravity vector of each rest to the gravity vector of the next
/// rest.
void check_stationary_gravity(const ImuDescription& imu, std::span<const ImuSample> samples,
                              std::span<const AngularRateState> rates, SensorHealth& health) {
  const RestGravity gravity = rest_gravity(imu);
  RestGravity::State state;
  for (std::size_t k = 0; k < std::min(samples.size(), rates.size()); ++k) gravity.step(samples[k], rates[k], state);
  health.add(
      gravity.gravity_magnitude_verdict(state).ok() ? Kind::inconsistent_rotation : Kind::wrong_force_magnitude_at_rest,
      gravity.verdict(state), kImu);
}

}  // namespace

ImuPlausibility::Setup plausibility_setup(double gravity_m_s2, double gyro_range_rad_s) {
  ImuPlausibility::Setup setup;
  setup.gravity_m_s2 = std::max(gravity_m_s2, 1e-3);
  if (gyro_range_rad_s > 0.0) setup.gyro_range_rad_s = max_unsaturated_reading(gyro_range_rad_s);
  return setup;
}

void add_findings(const ImuPlausibility& plausibility, const ImuPlausibility::State& state, const std::string& sensor,
                  SensorHealth& health) {
  health.add(plausibility.frozen_s(state) > 0.0 ? Kind::frozen_sensor : Kind::inconsistent_rotation,
             plausibility.verdict(state), sensor);
}

bool confirms_gyro(const ImuPlausibility& plausibility, const ImuPlausibility::State& state) {
  return std::abs(plausibility.force_to_gyro_rotation_ratio(state) - 1.0) < kSlopeTolerance &&
         plausibility.rotation_agreement(state) > kSlopeAgreementMin;
}

SensorHealth check_readings(const ImuDescription& imu, std::span<const ImuSample> samples) {
  SensorHealth out;
  (void)check_readings(imu, samples, out);
  return out;
}

ImuHealthReport check_frozen(const ImuDescription& imu, std::span<const ImuSample> samples) {
  const FrozenAxes detector({.gyro_range_rad_s = imu.gyro_range_rad_s, .accel_range_m_s2 = imu.accel_range_m_s2});
  ImuHealthReport out{{}, find_frozen_axes(detector, samples)};
  for (const FrozenAxis& axis : out.frozen_axes) add_finding(Kind::frozen_axis, kImu, axis, out.health);
  return out;
}

SensorHealth check_merged_imus(const ImuDescription& imu, const MergedRecordings& merged) {
  SensorHealth out = merged.faults;
  const bool gyro_confirmed = check_readings(imu, merged.samples, out);
  ImuMerge::add_findings(merged.mislabelled_axes, merged.lever_arm_agreement, gyro_confirmed, out);
  return out;
}

ImuHealthReport check_recording(const ImuDescription& imu, std::span<const ImuSample> samples,
                                std::span<const AngularRateState> rates, std::optional<double> carried_share) {
  ImuHealthReport out = check_frozen(imu, samples);
  check_flight_forces(imu, samples, carried_share, out.health);
  (void)check_readings(imu, samples, out.health);
  check_stationary_gravity(imu, samples, rates, out.health);
  return out;
}

std::vector<Eigen::Matrix3d> suspected_error_covariance(const ImuHealthReport& findings,
                                                        std::span<const ImuSample> samples,
                                                        std::span<const AngularRateState> rates) {
  std::vector<Eigen::Matrix3d> out;
  if (findings.health.invalidates_estimate()) {
    for (const AngularRateState& rate : rates)
      out.emplace_back(rate.w_WI_I_rad_s.squaredNorm() * Eigen::Matrix3d::Identity());
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
