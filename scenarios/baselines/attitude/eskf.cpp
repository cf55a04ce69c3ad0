// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/baselines/attitude/eskf.hpp"

#include <cmath>

#include "scenarios/baselines/attitude/force_min.hpp"
#include "tumble/attitude/detail/timing.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/so3.hpp"

namespace tumble::baselines {

Eskf::Eskf(const Params& p) : params_(p) {
  require_valid_fields(p);
}

Status Eskf::step(const ImuSample& sample, State& state) const {
  if (const Status bad = check_sample(sample); !bad.ok()) return bad;
  if (state.started) {
    double dt_s = 0.0;
    if (const Status bad = elapsed(sample.time_ns, state.last_time_ns, params_.gap_max_s, dt_s); !bad.ok()) return bad;
    predict(sample.angular_velocity_rad_s, dt_s, state);
    if (sample.specific_force_m_s2.norm() >= kForceMin_m_s2) correct(sample.specific_force_m_s2, dt_s, state);
  } else {
    if (const Status bad = level(sample.specific_force_m_s2, state.q_WI); !bad.ok()) return bad;
    start(state);
  }
  state.last_time_ns = sample.time_ns;
  return {};
}

void Eskf::start(State& state) const {
  const double tilt = params_.tilt_sigma_start_rad * params_.tilt_sigma_start_rad;
  const double bias = params_.bias_sigma_start_rad_s * params_.bias_sigma_start_rad_s;
  // The initial heading has no error, because it defines the world's x axis.
  state.covariance.diagonal() << tilt, tilt, 0.0, bias, bias, bias;
  state.started = true;
}

void Eskf::predict(const Eigen::Vector3d& rate_rad_s, double dt_s, State& state) const {
  const Eigen::Vector3d turn = (rate_rad_s - state.bias_rad_s) * dt_s;
  const Eigen::Matrix3d R_mid = (state.q_WI * so3::exp(0.5 * turn)).toRotationMatrix();
  Covariance F = Covariance::Identity();
  F.topRightCorner<3, 3>() = -dt_s * R_mid;
  state.covariance = (F * state.covariance * F.transpose()).eval();
  const double angle = params_.gyro_noise_rad_sqrts * params_.gyro_noise_rad_sqrts * dt_s;
  const double walk = params_.bias_walk_rad_s_sqrts * params_.bias_walk_rad_s_sqrts * dt_s;
  state.covariance.diagonal().head<3>().array() += angle;
  state.covariance.diagonal().tail<3>().array() += walk;
  state.q_WI = (state.q_WI * so3::exp(turn)).normalized();
}

void Eskf::correct(const Eigen::Vector3d& f_I_m_s2, double dt_s, State& state) const {
  // The update uses the specific force and not its direction. During bounded motion, the mean specific force equals
  // gravity, while the mean direction is biased. The vertical component contains no information about attitude.
  const Eigen::Vector3d up_W = state.q_WI * f_I_m_s2 / params_.gravity_m_s2;
  const Eigen::Vector2d innovation(up_W.y(), -up_W.x());
  const double sigma = params_.acceleration_noise_m_s2_sqrts / params_.gravity_m_s2;
  const Eigen::Matrix<double, 2, 6> H = Eigen::Matrix<double, 2, 6>::Identity();
  const Eigen::Matrix2d noise = sigma * sigma / dt_s * Eigen::Matrix2d::Identity();
  const Eigen::Matrix<double, 6, 1> correction = vector_update<2, 6>(H, innovation, noise, state.covariance);
  state.covariance = (0.5 * (state.covariance + state.covariance.transpose())).eval();
  state.q_WI = (so3::exp(correction.head<3>()) * state.q_WI).normalized();
  state.bias_rad_s += correction.tail<3>();
}

}  // namespace tumble::baselines
