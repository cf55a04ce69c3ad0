// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/angular_velocity/standstill_smoother.hpp"

#include <Eigen/Cholesky>
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
constexpr int kErrorSize = 12;  // error state: attitude (world axes), velocity, rate, acceleration
using Error = Eigen::Matrix<double, kErrorSize, 1>;
using ErrorCovariance = Eigen::Matrix<double, kErrorSize, kErrorSize>;

struct Navigation {
  Eigen::Quaterniond q_WI = Eigen::Quaterniond::Identity();
  Vector3d v_W_m_s = Vector3d::Zero();
  Vector3d rate_rad_s = Vector3d::Zero();
  Vector3d acceleration_rad_s2 = Vector3d::Zero();

  void add(const Error& e) {
    q_WI = (so3::exp(e.segment<3>(0)) * q_WI).normalized();
    v_W_m_s += e.segment<3>(3);
    rate_rad_s += e.segment<3>(6);
    acceleration_rad_s2 += e.segment<3>(9);
  }
  Error minus(const Navigation& other) const {
    Error e;
    e << so3::log(q_WI * other.q_WI.conjugate()), v_W_m_s - other.v_W_m_s, rate_rad_s - other.rate_rad_s,
        acceleration_rad_s2 - other.acceleration_rad_s2;
    return e;
  }
};

struct Belief {
  Navigation mean;
  ErrorCovariance covariance = ErrorCovariance::Zero();
};

struct Step {
  Belief before, after;  // estimate before and after the update with this sample
  ErrorCovariance transition = ErrorCovariance::Identity();
};

// Noise contains the noise variances of one sample, computed from the parameters and the sample period.
struct Noise {
  double gyro_variance = 0.0, accel_variance = 0.0;
};

// BoundedAcceleration models the rate of one axis by a stationary Matern 3/2 process, whose state is rate and
// acceleration. The process is white jerk over short times and a bounded rate over long times.
struct BoundedAcceleration {
  double lambda = 1.0, variance = 1.0;

  BoundedAcceleration(double psd, double sigma)
      : lambda(std::cbrt(psd / (4.0 * sigma * sigma))), variance(sigma * sigma) {}
  Eigen::Matrix2d start() const { return Eigen::Vector2d(variance, lambda * lambda * variance).asDiagonal(); }
  Eigen::Matrix2d transition(double dt_s) const {
    Eigen::Matrix2d F;
    F << 1.0 + lambda * dt_s, dt_s, -lambda * lambda * dt_s, 1.0 - lambda * dt_s;
    return std::exp(-lambda * dt_s) * F;
  }
  Eigen::Matrix2d noise(const Eigen::Matrix2d& F) const { return start() - F * start() * F.transpose(); }
};

void predict(const StandstillSmoother::Params& p, const BoundedAcceleration& process, const Noise& noise,
             const ImuSample& sample, double dt_s, Belief& belief, ErrorCovariance& F) {
  Navigation& n = belief.mean;
  // Force and rate of a sample are means over its averaging window, which is the current time step.
  const Eigen::Matrix2d motion = process.transition(dt_s);
  const Vector3d turn = dt_s * (motion(0, 0) * n.rate_rad_s + motion(0, 1) * n.acceleration_rad_s2);
  const Eigen::Quaterniond middle = n.q_WI * so3::exp(0.5 * turn);
  const Vector3d force_W = middle * sample.specific_force_m_s2;
  const Matrix3d R = middle.toRotationMatrix();
  F.setIdentity();
  const Matrix3d arm = -0.5 * dt_s * so3::hat(force_W) * R;  // effect of a rotation on the velocity within a window
  for (int i = 0; i < 2; ++i) {
    F.block<3, 3>(0, 6 + 3 * i) = dt_s * motion(0, i) * R;
    F.block<3, 3>(3, 6 + 3 * i) = dt_s * motion(0, i) * arm;
    for (int j = 0; j < 2; ++j) F.block<3, 3>(6 + 3 * i, 6 + 3 * j) = motion(i, j) * Matrix3d::Identity();
  }
  F.block<3, 3>(3, 0) = -dt_s * so3::hat(force_W);
  n.q_WI = (n.q_WI * so3::exp(turn)).normalized();
  n.v_W_m_s += dt_s * (force_W - p.gravity_m_s2 * Vector3d::UnitZ());
  const Vector3d rate = n.rate_rad_s;
  n.rate_rad_s = motion(0, 0) * rate + motion(0, 1) * n.acceleration_rad_s2;
  n.acceleration_rad_s2 = motion(1, 0) * rate + motion(1, 1) * n.acceleration_rad_s2;
  ErrorCovariance Q = ErrorCovariance::Zero();
  Q.diagonal().head<6>() << Vector3d::Constant(1e-12), Vector3d::Constant(noise.accel_variance * dt_s * dt_s);
  const Eigen::Matrix2d change = process.noise(motion);
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) Q.block<3, 3>(6 + 3 * i, 6 + 3 * j).diagonal().setConstant(change(i, j));
  }
  belief.covariance = (F * belief.covariance * F.transpose() + Q).eval();
}

// Updates the estimate with one scalar measurement: residual = row * error + noise.
void measure(const Eigen::Matrix<double, 1, kErrorSize>& row, double residual, double variance, Belief& belief) {
  belief.mean.add(scalar_update(row, residual, variance, belief.covariance));
}

void measure_component(int index, double residual, double variance, Belief& belief) {
  Eigen::Matrix<double, 1, kErrorSize> row = Eigen::Matrix<double, 1, kErrorSize>::Zero();
  row[index] = 1.0;
  measure(row, residual, variance, belief);
}

// Restricts the rate of one axis to the range between its clipped reading and the maximum rate.
void hold(const StandstillSmoother::Params& p, double reading, int axis, Belief& belief) {
  constexpr double kSoftness = 0.05;  // rad/s
  const double side = std::copysign(1.0, reading), rate = side * belief.mean.rate_rad_s[axis];
  const double low = std::min(std::abs(reading), p.rate_max_rad_s);
  const double held = std::clamp(rate, low, p.rate_max_rad_s);
  if (held != rate) measure_component(6 + axis, side * (held - rate), kSoftness * kSoftness, belief);
}

// Returns true if the tilt or velocity error at a standstill is too large for a linear smoother to correct the motion
// before the standstill.
bool is_lost(const StandstillSmoother::Params& p, const ImuSample& sample, const Belief& belief) {
  const Vector3d up = belief.mean.q_WI * sample.specific_force_m_s2.normalized();
  if (std::atan2(up.head<2>().norm(), up.z()) > p.tilt_max_rad) return true;
  Matrix3d spread = belief.covariance.block<3, 3>(3, 3);
  spread.diagonal().array() += p.rest_velocity_sigma_m_s * p.rest_velocity_sigma_m_s;
  const Vector3d& v = belief.mean.v_W_m_s;
  return v.dot(spread.ldlt().solve(v)) > p.velocity_gate * p.velocity_gate;
}

// Resets attitude and velocity, removes their correlation with earlier states, and keeps the rate estimate.
void restart(const ImuSample& sample, Belief& belief, ErrorCovariance& F) {
  constexpr double kAnyTilt = 10.0, kAnyVelocity = 1e4;  // variances for any tilt [rad^2] and velocity [m^2/s^2]
  Navigation& n = belief.mean;
  const Vector3d up = (n.q_WI * sample.specific_force_m_s2).normalized();
  n.q_WI = (so3::shortest_arc(up, Vector3d::UnitZ()) * n.q_WI).normalized();
  n.v_W_m_s.setZero();
  F.topRows<6>().setZero();
  belief.covariance.topRows<6>().setZero();
  belief.covariance.leftCols<6>().setZero();
  belief.covariance.diagonal().head<6>() << Vector3d::Constant(kAnyTilt), Vector3d::Constant(kAnyVelocity);
}

void measure_rest(const StandstillSmoother::Params& p, const ImuSample& sample, Belief& belief) {
  const double still = p.rest_velocity_sigma_m_s * p.rest_velocity_sigma_m_s;
  for (int j = 0; j < 3; ++j) measure_component(3 + j, -belief.mean.v_W_m_s[j], still, belief);
  // At rest, a horizontal component of the specific force in world axes indicates a tilt error.
  const double tilt_sigma = p.rest_force_m_s2 / p.gravity_m_s2;
  const Vector3d up = (belief.mean.q_WI * sample.specific_force_m_s2).normalized();
  const double tilt[2] = {up.y(), -up.x()};  // small rotation from `up` to the vertical
  for (int j = 0; j < 2; ++j) measure_component(j, tilt[j], tilt_sigma * tilt_sigma, belief);
}

std::vector<bool> standstills(const StandstillSmoother::Params& p, std::span<const ImuSample> samples) {
  std::vector<bool> rest(samples.size(), false);
  std::size_t first = 0;
  for (std::size_t k = 0; k <= samples.size(); ++k) {
    const bool still = k < samples.size() && samples[k].angular_velocity_rad_s.norm() < p.rest_rate_rad_s &&
                       std::abs(samples[k].specific_force_m_s2.norm() - p.gravity_m_s2) < p.rest_force_m_s2;
    if (still) continue;
    if (k > first && seconds(samples[k - 1].time_ns - samples[first].time_ns) >= p.rest_s) {
      std::fill(rest.begin() + static_cast<std::ptrdiff_t>(first), rest.begin() + static_cast<std::ptrdiff_t>(k), true);
    }
    first = k + 1;
  }
  return rest;
}

// Performs one Rauch-Tung-Striebel step backward in time, from the next sample to this sample.
void smooth(const Step& next, Belief& now, const Belief& next_smoothed) {
  const ErrorCovariance& ahead = next.before.covariance;
  const ErrorCovariance gain = ahead.ldlt().solve(next.transition * now.covariance).transpose();
  now.mean.add(gain * next_smoothed.mean.minus(next.before.mean));
  now.covariance += (gain * (next_smoothed.covariance - ahead) * gain.transpose()).eval();
}

}  // namespace

StandstillSmoother::StandstillSmoother(const Params& params)
    : params_(params), rails_({.axis_aligned_rails = params.rails, .tilted = params.tilted_rails}) {
  require_valid_fields(params);
}

Status StandstillSmoother::estimate(std::span<const ImuSample> samples, std::vector<RateState>& out) const {
  if (Status status = check_recording(samples, 2, params_.gap_max_s); !status.ok()) return status;
  const std::size_t count = samples.size();
  const std::vector<Clipping> clippings = rails_.find(samples).clippings;
  const std::vector<bool> rest = standstills(params_, samples);
  const double period_s = median_period_s(samples);
  const Noise noise{params_.gyro_noise_density * params_.gyro_noise_density / period_s,
                    params_.accel_noise_density * params_.accel_noise_density / period_s +
                        params_.accel_error_m_s2 * params_.accel_error_m_s2};

  std::vector<Step> steps(count);
  Belief belief;
  belief.mean.q_WI =
      so3::shortest_arc(samples.front().specific_force_m_s2.stableNormalized(), Vector3d::UnitZ()).normalized();
  if (!belief.mean.q_WI.coeffs().allFinite()) belief.mean.q_WI.setIdentity();
  belief.mean.rate_rad_s = samples.front().angular_velocity_rad_s;
  const BoundedAcceleration process(params_.jerk_psd, params_.rate_sigma_rad_s);
  belief.covariance.diagonal() << Vector3d::Constant(0.1), Vector3d::Constant(1.0),
      Vector3d::Constant(process.start()(0, 0)), Vector3d::Constant(process.start()(1, 1));
  for (std::size_t k = 0; k < count; ++k) {
    Step& step = steps[k];
    const double dt_s = k == 0 ? 0.0 : seconds(samples[k].time_ns - samples[k - 1].time_ns);
    if (k > 0) predict(params_, process, noise, samples[k], dt_s, belief, step.transition);
    if (k > 0 && rest[k] && !rest[k - 1] && is_lost(params_, samples[k], belief)) {
      restart(samples[k], belief, step.transition);
    }
    step.before = belief;
    const int clipped = clippings[k].gyro | clippings[k].unusable_gyro;
    for (int j = 0; j < 3; ++j) {
      if ((clippings[k].gyro >> j & 1) != 0) hold(params_, samples[k].angular_velocity_rad_s[j], j, belief);
      if ((clipped >> j & 1) != 0) continue;
      const double residual = samples[k].angular_velocity_rad_s[j] - belief.mean.rate_rad_s[j];
      measure_component(6 + j, residual, noise.gyro_variance, belief);
    }
    if (rest[k]) measure_rest(params_, samples[k], belief);
    step.after = belief;
  }

  std::vector<RateState> states(count);
  for (std::size_t k = count; k-- > 0;) {
    Belief smoothed = steps[k].after;
    if (k + 1 < count) smooth(steps[k + 1], smoothed, belief);
    belief = smoothed;
    RateState& state = states[k];
    state.time_ns = samples[k].time_ns;
    state.clipped_axes = clippings[k].gyro | clippings[k].unusable_gyro;
    state.source = state.clipped_axes == 0 ? RateSource::measured : RateSource::bounded_only;
    for (int j = 0; j < 3; ++j) {
      const double reading = samples[k].angular_velocity_rad_s[j], side = std::copysign(1.0, reading);
      const bool bound = (clippings[k].gyro >> j & 1) != 0, clipped = (state.clipped_axes >> j & 1) != 0;
      const double low = bound ? std::min(std::abs(reading), params_.rate_max_rad_s) : -params_.rate_max_rad_s;
      const double bridged = side * std::clamp(side * smoothed.mean.rate_rad_s[j], low, params_.rate_max_rad_s);
      state.w_WI_I_rad_s[j] = clipped ? bridged : reading;
      state.covariance_rad2_s2(j, j) =
          clipped ? std::max(smoothed.covariance(6 + j, 6 + j), noise.gyro_variance) : noise.gyro_variance;
    }
  }
  out = std::move(states);
  return {};
}

}  // namespace tumble::baselines
