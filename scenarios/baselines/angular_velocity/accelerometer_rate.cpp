// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/angular_velocity/accelerometer_rate.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/rate_factors.hpp"
#include "tumble/angular_velocity/detail/recording_check.hpp"
#include "tumble/common/detail/scalar_update.hpp"

namespace tumble::baselines {

namespace {

using Eigen::Vector3d;
using RateAndAcceleration = Eigen::Matrix<double, 6, 1>;
using RateCovariance = Eigen::Matrix<double, 6, 6>;

constexpr int kIterations = 4;  // iterations per update, because the centripetal force is quadratic in the rate

struct AccelerometerFilter {
  RateAndAcceleration x = RateAndAcceleration::Zero();
  RateCovariance P = RateCovariance::Zero();

  void predict(double dt_s, double psd) {
    RateCovariance F = RateCovariance::Identity(), Q = RateCovariance::Zero();
    F.topRightCorner<3, 3>().diagonal().setConstant(dt_s);
    Q.topLeftCorner<3, 3>().diagonal().setConstant(psd * dt_s * dt_s * dt_s / 3.0);
    Q.topRightCorner<3, 3>().diagonal().setConstant(psd * dt_s * dt_s / 2.0);
    Q.bottomLeftCorner<3, 3>() = Q.topRightCorner<3, 3>();
    Q.bottomRightCorner<3, 3>().diagonal().setConstant(psd * dt_s);
    x = (F * x).eval();
    P = (F * P * F.transpose() + Q).eval();
  }

  void measure_axis(int j, double reading, double variance) { x += component_update(j, reading - x[j], variance, P); }

  // Iterated update; the covariance uses the linearisation of the last iteration.
  void measure_difference(const Vector3d& p_I_m, const Vector3d& difference, double variance) {
    const RigConstants rig{.lever_arm_m = p_I_m};
    const RateAndAcceleration before = x;
    RateCovariance after = P;
    for (int i = 0; i < kIterations; ++i) {
      const RateFactor f = flight_factor({x.head<3>(), x.tail<3>()}, rig, difference);
      const Vector3d innovation = -(f.residual + f.jacobian_knot * (before - x));
      after = P;
      x = before + vector_update<3, 6>(f.jacobian_knot, innovation, variance * Eigen::Matrix3d::Identity(), after);
    }
    P = 0.5 * (after + after.transpose());
  }
};

}  // namespace

AccelerometerRate::AccelerometerRate(const Params& params)
    : params_(params), rails_({.axis_aligned_rails = params.rails, .tilted = params.tilted_rails}) {
  require_valid_fields(params);
}

Status AccelerometerRate::estimate(std::span<const ImuSample> samples,
                                   std::span<const AuxiliaryAccelerometer> auxiliary_imus,
                                   std::vector<RateState>& out) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  for (const AuxiliaryAccelerometer& auxiliary_imu : auxiliary_imus) {
    const std::size_t count = auxiliary_imu.specific_force_m_s2.size();
    if (count != samples.size()) {
      return {ErrorCode::too_few, "auxiliary_imu", static_cast<double>(count), static_cast<double>(samples.size())};
    }
  }
  const std::vector<Clipping> clippings = rails_.find(samples).clippings;
  const double period_s = median_period_s(samples);
  const double gyro_variance = params_.gyro_noise_density * params_.gyro_noise_density / period_s;
  const double noise = params_.accel_noise_density * params_.accel_noise_density / period_s;

  std::vector<RateState> states(samples.size());
  AccelerometerFilter filter;
  filter.x.head<3>() = samples.front().angular_velocity_rad_s;
  filter.P.diagonal() << Vector3d::Constant(1.0), Vector3d::Constant(100.0);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (k > 0) filter.predict(seconds(samples[k].time_ns - samples[k - 1].time_ns), params_.jerk_psd);
    const Vector3d &reading = samples[k].angular_velocity_rad_s, &force = samples[k].specific_force_m_s2;
    const int clipped = clippings[k].gyro | clippings[k].unusable_gyro;
    for (int j = 0; j < 3 && params_.use_gyro; ++j) {
      if ((clipped >> j & 1) == 0) filter.measure_axis(j, reading[j], gyro_variance);
    }
    for (const AuxiliaryAccelerometer& auxiliary_imu : auxiliary_imus) {
      const Vector3d& there = auxiliary_imu.specific_force_m_s2[k];
      if (!there.allFinite() || clippings[k].accel != 0) continue;
      const double scale = params_.accel_scale_error * std::max(there.norm(), force.norm());
      const double variance = 2.0 * noise + params_.accel_floor_m_s2 * params_.accel_floor_m_s2 + scale * scale;
      filter.measure_difference(auxiliary_imu.p_I_m, there - force, variance);
    }
    for (int j = 0; j < 3; ++j) {
      double low = -params_.rate_max_rad_s, high = params_.rate_max_rad_s;
      // The true rate exceeds a reading at the saturation limit, so the reading bounds one side of the range.
      if ((clippings[k].gyro >> j & 1) != 0 && reading[j] > 0.0) low = std::min(reading[j], high);
      if ((clippings[k].gyro >> j & 1) != 0 && reading[j] < 0.0) high = std::max(reading[j], low);
      filter.x[j] = std::clamp(filter.x[j], low, high);
    }
    RateState& state = states[k];
    state.time_ns = samples[k].time_ns;
    state.w_WI_I_rad_s = filter.x.head<3>();
    state.covariance_rad2_s2 = filter.P.topLeftCorner<3, 3>();
    state.clipped_axes = static_cast<std::uint8_t>(clipped);
    state.source = clipped == 0             ? RateSource::measured
                   : auxiliary_imus.empty() ? RateSource::bounded_only
                                            : RateSource::recovered_contact;
  }
  out = std::move(states);
  return {};
}

}  // namespace tumble::baselines
