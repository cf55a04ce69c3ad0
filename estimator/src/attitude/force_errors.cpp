// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/force_errors.hpp"

#include <algorithm>

#include "tumble/common/detail/squared.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

constexpr int kForceBias = 0, kScale = 3, kPosition = 12;

}  // namespace

ForceErrors::ForceErrors(const Params& p) : params_(p) {
  require_in_interval("count", p.count, 1, kImus);
  require_in_interval("bias_sigma_m_s2", p.bias_sigma_m_s2, 0.0, 1e3);
  require_in_interval("scale_sigma", p.scale_sigma, 0.0, 1.0);
  require_in_interval("position_sigma_m", p.position_sigma_m, 0.0, 10.0);
  require_in_interval("noise_m_s2", p.noise_m_s2, 1e-12, 1e3);
  require_in_interval("acceleration_noise_ratio", p.acceleration_noise_ratio, 0.0, 1.0);
  require_in_interval("gate_deviations", p.gate_sigmas, 1e-12, 1e3);
}

/// See imu_merge.md (I10), (I11).
void ForceErrors::calibrate(std::span<const Eigen::Vector3d> forces, const Eigen::Vector3d& rate,
                            const Eigen::Vector3d& acceleration, double dt_s, State& state) const {
  const auto count = static_cast<std::size_t>(params_.count);
  if (!state.started) {
    for (int k = 0; k < params_.count; ++k) {
      auto prior = state.error_covariance.diagonal().segment<kErrorsPerImu>(kErrorsPerImu * k);
      prior.segment<3>(kForceBias).setConstant(squared(params_.bias_sigma_m_s2));
      prior.segment<9>(kScale).setConstant(squared(params_.scale_sigma));
      prior.segment<3>(kPosition).setConstant(squared(params_.position_sigma_m));
    }
    state.started = true;
  }
  const Eigen::Matrix3d jacobian_position = so3::hat(acceleration) + so3::hat(rate) * so3::hat(rate);
  Eigen::Vector3d mean_force = Eigen::Vector3d::Zero(), mean_position = Eigen::Vector3d::Zero();
  for (std::size_t k = 0; k < count; ++k) {
    mean_force += forces[k] / params_.count;
    mean_position += params_.imu_positions_m[k] / params_.count;
  }
  for (std::size_t k = 0; k < count; ++k) {
    const auto column = static_cast<Eigen::Index>(k);
    state.force_difference_m_s2.col(column) +=
        forces[k] - mean_force - jacobian_position * (params_.imu_positions_m[k] - mean_position);
    state.force_m_s2.col(column) += forces[k];
  }
  state.jacobian_position += jacobian_position;
  state.acceleration_rad_s2 += acceleration.norm();
  ++state.samples;
  state.span_s += dt_s;
  if (state.span_s >= kCorrelationTime_s - 0.5 * dt_s) update(state);
}

/// See imu_merge.md (I11).
void ForceErrors::update(State& state) const {
  const double share = 1.0 / params_.count;
  const double samples = state.samples;
  double reach_m = 0.0;
  for (int k = 1; k < params_.count; ++k) {
    reach_m =
        std::max(reach_m, (params_.imu_positions_m[static_cast<std::size_t>(k)] - params_.imu_positions_m[0]).norm());
  }
  const double variance = squared(params_.noise_m_s2) +
                          squared(params_.acceleration_noise_ratio * reach_m * state.acceleration_rad_s2 / samples);
  const Eigen::Index used = kErrorsPerImu * params_.count;
  auto P = state.error_covariance.topLeftCorner(used, used);
  for (int k = 0; k < params_.count; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      Vector row = Vector::Zero();
      for (int j = 0; j < params_.count; ++j) {
        const double weight = (j == k ? 1.0 : 0.0) - share;
        auto own = row.segment<kErrorsPerImu>(kErrorsPerImu * j);
        own[kForceBias + axis] = weight;
        own.segment<3>(kScale + 3 * axis) = weight / samples * state.force_m_s2.col(j);
        own.segment<3>(kPosition) = weight / samples * state.jacobian_position.row(axis).transpose();
      }
      Vector PHt = Vector::Zero();
      PHt.head(used).noalias() = P * row.head(used);
      const double s = row.dot(PHt) + variance;
      const double innovation = state.force_difference_m_s2(axis, k) / samples - row.dot(state.x);
      // An impact within the averaged samples causes a large innovation.
      if (squared(innovation) > squared(params_.gate_sigmas) * s) continue;
      state.x += PHt * (innovation / s);
      P.noalias() -= PHt.head(used) * (PHt.head(used) / s).transpose();
    }
  }
  state.error_covariance = (0.5 * (state.error_covariance + state.error_covariance.transpose())).eval();
  state.force_difference_m_s2.setZero();
  state.force_m_s2.setZero();
  state.jacobian_position.setZero();
  state.acceleration_rad_s2 = 0.0;
  state.samples = 0;
  state.span_s = 0.0;
}

/// See imu_merge.md (I13).
Eigen::Vector3d ForceErrors::corrected(int k, const Eigen::Vector3d& force, const State& state) {
  if (!state.started) return force;
  const auto own = state.x.segment<kErrorsPerImu>(kErrorsPerImu * k);
  Eigen::Vector3d out = force - own.segment<3>(kForceBias);
  for (int axis = 0; axis < 3; ++axis) out[axis] -= own.segment<3>(kScale + 3 * axis).dot(force);
  return out;
}

}  // namespace tumble
