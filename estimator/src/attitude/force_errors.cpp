// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/force_errors.hpp"

#include <algorithm>

#include "tumble/common/detail/squared.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

constexpr int kForceBias = 0, kScale = 3, kPosition = 12;

}  // namespace

/// See imu_merge.md (I10), (I11).
void ForceErrors::calibrate(std::span<const Eigen::Vector3d> forces, const Eigen::Vector3d& rate,
                            const Eigen::Vector3d& acceleration, double dt_s, State& state) const {
  if (!state.started) {
    for (int k = 0; k < setup_.count; ++k) {
      auto prior = state.error_covariance.diagonal().segment<kErrorsPerImu>(kErrorsPerImu * k);
      prior.segment<3>(kForceBias).setConstant(squared(kBiasSigma_m_s2));
      prior.segment<9>(kScale).setConstant(squared(kScaleSigma));
      prior.segment<3>(kPosition).setConstant(squared(kPositionSigma_m));
    }
    state.started = true;
  }
  const Eigen::Matrix3d jacobian_position = so3::hat(acceleration) + so3::hat(rate) * so3::hat(rate);
  Eigen::Vector3d mean_force = Eigen::Vector3d::Zero(), mean_position = Eigen::Vector3d::Zero();
  for (int k = 0; k < setup_.count; ++k) {
    mean_force += forces[static_cast<std::size_t>(k)] / setup_.count;
    mean_position += imu_position_m(k) / setup_.count;
  }
  for (int k = 0; k < setup_.count; ++k) {
    const Eigen::Vector3d& force = forces[static_cast<std::size_t>(k)];
    state.force_difference_m_s2.col(k) += force - mean_force - jacobian_position * (imu_position_m(k) - mean_position);
    state.force_m_s2.col(k) += force;
  }
  state.jacobian_position += jacobian_position;
  state.acceleration_rad_s2 += acceleration.norm();
  ++state.samples;
  state.span_s += dt_s;
  if (state.span_s >= kCorrelationTime_s - 0.5 * dt_s) update(state);
}

/// See imu_merge.md (I11).
void ForceErrors::update(State& state) const {
  const double share = 1.0 / setup_.count;
  const double samples = state.samples;
  double reach_m = 0.0;
  for (int k = 1; k < setup_.count; ++k) reach_m = std::max(reach_m, (imu_position_m(k) - imu_position_m(0)).norm());
  const double variance =
      squared(kNoise_m_s2) + squared(kAccelerationNoiseRatio * reach_m * state.acceleration_rad_s2 / samples);
  const Eigen::Index used = kErrorsPerImu * setup_.count;
  auto P = state.error_covariance.topLeftCorner(used, used);
  for (int k = 0; k < setup_.count; ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      Vector row = Vector::Zero();
      for (int j = 0; j < setup_.count; ++j) {
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
      // If the innovation is large, an impact has probably occurred within the averaged samples.
      if (squared(innovation) > squared(kGateSigmas) * s) continue;
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
