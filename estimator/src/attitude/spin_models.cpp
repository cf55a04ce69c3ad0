// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/spin_tracker.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "tumble/common/detail/scalar_update.hpp"

namespace tumble {

namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;

constexpr int kRate = 0, kAcceleration = 1;
constexpr int kTurning = 2, kFixed = 4;               // state indices of Modulation
constexpr int kArm = 2, kForce = 4, kWorldForce = 6;  // state indices of Centripetal
constexpr double kJerk_rad_s3_sqrts = 50.0;           // root density of the angular jerk about the spin axis
// The rate perpendicular to the spin axis is the sum of a vector that is constant in the world and a vector that is
// constant in the body. Each component of the world-fixed and the body-fixed vector is a random walk, with the standard
// deviation kWalk_rad_s_sqrts after one second. Vibration adds an error with the standard deviation kVibration_rad_s to
// the gyro readings. Vibration errors are correlated over time, so all readings within kReadingInterval_s together
// count as one reading. SpinFilter::variance_ratio scales the variances of random walk and vibration: carried.md (C46).
constexpr double kWalk_rad_s_sqrts = 1.0, kVibration_rad_s = 0.3;
// prior standard deviation of the lever arm from the spin axis to the IMU, about the size of the body
constexpr double kBodySize_m = 0.3;
constexpr double kReadingInterval_s = 0.01;
constexpr double kScaleMemory_s = 0.5;        // averaging time of the variance ratio
constexpr double kVarianceRatioMax = 1e3;     // bounds of the variance ratio
constexpr double kReadingSigma_rad_s = 0.02;  // standard deviation of an unsaturated gyro reading
constexpr double kRailSigma_rad_s = 0.1;      // standard deviation of a saturated gyro reading as a lower bound
constexpr double kStartSigma_rad_s = 1.0, kStartSigma_rad_s2 = 10.0, kStartSaturatedRatio = 0.5;
constexpr double kForceSigma_m_s2 = 0.3, kForceWalk_m_s2_sqrts = 0.1, kVibration_m_s2 = 0.5;
// During flight, external forces change smoothly. If the variance ratio of the residuals exceeds
// kSmoothVarianceRatioMax, the body has contact or vibrates.
constexpr double kSmoothVarianceRatioMax = 20.0, kContradiction = 1e3;
// ratio of the root densities of the angular jerk in Centripetal and Modulation; below 1, because the rate of a spin in
// flight changes slowly
constexpr double kForceJerkRatio = 0.3;
constexpr double kWorldForceSigma_m_s2 = 3.0, kWorldForceWalk_m_s2_sqrts = 1.0;

Vector2d across(const Eigen::Vector3d& v, int axis) {
  return {v[(axis + 1) % 3], v[(axis + 2) % 3]};
}

bool is_set(std::uint8_t axes, int axis) {
  return (axes >> axis & 1u) != 0;
}

bool across_is_valid(std::uint8_t axes, int axis) {
  return (axes & 7u & ~(1u << axis)) == 0;
}

SpinReading rate_reading(const ImuSample& sample, std::uint8_t saturated_axes, int axis, double dt_s) {
  SpinReading out;
  out.rate_rad_s = sample.angular_velocity_rad_s[axis];
  out.saturated = is_set(saturated_axes, axis);
  out.dt_s = dt_s;
  return out;
}

template <int N>
SpinFilter<N> start_filter(const SpinReading& reading) {
  SpinFilter<N> out;
  out.x[kRate] = reading.rate_rad_s;
  out.covariance.diagonal().setConstant(squared(kStartSigma_rad_s));
  out.covariance(kAcceleration, kAcceleration) = squared(kStartSigma_rad_s2);
  if (reading.saturated) out.covariance(kRate, kRate) = squared(kStartSaturatedRatio * reading.rate_rad_s);
  return out;
}

template <int N>
void predict_spin(const SpinFilter<N>& filter, double jerk_rad_s3_sqrts, double dt_s, SpinPrediction<N>& out) {
  out.transition_matrix(kRate, kAcceleration) = dt_s;
  out.x[kRate] += dt_s * filter.x[kAcceleration];
  out.covariance = out.transition_matrix * filter.covariance * out.transition_matrix.transpose();
  const double jerk = squared(jerk_rad_s3_sqrts) * dt_s;
  out.covariance(kRate, kRate) += jerk * dt_s * dt_s / 3.0;
  out.covariance(kRate, kAcceleration) += 0.5 * jerk * dt_s;
  out.covariance(kAcceleration, kRate) += 0.5 * jerk * dt_s;
  out.covariance(kAcceleration, kAcceleration) += jerk;
}

// If `related` is 1, rotates the two-dimensional vector at the state index `part` by the negative spin angle. A vector
// that is constant in the world turns by the negative spin angle in body axes.
template <int N>
void turn_part(const SpinFilter<N>& filter, int part, double related, double dt_s, SpinPrediction<N>& out) {
  const auto& x = filter.x;
  const double angle = -related * dt_s * (x[kRate] + 0.5 * dt_s * x[kAcceleration]);
  const double c = std::cos(angle), s = std::sin(angle);
  const Matrix2d turn = (Matrix2d() << c, -s, s, c).finished();
  const Vector2d by_angle = (Matrix2d() << -s, -c, c, -s).finished() * x.template segment<2>(part);
  out.transition_matrix.template block<2, 2>(part, part) = turn;
  out.transition_matrix.template block<2, 1>(part, kRate) = -related * dt_s * by_angle;
  out.transition_matrix.template block<2, 1>(part, kAcceleration) = -0.5 * related * dt_s * dt_s * by_angle;
  out.x.template segment<2>(part) = turn * x.template segment<2>(part);
}

// Returns the log likelihood of the readings perpendicular to the spin axis: carried.md (C46), (C47).
template <int N>
double update_across(const Eigen::Matrix<double, 2, N>& H, const Vector2d& innovation, double sigma, double dt_s,
                     SpinFilter<N>& filter) {
  const double variance =
      filter.variance_ratio * squared(sigma) * std::max(1.0, kReadingInterval_s / std::max(dt_s, 1e-6));
  const Matrix2d noise = variance * Matrix2d::Identity();
  const Matrix2d S = H * filter.covariance * H.transpose() + noise;
  const double squared_norm = innovation.dot(S.inverse() * innovation);
  filter.x += vector_update<2, N>(H, innovation, noise, filter.covariance);
  const double ratio = 1.0 + std::min(1.0, dt_s / kScaleMemory_s) * (0.5 * squared_norm - 1.0);
  filter.variance_ratio = std::clamp(ratio * filter.variance_ratio, 1.0 / kVarianceRatioMax, kVarianceRatioMax);
  return -0.5 * (squared_norm + std::log(S.determinant()));
}

// A saturated gyro reading is a lower bound of the rate's magnitude, and changes the estimate only if the estimated
// magnitude is smaller. After an overflow, the reading has the wrong sign and no information. If `keeps_variance` is
// true, a saturated reading does not reduce the variance.
template <int N>
void update_rate(const SpinReading& reading, bool keeps_variance, SpinFilter<N>& filter) {
  const double innovation = reading.rate_rad_s - filter.x[kRate];
  if (!reading.saturated) {
    filter.x += kalman_update_of_component<N>(kRate, innovation, squared(kReadingSigma_rad_s), filter.covariance);
  } else if (innovation * reading.rate_rad_s > 0.0 && filter.x[kRate] * reading.rate_rad_s > 0.0) {
    Eigen::Matrix<double, N, N> bounded = filter.covariance;
    filter.x += kalman_update_of_component<N>(kRate, innovation, squared(kRailSigma_rad_s), bounded);
    if (!keeps_variance) filter.covariance = bounded;
  }
  filter.covariance = (0.5 * (filter.covariance + filter.covariance.transpose())).eval();
}

}  // namespace

SpinReading Modulation::reading(const ImuSample& sample, std::uint8_t saturated_axes, int axis, double dt_s) const {
  SpinReading out = rate_reading(sample, saturated_axes, axis, dt_s);
  out.across = tumble::across(sample.angular_velocity_rad_s, axis);
  out.across_valid = across_is_valid(saturated_axes, axis);
  return out;
}

Modulation::Filter Modulation::start(const SpinReading& reading) const {
  Filter out = start_filter<kStates>(reading);
  out.x.segment<2>(kFixed) = reading.across;
  return out;
}

SpinPrediction<Modulation::kStates> Modulation::predict(const Filter& filter, double related, double dt_s) const {
  SpinPrediction<kStates> out;
  out.transition_matrix.setIdentity();
  out.x = filter.x;
  turn_part(filter, kTurning, related, dt_s, out);
  predict_spin(filter, kJerk_rad_s3_sqrts, dt_s, out);
  out.covariance.diagonal().segment<4>(kTurning).array() += filter.variance_ratio * squared(kWalk_rad_s_sqrts) * dt_s;
  return out;
}

double Modulation::update(const SpinPrediction<kStates>& predicted, const SpinReading& reading, double,
                          Filter& filter) const {
  filter.x = predicted.x;
  filter.covariance = predicted.covariance;
  double log_likelihood = 0.0;
  if (reading.across_valid) {
    Eigen::Matrix<double, 2, kStates> H = Eigen::Matrix<double, 2, kStates>::Zero();
    H.block<2, 2>(0, kTurning).setIdentity();
    H.block<2, 2>(0, kFixed).setIdentity();
    log_likelihood = update_across<kStates>(H, reading.across - H * filter.x, kVibration_rad_s, reading.dt_s, filter);
  }
  update_rate(reading, false, filter);
  return log_likelihood;
}

SpinReading Centripetal::reading(const ImuSample& sample, std::uint8_t saturated_axes, int axis, double dt_s) const {
  SpinReading out = rate_reading(sample, saturated_axes, axis, dt_s);
  out.across = tumble::across(sample.specific_force_m_s2, axis);
  out.across_valid = across_is_valid(static_cast<std::uint8_t>(saturated_axes >> 3), axis);
  return out;
}

Centripetal::Filter Centripetal::start(const SpinReading& reading) const {
  Filter out = start_filter<kStates>(reading);
  out.covariance.diagonal().segment<2>(kArm).setConstant(squared(kBodySize_m));
  out.covariance.diagonal().segment<2>(kForce).setConstant(squared(kForceSigma_m_s2));
  out.covariance.diagonal().segment<2>(kWorldForce).setConstant(squared(kWorldForceSigma_m_s2));
  return out;
}

SpinPrediction<Centripetal::kStates> Centripetal::predict(const Filter& filter, double related, double dt_s) const {
  SpinPrediction<kStates> out;
  out.transition_matrix.setIdentity();
  out.x = filter.x;
  turn_part(filter, kWorldForce, related, dt_s, out);
  predict_spin(filter, kForceJerkRatio * kJerk_rad_s3_sqrts, dt_s, out);
  const double scale = filter.variance_ratio * dt_s;
  out.covariance.diagonal().segment<2>(kForce).array() += scale * squared(kForceWalk_m_s2_sqrts);
  out.covariance.diagonal().segment<2>(kWorldForce).array() += scale * squared(kWorldForceWalk_m_s2_sqrts);
  return out;
}

double Centripetal::update(const SpinPrediction<kStates>& predicted, const SpinReading& reading, double related,
                           Filter& filter) const {
  filter.x = predicted.x;
  filter.covariance = predicted.covariance;
  double log_likelihood = 0.0;
  if (reading.across_valid) {
    const double rate = filter.x[kRate], acceleration = filter.x[kAcceleration];
    const Vector2d arm = filter.x.segment<2>(kArm), turned(-arm.y(), arm.x());
    const Matrix2d by_arm = (Matrix2d() << -rate * rate, -acceleration, acceleration, -rate * rate).finished();
    Eigen::Matrix<double, 2, kStates> H = Eigen::Matrix<double, 2, kStates>::Zero();
    H.col(kRate) = -2.0 * related * rate * arm;
    H.col(kAcceleration) = related * turned;
    H.block<2, 2>(0, kArm) = related * by_arm;
    H.block<2, 2>(0, kForce).setIdentity();
    H.block<2, 2>(0, kWorldForce).setIdentity();
    const Vector2d predicted_force =
        related * by_arm * arm + filter.x.segment<2>(kForce) + filter.x.segment<2>(kWorldForce);
    log_likelihood = update_across<kStates>(H, reading.across - predicted_force, kVibration_m_s2, reading.dt_s, filter);
    if (related > 0.0 && filter.variance_ratio > kSmoothVarianceRatioMax) log_likelihood -= kContradiction;
  }
  update_rate(reading, true, filter);
  return log_likelihood;
}

}  // namespace tumble
