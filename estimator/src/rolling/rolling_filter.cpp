// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/rolling_filter.hpp"

#include <cmath>

#include "rolling_filter_states.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/attitude/timing.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kSmallest = 1e-12;
constexpr double kSlowForceTau_s = 0.1;

void require_sigmas(const RollingFilter::Params& p) {
  require_within("tilt_sigma_rad", p.tilt_sigma_rad, 0.0, 1e3);
  require_within("velocity_sigma_m_s", p.velocity_sigma_m_s, 0.0, 1e3);
  require_within("gyro_bias_sigma_rad_s", p.gyro_bias_sigma_rad_s, 0.0, 1e3);
  require_within("accel_bias_sigma_m_s2", p.accel_bias_sigma_m_s2, 0.0, 1e3);
  require_within("accel_scale_sigma", p.accel_scale_sigma, 0.0, 1e3);
  require_within("gyro_scale_sigma", p.gyro_scale_sigma, 0.0, 1e3);
  require_within("accel_delay_sigma_s", p.accel_delay_sigma_s, 0.0, 1e3);
  require_within("lever_arm_sigma_m", p.lever_arm_sigma_m, 0.0, 1e3);
}

void require_noise(const RollingFilter::Params& p) {
  require_within("attitude_walk_rad_sqrts", p.attitude_walk_rad_sqrts, kSmallest, 1e3);
  require_within("rate_error_sqrts", p.rate_error_sqrts, kSmallest, 1e3);
  require_within("velocity_walk_m_s_sqrts", p.velocity_walk_m_s_sqrts, kSmallest, 1e3);
  require_within("gyro_bias_walk_rad_s_sqrts", p.gyro_bias_walk_rad_s_sqrts, kSmallest, 1e3);
  require_within("accel_bias_walk_m_s2_sqrts", p.accel_bias_walk_m_s2_sqrts, kSmallest, 1e3);
  require_within("grip_sigma_m_s", p.grip_sigma_m_s, kSmallest, 1e3);
  require_within("grip_sigma_share", p.grip_sigma_share, kSmallest, 1e3);
  require_within("vertical_sigma_m_s", p.vertical_sigma_m_s, kSmallest, 1e3);
  require_within("rest_velocity_sigma_m_s", p.rest_velocity_sigma_m_s, kSmallest, 1e3);
  require_within("rest_rate_sigma_rad_s", p.rest_rate_sigma_rad_s, kSmallest, 1e3);
}

void require_modes(const RollingFilter::Params& p) {
  require_within("slip_begins_per_s", p.slip_begins_per_s, kSmallest, 1e3);
  require_within("slip_ends_per_s", p.slip_ends_per_s, kSmallest, 1e3);
  require_within("bump_begins_per_s", p.bump_begins_per_s, kSmallest, 1e3);
  require_within("bump_ends_per_s", p.bump_ends_per_s, kSmallest, 1e3);
  require_within("slip_bump_per_s", p.slip_bump_per_s, kSmallest, 1e3);
  require_within("event_shortest_s", p.event_shortest_s, 0.0, 10.0);
  require_within("rest_rate_rad_s", p.rest_rate_rad_s, kSmallest, 10.0);
  require_within("rest_force_m_s2", p.rest_force_m_s2, kSmallest, 100.0);
  require_within("rest_time_s", p.rest_time_s, 0.0, 100.0);
}

}  // namespace

RollingFilter::RollingFilter(const Params& p) : params_(p) {
  require_within("radius_m", p.radius_m, kSmallest, 10.0);
  require_within("gravity_m_s2", p.gravity_m_s2, kSmallest, 100.0);
  require_within("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
  require_within("node_s", p.node_s, 1e-3, 0.1);
  require_within("gap_max_s", p.gap_max_s, 1e-9, 1.0);
  require_sigmas(p);
  require_noise(p);
  require_modes(p);
}

Status RollingFilter::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check(sample); !bad.ok()) return bad;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s); !bad.ok()) return bad;
    // a node closes one sample late, because the rate at its end lies between two samples
    if (state.node_s >= params_.node_s - 0.5 * dt_s) close_node(sample.angular_velocity_rad_s, state);
    integrate(sample, dt_s, state);
  } else {
    if (const Status bad = level(sample.specific_force_m_s2, state.q_nominal); !bad.ok()) return bad;
    start(state);
    state.slow_force_m_s2 = sample.specific_force_m_s2;
  }
  state.last_rate_rad_s = sample.angular_velocity_rad_s;
  state.last_time_ns = sample.time_ns;
  report(state);
  return {};
}

void RollingFilter::start(State& state) const {
  state.p_WI_m = state.q_nominal * params_.lever_arm_m;
  Hypothesis& h = state.hypotheses[0];
  auto prior = h.P.diagonal();
  prior.segment<2>(kAttitude).setConstant(squared(params_.tilt_sigma_rad));  // the heading defines the world's x axis
  prior.segment<3>(kVelocity).setConstant(squared(params_.velocity_sigma_m_s));
  prior.segment<3>(kGyroBias).setConstant(squared(params_.gyro_bias_sigma_rad_s));
  prior.segment<3>(kAccelBias).setConstant(squared(params_.accel_bias_sigma_m_s2));
  prior.segment<9>(kAccelScale).setConstant(squared(params_.accel_scale_sigma));
  prior.segment<9>(kGyroScale).setConstant(squared(params_.gyro_scale_sigma));
  prior[kDelay] = squared(params_.accel_delay_sigma_s);
  prior.segment<3>(kLeverArm).setConstant(squared(params_.lever_arm_sigma_m));
  state.count = 1;
  state.started = true;
}

void RollingFilter::integrate(const ImuSample& sample, double dt_s, State& state) const {
  const Eigen::Vector3d& w_raw = sample.angular_velocity_rad_s;
  const Eigen::Vector3d& f_raw = sample.specific_force_m_s2;
  const Eigen::Vector3d w = w_raw - state.gyro_bias_rad_s - state.gyro_scale * w_raw;
  Eigen::Vector3d f = f_raw - state.accel_bias_m_s2 - state.accel_scale * f_raw - state.accel_delay_s * w.cross(f_raw);
  // the mean of a force that turns in the sensor over the window is shorter across the axis by (|w| dt)^2 / 24
  f -= dt_s * dt_s / 24.0 * w.cross(w.cross(f));
  const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * w);
  const Eigen::Quaterniond q_mid = state.q_nominal * half;
  const Eigen::Matrix3d R_T = dt_s * q_mid.toRotationMatrix();
  state.q_nominal = (q_mid * half).normalized();
  const Eigen::Vector3d pushed = R_T * f;
  const Eigen::Vector3d gained = pushed - dt_s * params_.gravity_m_s2 * Eigen::Vector3d::UnitZ();
  state.p_WI_m += dt_s * (state.v_WI_m_s + 0.5 * gained);
  state.v_WI_m_s += gained;
  state.R_s += R_T;
  state.f_W_m_s += pushed;
  for (int axis = 0; axis < 3; ++axis) {
    state.R_f.middleCols<3>(3 * axis) += f_raw[axis] * R_T;
    state.R_w.middleCols<3>(3 * axis) += w_raw[axis] * R_T;
  }
  state.R_wxf += R_T * w.cross(f_raw);
  state.w_I_rad += dt_s * w;
  state.f_I_m_s += dt_s * f_raw;
  state.turned_rad2_s += dt_s * w.squaredNorm();
  state.node_s += dt_s;
}

void RollingFilter::close_node(const Eigen::Vector3d& next_rate_rad_s, State& state) const {
  predict(state);
  detect_rest(state);
  const Eigen::Vector3d raw = 0.5 * (state.last_rate_rad_s + next_rate_rad_s);
  if (state.at_rest) {
    correct_at_rest(state);
  } else {
    choose_modes(raw, state);
  }
  state.position_covariance_m2 = state.hypotheses[0].P.block<3, 3>(kPosition, kPosition) + position_spread(state);
  if (state.count == 1) rebase(state);
  state.R_s.setZero();
  state.f_W_m_s.setZero();
  state.R_f.setZero();
  state.R_w.setZero();
  state.R_wxf.setZero();
  state.w_I_rad.setZero();
  state.f_I_m_s.setZero();
  state.turned_rad2_s = 0.0;
  state.node_s = 0.0;
  ++state.node;
}

void RollingFilter::predict(State& state) const {
  const double h = state.node_s;
  // F = I + B, B with nine rows: attitude, velocity, position
  Eigen::Matrix<double, 9, kStates> B = Eigen::Matrix<double, 9, kStates>::Zero();
  B.block<3, 3>(kAttitude, kGyroBias) = -state.R_s;
  B.block<3, 9>(kAttitude, kGyroScale) = -state.R_w;
  B.block<3, 3>(kVelocity, kAttitude) = -so3::hat(state.f_W_m_s);
  B.block<3, 3>(kVelocity, kAccelBias) = -state.R_s;
  B.block<3, 9>(kVelocity, kAccelScale) = -state.R_f;
  B.block<3, 1>(kVelocity, kDelay) = -state.R_wxf;
  B.middleRows<3>(kPosition) = 0.5 * h * B.middleRows<3>(kVelocity);
  B.block<3, 3>(kPosition, kVelocity) += h * Eigen::Matrix3d::Identity();

  const double attitude =
      squared(params_.attitude_walk_rad_sqrts) * h + squared(params_.rate_error_sqrts) * state.turned_rad2_s;
  const double velocity = squared(params_.velocity_walk_m_s_sqrts) * h;
  for (int k = 0; k < state.count; ++k) {
    Hypothesis& hypothesis = state.hypotheses[static_cast<std::size_t>(k)];
    hypothesis.x.head<9>() += (B * hypothesis.x).eval();
    hypothesis.P.topRows<9>() += (B * hypothesis.P).eval();
    hypothesis.P.leftCols<9>() += (hypothesis.P * B.transpose()).eval();
    hypothesis.P = (0.5 * (hypothesis.P + hypothesis.P.transpose())).eval();
    auto diagonal = hypothesis.P.diagonal();
    diagonal.segment<3>(kAttitude).array() += attitude;
    diagonal.segment<3>(kVelocity).array() += velocity;
    diagonal.segment<3>(kPosition).array() += velocity * h * h / 3.0;
    diagonal.segment<3>(kGyroBias).array() += squared(params_.gyro_bias_walk_rad_s_sqrts) * h;
    diagonal.segment<3>(kAccelBias).array() += squared(params_.accel_bias_walk_m_s2_sqrts) * h;
  }
}

void RollingFilter::detect_rest(State& state) const {
  const double h = state.node_s;
  const Eigen::Vector3d f_mean = state.f_I_m_s / h;
  const bool quiet = (state.w_I_rad / h).norm() < params_.rest_rate_rad_s &&
                     (f_mean - state.slow_force_m_s2).norm() < params_.rest_force_m_s2;
  state.slow_force_m_s2 += -std::expm1(-h / kSlowForceTau_s) * (f_mean - state.slow_force_m_s2);
  state.rest_s = quiet ? state.rest_s + h : 0.0;
  state.at_rest = quiet && state.rest_s >= params_.rest_time_s;
}

/// Moves the errors of the only hypothesis into the nominal trajectory and constants.
void RollingFilter::rebase(State& state) const {
  Vector& x = state.hypotheses[0].x;
  state.q_nominal = (so3::exp(x.segment<3>(kAttitude)) * state.q_nominal).normalized();
  state.v_WI_m_s += x.segment<3>(kVelocity);
  state.p_WI_m += x.segment<3>(kPosition);
  state.gyro_bias_rad_s += x.segment<3>(kGyroBias);
  state.accel_bias_m_s2 += x.segment<3>(kAccelBias);
  state.accel_scale += Eigen::Map<const Eigen::Matrix3d>(x.data() + kAccelScale);
  state.gyro_scale += Eigen::Map<const Eigen::Matrix3d>(x.data() + kGyroScale);
  state.accel_delay_s += x[kDelay];
  state.lever_arm_error_m += x.segment<3>(kLeverArm);
  x.setZero();
}

void RollingFilter::report(State& state) const {
  const Hypothesis& best = state.hypotheses[0];
  const double since_node_s = state.node_s;
  state.q_WI = (so3::exp(best.x.segment<3>(kAttitude)) * state.q_nominal).normalized();
  const Eigen::Vector3d arm_W =
      state.q_WI * (params_.lever_arm_m + state.lever_arm_error_m + best.x.segment<3>(kLeverArm));
  const Eigen::Vector3d w_W = state.q_WI * (state.last_rate_rad_s - state.gyro_bias_rad_s);
  const Eigen::Vector3d v_error = best.x.segment<3>(kVelocity);
  state.p_WG_m = state.p_WI_m + best.x.segment<3>(kPosition) + since_node_s * v_error - arm_W;
  state.v_WG_m_s = state.v_WI_m_s + v_error - w_W.cross(arm_W);
  state.mode = best.mode;
}

}  // namespace tumble
