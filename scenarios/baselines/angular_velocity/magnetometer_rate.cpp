// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/angular_velocity/magnetometer_rate.hpp"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tumble/angular_velocity/detail/recording_check.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::baselines {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr int kStateSize = 12, kRate = 0, kAcceleration = 3, kField = 6, kIron = 9;
using Vector = Eigen::Matrix<double, kStateSize, 1>;
using Matrix = Eigen::Matrix<double, kStateSize, kStateSize>;

// The filter measures the magnetic field in units of 10 uT, so that the covariance is well scaled.
constexpr double kUnitT = 1e-5;
// Largest factor by which a magnetic disturbance increases the variance of a reading.
constexpr double kDisturbedMax = 1e4;

struct FieldFilter {
  Vector x = Vector::Zero();
  Matrix P = Matrix::Zero();

  void predict(double dt_s, double jerk_psd, double field_psd) {
    const Vector3d w = x.segment<3>(kRate), alpha = x.segment<3>(kAcceleration), b = x.segment<3>(kField);
    // Each reading is a mean over an averaging window. Between the centres of two windows, the body rotates by the mean
    // of the two rates.
    const Matrix3d turn = so3::exp(-dt_s * (w + 0.5 * dt_s * alpha)).toRotationMatrix();
    const Vector3d turned = turn * b;
    Matrix F = Matrix::Identity(), Q = Matrix::Zero();
    F.block<3, 3>(kRate, kAcceleration).diagonal().setConstant(dt_s);
    F.block<3, 3>(kField, kRate) = dt_s * so3::hat(turned);
    F.block<3, 3>(kField, kAcceleration) = 0.5 * dt_s * dt_s * so3::hat(turned);
    F.block<3, 3>(kField, kField) = turn;
    Q.block<3, 3>(kRate, kRate).diagonal().setConstant(jerk_psd * dt_s * dt_s * dt_s / 3.0);
    Q.block<3, 3>(kRate, kAcceleration).diagonal().setConstant(jerk_psd * dt_s * dt_s / 2.0);
    Q.block<3, 3>(kAcceleration, kRate) = Q.block<3, 3>(kRate, kAcceleration);
    Q.block<3, 3>(kAcceleration, kAcceleration).diagonal().setConstant(jerk_psd * dt_s);
    Q.block<3, 3>(kField, kField).diagonal().setConstant(field_psd * dt_s);
    x.segment<3>(kRate) += dt_s * alpha;
    x.segment<3>(kField) = turned;
    P = (F * P * F.transpose() + Q).eval();
  }

  void measure_axis(int j, double reading, double variance) { x += component_update(j, reading - x[j], variance, P); }

  void measure_field(const Vector3d& reading, double variance) {
    Eigen::Matrix<double, 3, kStateSize> H = Eigen::Matrix<double, 3, kStateSize>::Zero();
    H.middleCols<3>(kField).setIdentity();
    H.middleCols<3>(kIron).setIdentity();
    const Vector3d innovation = reading - x.segment<3>(kField) - x.segment<3>(kIron);
    x += vector_update<3, kStateSize>(H, innovation, variance * Matrix3d::Identity(), P);
    P = (0.5 * (P + P.transpose())).eval();
  }
};

// Initialises the state from the first reading, which only determines the sum of Earth field and hard iron.
void start_field(const Vector3d& reading, double noise, double iron, FieldFilter& filter) {
  filter.x.segment<3>(kField) = reading;
  filter.P.block<3, 3>(kField, kField).diagonal().setConstant(noise * noise + iron * iron);
  filter.P.block<3, 3>(kIron, kIron).diagonal().setConstant(iron * iron);
  filter.P.block<3, 3>(kField, kIron).diagonal().setConstant(-iron * iron);
  filter.P.block<3, 3>(kIron, kField) = filter.P.block<3, 3>(kField, kIron);
}

}  // namespace

MagnetometerRate::MagnetometerRate(const Params& params)
    : params_(params), rails_({.upright_rails = params.rails, .tilted = params.tilted_rails}) {
  require_fields(params);
}

Status MagnetometerRate::estimate(std::span<const ImuSample> samples, std::span<const Vector3d> field_I_t,
                                  std::vector<RateState>& out) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  if (!field_I_t.empty() && field_I_t.size() != samples.size()) {
    return {Trouble::too_few, "magnetic_field", static_cast<double>(field_I_t.size()),
            static_cast<double>(samples.size())};
  }
  const std::vector<Clipping> clippings = rails_.find(samples).clippings;
  const double gyro_variance = params_.gyro_noise_density * params_.gyro_noise_density / median_period_s(samples);
  const double noise = params_.field_noise_t / kUnitT, iron = params_.hard_iron_t / kUnitT;
  const double disturbance = params_.disturbance_t_sqrt_s / kUnitT, earth = params_.earth_field_t / kUnitT;

  std::vector<RateState> states(samples.size());
  FieldFilter filter;
  filter.x.head<3>() = samples.front().angular_velocity_rad_s;
  filter.P.topLeftCorner<6, 6>().diagonal() << Vector3d::Constant(1.0), Vector3d::Constant(100.0);
  bool started = false;
  double disturbed = 1.0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double dt_s = k == 0 ? 0.0 : seconds(samples[k].time_ns - samples[k - 1].time_ns);
    if (k > 0) filter.predict(dt_s, params_.jerk_psd, disturbed * disturbance * disturbance);
    const Vector3d& reading = samples[k].angular_velocity_rad_s;
    const int clipped = clippings[k].gyro | clippings[k].missing_gyro;
    for (int j = 0; j < 3; ++j) {
      if ((clipped >> j & 1) == 0) filter.measure_axis(j, reading[j], gyro_variance);
    }
    if (!field_I_t.empty() && field_I_t[k].allFinite()) {
      const Vector3d field = field_I_t[k] / kUnitT;
      if (!started) start_field(field, noise, iron, filter);
      if (started) filter.measure_field(field, noise * noise);
      started = true;
      if (earth > 0.0) {
        const double off = ((field - filter.x.tail<3>()).norm() - earth) / (params_.disturbed_share * earth);
        disturbed = std::min(1.0 + off * off, kDisturbedMax);
      }
    }
    for (int j = 0; j < 3; ++j) {
      double low = -params_.rate_max_rad_s, high = params_.rate_max_rad_s;
      // A reading at the saturation limit gives a one-sided bound of the true rate.
      if ((clippings[k].gyro >> j & 1) != 0 && reading[j] > 0.0) low = std::min(reading[j], high);
      if ((clippings[k].gyro >> j & 1) != 0 && reading[j] < 0.0) high = std::max(reading[j], low);
      filter.x[j] = std::clamp(filter.x[j], low, high);
    }
    RateState& state = states[k];
    state.time_ns = samples[k].time_ns;
    state.w_WI_I_rad_s = filter.x.head<3>();
    state.covariance_rad2_s2 = filter.P.topLeftCorner<3, 3>();
    state.clipped_axes = static_cast<std::uint8_t>(clipped);
    state.source = clipped == 0 ? RateSource::measured
                   : started    ? RateSource::recovered_contact
                                : RateSource::bounded_only;
  }
  out = std::move(states);
  return {};
}

}  // namespace tumble::baselines
