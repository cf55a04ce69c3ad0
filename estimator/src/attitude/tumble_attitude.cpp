// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/tumble_attitude.hpp"

#include <cmath>

#include "tumble/attitude/detail/timing.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

constexpr double kTiltSigmaStart_rad = 0.01;
constexpr double kVelocitySigmaStart_m_s = 0.1;
constexpr double kDisplacementSigmaStart_m = 0.1;
constexpr int kTilt = 0, kBias = 2, kVelocity = 5, kDisplacement = 7;

double squared(double x) {
  return x * x;
}

/// Kalman update by one scalar measurement of state `index` of attitude.md (A4): `innovation` is measurement minus
/// estimate.
void update(int index, double innovation, double variance, TumbleAttitude::State& state) {
  const Eigen::Matrix<double, TumbleAttitude::kStates, 1> correction =
      component_update(index, innovation, variance, state.covariance);
  state.q_WI = (so3::exp({correction[kTilt], correction[kTilt + 1], 0.0}) * state.q_WI).normalized();
  state.bias_rad_s += correction.segment<3>(kBias);
  state.v_W_m_s += correction.segment<2>(kVelocity);
  state.d_W_m += correction.segment<2>(kDisplacement);
}

}  // namespace

TumbleAttitude::TumbleAttitude(const Params& p) : params_(p), rests_(p.rest) {
  require_fields(p);
  require_within("lever_arm_m", p.lever_arm_m.norm(), 0.0, 10.0);
}

Status TumbleAttitude::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check(sample); !bad.ok()) return bad;
  if (!state.started) {
    if (const Status bad = level(sample.specific_force_m_s2, state.q_WI); !bad.ok()) return bad;
    start(state);
  } else {
    double dt_s = 0.0;
    if (const Status bad = elapsed(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s); !bad.ok()) return bad;
    // of the average so far the attitude before it is turned on
    if (state.average.readings == 0) {
      state.q_taken_WI = state.q_WI;
    } else {
      state.q_WI = state.q_taken_WI;
    }
    state.average.add(sample, dt_s);
    if (state.average.full(params_.reading_s, dt_s)) {
      take_average(state);
    } else {
      const Eigen::Vector3d rate = state.average.mean.angular_velocity_rad_s - state.bias_rad_s;
      if (!state.at_rest) state.q_WI = (state.q_WI * so3::exp(state.average.length_s * rate)).normalized();
    }
  }
  state.last_time_ns = sample.time_ns;
  return {};
}

void TumbleAttitude::take_average(State& state) const {
  const ImuSample reading = state.average.mean;
  const double length_s = state.average.length_s;
  state.average = {};
  state.q_taken_WI.setIdentity();
  state.at_rest = rests_.observe(reading, state.rest, state.bias_rad_s) && turns_by_bias_alone(state);
  integrate(reading, length_s, state);
  if (state.node_s >= params_.node_s - 0.5 * length_s) {
    predict_node(state);
    correct_node(state);
  }
}

/// attitude.md (A11a): whether the mean rate of the run is the bias, as well as both are known.
bool TumbleAttitude::turns_by_bias_alone(const State& state) const {
  const Eigen::Array3d off_rad_s = (state.rest.mean_rate_rad_s() - state.bias_rad_s).array();
  const Eigen::Array3d variance =
      state.covariance.diagonal().segment<3>(kBias).array() + squared(params_.rest_rate_sigma_rad_sqrts);  // of 1 s
  return (off_rad_s.square() <= squared(params_.rest_rate_sigmas) * variance).all();
}

void TumbleAttitude::start(State& state) const {
  state.covariance.diagonal().segment<2>(kTilt).setConstant(squared(kTiltSigmaStart_rad));
  state.covariance.diagonal().segment<3>(kBias).setConstant(squared(params_.bias_sigma_start_rad_s));
  state.covariance.diagonal().segment<2>(kVelocity).setConstant(squared(kVelocitySigmaStart_m_s));
  state.covariance.diagonal().segment<2>(kDisplacement).setConstant(squared(kDisplacementSigmaStart_m));
  state.started = true;
}

/// attitude.md (A5).
void TumbleAttitude::integrate(const ImuSample& sample, double dt_s, State& state) const {
  Eigen::Vector3d rate = sample.angular_velocity_rad_s - state.bias_rad_s;
  if (state.at_rest) rate.setZero();
  const Eigen::Quaterniond half = so3::exp(0.5 * dt_s * rate);
  const Eigen::Quaterniond q_mid = state.q_WI * half;
  const Eigen::Matrix3d R_mid = q_mid.toRotationMatrix();
  state.q_WI = (q_mid * half).normalized();
  state.R_WI_s += dt_s * R_mid;
  state.f_W_m_s += dt_s * (R_mid * sample.specific_force_m_s2);
  state.turned_rad2_s += dt_s * rate.squaredNorm();
  state.rate_rad_s = rate;
  state.node_s += dt_s;
}

/// attitude.md (A6), (A7), (A8).
void TumbleAttitude::predict_node(State& state) const {
  const double h = state.node_s;
  const double keep = std::exp(-h / params_.displacement_tau_s);
  const Eigen::Vector2d gained = state.f_W_m_s.head<2>();  // gravity has no horizontal part
  state.d_W_m = keep * state.d_W_m + h * (state.v_W_m_s + 0.5 * gained);
  state.v_W_m_s += gained;

  Covariance F = Covariance::Identity();
  if (!state.at_rest) F.block<2, 3>(kTilt, kBias) = -state.R_WI_s.topRows<2>();
  // horizontal part of phi x f; a heading error would turn accelerations, but the velocity is no reference for heading
  F(kVelocity, kTilt + 1) = state.f_W_m_s.z();
  F(kVelocity + 1, kTilt) = -state.f_W_m_s.z();
  F.block<2, 2>(kDisplacement, kVelocity) = h * Eigen::Matrix2d::Identity();
  F.block<2, 2>(kDisplacement, kDisplacement) = keep * Eigen::Matrix2d::Identity();
  state.covariance = (F * state.covariance * F.transpose()).eval();

  const double tilt =
      squared(params_.gyro_noise_rad_sqrts) * h + squared(params_.rate_error_sqrts) * state.turned_rad2_s;
  state.covariance.diagonal().segment<2>(kTilt).array() += tilt;
  state.covariance.diagonal().segment<3>(kBias).array() += squared(params_.bias_walk_rad_s_sqrts) * h;
  state.covariance.diagonal().segment<2>(kVelocity).array() += squared(params_.acceleration_noise_m_s_sqrts) * h;
}

/// Whether rolling is not to be believed at this node.
bool TumbleAttitude::watch_slip(const Eigen::Vector2d& misfit_m_s, State& state) const {
  const double misfit = misfit_m_s.norm();
  state.slip_s = state.slipping ? state.slip_s + state.node_s : 0.0;
  state.fits_s = misfit < 0.5 * params_.slip_velocity_m_s ? state.fits_s + state.node_s : 0.0;
  if (state.slipping) {
    state.slipping = !state.at_rest && state.fits_s <= params_.slip_quiet_s;
    if (state.slip_s > params_.slip_timeout_s) {
      // what the integral says by now is worth less than rolling
      state.covariance.diagonal().segment<2>(kVelocity).array() += squared(misfit);
      state.slipping = false;
    }
  } else {
    state.slipping = !state.at_rest && misfit > params_.slip_velocity_m_s;
  }
  return state.slipping;
}

/// attitude.md (A9), (A10).
void TumbleAttitude::correct_node(State& state) const {
  const double h = state.node_s;
  // velocity of the IMU by the turning of the body: about the centre, and of the centre that rolls
  const Eigen::Vector3d w_W = state.q_WI * state.rate_rad_s;
  const Eigen::Vector3d arm_W = state.q_WI * params_.lever_arm_m + params_.radius_m * Eigen::Vector3d::UnitZ();
  const Eigen::Vector2d turned = w_W.cross(arm_W).head<2>();
  const bool rolls = params_.radius_m > 0.0;
  if (state.at_rest) {
    if (rolls) watch_slip(turned - state.v_W_m_s, state);
    for (int axis = 0; axis < 2; ++axis) {
      update(kVelocity + axis, -state.v_W_m_s[axis], squared(params_.rest_velocity_sigma_m_s), state);
    }
  } else if (!rolls) {
    for (int axis = 0; axis < 2; ++axis) {
      update(kVelocity + axis, turned[axis] - state.v_W_m_s[axis], squared(params_.velocity_m_sqrts) / h, state);
    }
  } else if (!watch_slip(turned - state.v_W_m_s, state)) {
    for (int axis = 0; axis < 2; ++axis) {
      update(kVelocity + axis, turned[axis] - state.v_W_m_s[axis], squared(params_.rolling_velocity_sigma_m_s), state);
    }
  }
  if (!rolls) {
    for (int axis = 0; axis < 2; ++axis) {
      update(kDisplacement + axis, -state.d_W_m[axis], squared(params_.displacement_m_sqrts) / h, state);
    }
  }
  if (state.at_rest) {
    const Eigen::Vector3d mean_rate_rad_s = state.rest.mean_rate_rad_s();
    for (int axis = 0; axis < 3; ++axis) {
      update(kBias + axis, mean_rate_rad_s[axis] - state.bias_rad_s[axis],
             squared(params_.rest_rate_sigma_rad_sqrts) / h, state);
    }
  }
  state.covariance = (0.5 * (state.covariance + state.covariance.transpose())).eval();
  state.R_WI_s.setZero();
  state.f_W_m_s.setZero();
  state.turned_rad2_s = 0.0;
  state.node_s = 0.0;
}

}  // namespace tumble
