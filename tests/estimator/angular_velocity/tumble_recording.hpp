// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Phase is what a body does at a sample of a synthetic tumble.
enum class Phase : std::uint8_t { rest, push, flight, impact, roll };

struct TumbleOptions {
  std::uint64_t seed = 1;
  std::uint64_t mounting_seed = 1;  ///< orientation of the principal axes in the IMU
  int rate_hz = 100;                ///< must divide 2000
  double gyro_rail_rad_s = 10.5;
  double accel_rail_m_s2 = 196.0;
  Eigen::Vector3d lever_arm_m = {-0.022, -0.085, 0.055};
  Eigen::Vector3d moments = {1.0, 1.15, 1.3};
  double gyro_sigma_rad_s = 5.236e-3;
  double accel_sigma_m_s2 = 5.9e-3;
  Eigen::Vector3d gyro_bias_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_m_s2 = Eigen::Vector3d::Zero();
  /// Scale and misalignment: readings before noise are (1 + error) times the truth.
  Eigen::Matrix3d gyro_error = Eigen::Matrix3d::Zero(), accel_error = Eigen::Matrix3d::Zero();
  /// Rows along which the gyro's elements sense and clip; readings are converted back to the axes.
  Eigen::Matrix3d gyro_rows = Eigen::Matrix3d::Identity();
  Eigen::Vector3d gyro_offset_rad_s = Eigen::Vector3d::Zero();  ///< of the elements, subtracted after clipping
  double speed_low_rad_s = 9.0, speed_high_rad_s = 18.0;        ///< rates of the flights
  int flights = 8;
  double impact_m_s2 = 150.0;  ///< largest peak force of an impact; the smallest is a third of it
  bool roll = true;            ///< the motion ends with a second of rolling to rest
};

struct TumbleRecording {
  std::vector<ImuSample> samples;
  std::vector<Eigen::Vector3d> truth;  ///< mean of w_WI_I over the window of each sample
  std::vector<Phase> phase;
  std::vector<Eigen::Vector3d> hidden;                ///< signed saturation deficit of each element [rad/s]
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();  ///< in IMU axes
};

/// The tumble consists of rest, a push, torque-free flights (in closed form) joined by impacts that change rate and
/// force within 20 ms, rolling, and rest. The readings are means over the window of a sample, with noise, clipped after
/// averaging.
TumbleRecording make_tumble(const TumbleOptions& options);

/// Returns parameters of an AngularRateSmoother or an AngularRateStream with the lever arm, which has no default.
template <class Params>
Params with_lever_arm(const Eigen::Vector3d& lever_arm_m = TumbleOptions{}.lever_arm_m) {
  Params out;
  out.model.nominal.lever_arm_m = lever_arm_m;
  return out;
}

/// Returns these parameters with a lever arm that is wrong by `error_m` in a random direction.
template <class Params>
Params with_wrong_lever_arm(double error_m, std::uint64_t seed) {
  auto out = with_lever_arm<Params>();
  const double s = static_cast<double>(seed);
  out.model.nominal.lever_arm_m +=
      error_m * Eigen::Vector3d(std::sin(s), std::cos(2.0 * s), std::sin(3.0 * s)).normalized();
  return out;
}

/// ClippedErrors contains quantiles of the error norm over the samples with at least one clipped gyro axis.
struct ClippedErrors {
  std::size_t count = 0;
  double median = 0.0, p99 = 0.0, maximum = 0.0;
};
ClippedErrors clipped_errors(const TumbleRecording& recording, const std::vector<Eigen::Vector3d>& rates, double rail);
std::vector<Eigen::Vector3d> rates_of(const std::vector<AngularRateState>& states);
std::vector<Eigen::Vector3d> readings_of(const std::vector<ImuSample>& samples);

}  // namespace tumble
