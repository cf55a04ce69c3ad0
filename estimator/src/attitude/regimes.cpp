// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/regimes.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tumble/common/detail/scalar_update.hpp"

namespace tumble {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

constexpr double kTwoPi = 2.0 * std::numbers::pi;
constexpr double kContactMin_m_s2 = 1.0, kContactMax_m_s2 = 1000.0;
// standard deviation of the specific force in free flight due to drag and the sensor's bandwidth
constexpr double kFlightForceSigma_m_s2 = 0.3;
// additional standard deviation of the specific force in free flight, as a fraction of the specific force due to
// rotation
constexpr double kFlightForceShare = 0.05;
constexpr double kHandSigma_m_s2 = 5.0;
constexpr double kHandDistance_m = 0.05;  // distance of the IMU from the hand
constexpr double kRestRate_rad_s = 0.5;   // readings with a lower rate do not change the probabilities
constexpr double kContacts_hz = 5.0;      // mean number of changes between flight and contact per second
constexpr double kThrows_hz = 0.02;       // mean number of throws and catches per second

double log_gaussian(double squared_norm, double variance) {
  return -1.5 * std::log(kTwoPi * variance) - 0.5 * squared_norm / variance;
}

// Returns the log density of a measured specific force of norm n, if the true specific force has norm g and any
// direction: carried.md (C34).
double log_density_near_gravity(double n, double g, double variance) {
  const double x = n * g / variance;
  const double log_sinh_x = x < 1e-3 ? 0.0 : x - std::log(2.0 * x) + std::log1p(-std::exp(-2.0 * x));
  return log_gaussian(n * n + g * g, variance) + log_sinh_x;
}

// For one third of the hand-held samples, the standard deviation of the specific force is assumed five times larger
// than for the other samples: carried.md (C32).
constexpr double kRoughly = 3.0, kRougher = 5.0;

double log_density_hand_held(double n, double g, double hand_variance, double grip_variance) {
  const double gentle = log_density_near_gravity(n, g, hand_variance + grip_variance);
  const double rough = log_density_near_gravity(n, g, kRougher * kRougher * hand_variance + grip_variance);
  const double larger = std::max(gentle, rough);
  return larger + std::log(((kRoughly - 1.0) * std::exp(gentle - larger) + std::exp(rough - larger)) / kRoughly);
}

// During contact, the body rolls gently with the prior probability `kRolls`, and has an impact with the prior
// probability 1 - `kRolls`. The specific force of an impact may have any magnitude: carried.md (C33).
constexpr double kRolls = 0.5;

double log_density_in_contact(double left, double n, double g, double variance) {
  const double within = std::max(left, kContactMin_m_s2);
  const double struck = 1.0 / (within * std::log(kContactMax_m_s2 / kContactMin_m_s2) * 2.0 * kTwoPi * within * within);
  return std::log((1.0 - kRolls) * struck + kRolls * std::exp(log_density_near_gravity(n, g, variance)));
}

Vector3d angular_acceleration(std::span<const AngularRateState> rates, std::size_t k) {
  const std::size_t a = k == 0 ? 0 : k - 1, b = std::min(k + 1, rates.size() - 1);
  const double dt_s = seconds(rates[b].time_ns - rates[a].time_ns);
  if (!(dt_s > 0.0)) return Vector3d::Zero();
  return (rates[b].w_WI_I_rad_s - rates[a].w_WI_I_rad_s) / dt_s;
}

// See carried.md (C36).
Matrix3d regime_transition_matrix(double dt_s) {
  const double contacts = 1.0 - std::exp(-kContacts_hz * dt_s), throws = 0.5 * (1.0 - std::exp(-kThrows_hz * dt_s));
  Matrix3d out;
  out << 1.0 - contacts - throws, contacts, throws,  //
      contacts, 1.0 - contacts - throws, throws,     //
      throws, throws, 1.0 - 2.0 * throws;
  return out.cwiseMax(1e-300);
}

}  // namespace

MotionRegimeEvidence::MotionRegimeEvidence(const Params& params) : params_(params) {
  require_valid_fields(params);
}

// Returns the likelihoods of free flight, contact and hand-held motion: carried.md (C30), (C31), (C32), (C33), (C35).
Vector3d MotionRegimeEvidence::likelihood(double dt_s, const ImuSample& sample, const AngularRateState& rate,
                                          const Vector3d& alpha, const Vector3d& lever_arm_m,
                                          double lever_arm_variance_m2) const {
  const Vector3d& w = rate.w_WI_I_rad_s;
  const double arm_m = lever_arm_m.norm();
  const Vector3d turning = alpha.cross(lever_arm_m) + w.cross(w.cross(lever_arm_m));
  const double turn = w.squaredNorm() + alpha.norm(), rate_variance = rate.covariance_rad2_s2.trace();
  const double flight_variance = squared(kFlightForceSigma_m_s2) + squared(kFlightForceShare) * turning.squaredNorm() +
                                 turn * turn * lever_arm_variance_m2 +
                                 4.0 * w.squaredNorm() * arm_m * arm_m * rate_variance;
  const double hand_variance = squared(kHandSigma_m_s2);
  const double grip_variance = squared(kHandDistance_m * w.squaredNorm());
  const Vector3d& f = sample.specific_force_m_s2;
  const Vector3d left = f - turning;
  Vector3d logs(log_gaussian(left.squaredNorm(), flight_variance),
                log_density_in_contact(left.norm(), f.norm(), params_.gravity_m_s2, hand_variance + grip_variance),
                log_density_hand_held(f.norm(), params_.gravity_m_s2, hand_variance, grip_variance));
  if (w.norm() < kRestRate_rad_s) logs.setZero();
  logs *= std::min(1.0, dt_s / kMemory_s);
  return (logs.array() - logs.maxCoeff()).exp().cwiseMax(1e-300);
}

// See carried.md (C37).
RegimeProbabilities MotionRegimeEvidence::next(const RegimeProbabilities& before, double dt_s, const ImuSample& sample,
                                               const AngularRateState& rate, const Vector3d& alpha,
                                               const Vector3d& lever_arm_m,
                                               const Matrix3d& lever_arm_covariance_m2) const {
  const Vector3d predicted = regime_transition_matrix(dt_s) * Vector3d(before.flight, before.contact, before.hand_held);
  Vector3d after =
      predicted.cwiseProduct(likelihood(dt_s, sample, rate, alpha, lever_arm_m, lever_arm_covariance_m2.trace()));
  after /= after.sum();
  return {after[0], after[1], after[2]};
}

// See carried.md (C37).
Status MotionRegimeEvidence::find(std::span<const ImuSample> samples, std::span<const AngularRateState> rates,
                                  const Vector3d& lever_arm_m, const Matrix3d& lever_arm_covariance_m2,
                                  std::vector<RegimeProbabilities>& out) const {
  out.clear();
  const std::size_t count = samples.size();
  if (count == 0) return {ErrorCode::empty, "samples", 0.0, 1.0};
  if (rates.size() != count)
    return {ErrorCode::out_of_range, "rates", static_cast<double>(rates.size()), static_cast<double>(count)};

  const double arm_variance = lever_arm_covariance_m2.trace();
  std::vector<Vector3d> likelihood(count), forward(count);
  for (std::size_t k = 0; k < count; ++k) {
    const double dt_s = k == 0 ? kMemory_s : seconds(samples[k].time_ns - samples[k - 1].time_ns);
    likelihood[k] =
        this->likelihood(dt_s, samples[k], rates[k], angular_acceleration(rates, k), lever_arm_m, arm_variance);
    const Vector3d before =
        k == 0 ? Vector3d::Constant(1.0 / 3.0) : Vector3d(regime_transition_matrix(dt_s) * forward[k - 1]);
    forward[k] = before.cwiseProduct(likelihood[k]);
    forward[k] /= forward[k].sum();
  }
  out.resize(count);
  Vector3d backward = Vector3d::Ones();
  for (std::size_t k = count; k-- > 0;) {
    Vector3d both = forward[k].cwiseProduct(backward);
    both /= both.sum();
    out[k] = {both[0], both[1], both[2]};
    if (k == 0) break;
    backward = regime_transition_matrix(seconds(samples[k].time_ns - samples[k - 1].time_ns)) *
               Vector3d(backward.cwiseProduct(likelihood[k]));  // the transition matrix is symmetric
    backward /= backward.sum();
  }
  return {};
}

// See carried.md (C38). `share` is the probability that the rate state `second` is correct.
AngularRateState mix_rate_states(const AngularRateState& first, const AngularRateState& second, double share) {
  AngularRateState out = share > 0.5 ? second : first;
  const Vector3d apart = second.w_WI_I_rad_s - first.w_WI_I_rad_s;
  out.covariance_rad2_s2 = (1.0 - share) * first.covariance_rad2_s2 + share * second.covariance_rad2_s2 +
                           std::min(share, 1.0 - share) * apart * apart.transpose();
  return out;
}

}  // namespace tumble
