// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/rate_recovery.hpp"

#include <algorithm>
#include <cmath>

#include "tumble/common/so3.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

namespace {

constexpr double kSmallest = 1e-12;
constexpr int kRate = 0, kAcceleration = 3, kForce = 6, kArms = 9;
constexpr double kStartRateSigma_rad_s = 0.1, kStartAcceleration_rad_s2 = 200.0, kStartForce_m_s2 = 10.0;
constexpr double kRailSigma_rad_s = 0.1;

double squared(double x) {
  return x * x;
}

using Row = Eigen::Matrix<double, 1, RateRecovery::kStates>;

void update(const Row& row, double innovation, double variance, RateRecovery::State& state) {
  const RateRecovery::Vector PHt = state.P * row.transpose();
  const double s = row.dot(PHt) + variance;
  state.x += PHt * (innovation / s);
  state.P -= PHt * (PHt / s).transpose();
}

}  // namespace

RateRecovery::RateRecovery(const Params& p) : params_(p) {
  require_within("count", p.count, 1, kUnits);
  for (int k = 0; k < p.count; ++k) {
    const Eigen::Isometry3d& T = p.T_CI[static_cast<std::size_t>(k)];
    require_within("T_CI", T.translation().norm(), 0.0, 1e3);
    require_within("T_CI", (T.linear() * T.linear().transpose() - Eigen::Matrix3d::Identity()).norm(), 0.0, 1e-6);
  }
  require_within("gyro_range_rad_s", p.gyro_range_rad_s, kSmallest, 1e3);
  require_within("accel_range_m_s2", p.accel_range_m_s2, kSmallest, 1e5);
  require_within("lever_arm_sigma_m", p.lever_arm_sigma_m, kSmallest, 10.0);
  require_within("rate_noise_rad_s", p.rate_noise_rad_s, kSmallest, 10.0);
  require_within("rate_noise_share", p.rate_noise_share, 0.0, 1.0);
  require_within("force_noise_m_s2", p.force_noise_m_s2, kSmallest, 1e3);
  require_within("force_noise_share", p.force_noise_share, 0.0, 1.0);
  require_within("acceleration_walk_rad_s2_sqrts", p.acceleration_walk_rad_s2_sqrts, kSmallest, 1e6);
  require_within("force_walk_m_s2_sqrts", p.force_walk_m_s2_sqrts, kSmallest, 1e6);
  require_within("recovered_sigma_rad_s", p.recovered_sigma_rad_s, kSmallest, 1e3);
}

bool RateRecovery::rate_railed(const ImuSample& unit, int axis) const {
  return std::abs(unit.angular_velocity_rad_s[axis]) >= params_.gyro_range_rad_s ||
         (unit.device_clip_flags & (kClipGyroX << axis)) != 0;
}

bool RateRecovery::force_railed(const ImuSample& unit, int axis) const {
  return std::abs(unit.specific_force_m_s2[axis]) >= params_.accel_range_m_s2 ||
         (unit.device_clip_flags & (kClipAccelX << axis)) != 0;
}

void RateRecovery::step(std::span<const ImuSample> units, double dt_s, State& state, ImuSample& merged) const {
  merged.device_clip_flags = 0;
  if (merged.angular_velocity_rad_s.cwiseAbs().maxCoeff() < kFast * params_.gyro_range_rad_s) {
    state.running = false;
    return;
  }
  if (state.running) {
    predict(dt_s, state);
  } else {
    start(merged, state);
  }
  measure_rates(units, dt_s, state);
  measure_forces(units, dt_s, state);
  state.P = (0.5 * (state.P + state.P.transpose())).eval();

  bool rate_clipped = false;
  std::size_t forces_clipped = 0;
  std::size_t heard = 0;
  for (const ImuSample& unit : units) {
    if (!is_finite(unit)) continue;
    ++heard;
    bool force_clipped = false;
    for (int axis = 0; axis < 3; ++axis) {
      rate_clipped |= rate_railed(unit, axis);
      force_clipped |= force_railed(unit, axis);
    }
    forces_clipped += force_clipped;
  }
  // with a rate that is right, the units that are left tell the force better than the filter: only where they are few
  // does it count as clipped
  const bool force_clipped = forces_clipped > 0 && (rate_clipped || 2 * forces_clipped > heard);
  if (rate_clipped && state.P.diagonal().segment<3>(kRate).maxCoeff() < squared(params_.recovered_sigma_rad_s)) {
    merged.angular_velocity_rad_s = state.x.segment<3>(kRate);
  } else if (rate_clipped) {
    merged.device_clip_flags = kClipGyroX | kClipGyroY | kClipGyroZ;
  }
  // the mean of the units in use was moved to the mean place with a rate that may be wrong
  if (rate_clipped || force_clipped) merged.specific_force_m_s2 = state.x.segment<3>(kForce);
  // rails are met when gravity and the turning add up: what is left is off in one direction of W
  if (force_clipped) {
    merged.device_clip_flags =
        static_cast<std::uint8_t>(merged.device_clip_flags | kClipAccelX | kClipAccelY | kClipAccelZ);
  }
}

void RateRecovery::start(const ImuSample& merged, State& state) const {
  // what was learnt of the lever arms stays
  state.P.topRows<kArms>().setZero();
  state.P.leftCols<kArms>().setZero();
  auto diagonal = state.P.diagonal();
  if (!state.started) diagonal.tail<kStates - kArms>().setConstant(squared(params_.lever_arm_sigma_m));
  state.x.head<kArms>() << merged.angular_velocity_rad_s, Eigen::Vector3d::Zero(), merged.specific_force_m_s2;
  diagonal.segment<3>(kRate).setConstant(squared(kStartRateSigma_rad_s));
  diagonal.segment<3>(kAcceleration).setConstant(squared(kStartAcceleration_rad_s2));
  diagonal.segment<3>(kForce).setConstant(squared(kStartForce_m_s2));
  state.started = state.running = true;
}

void RateRecovery::predict(double dt_s, State& state) const {
  const Eigen::Vector3d rate = state.x.segment<3>(kRate), force = state.x.segment<3>(kForce);
  const Eigen::Matrix3d turn = so3::exp(-dt_s * rate).toRotationMatrix();  // a force that stays in W turns back in C
  Eigen::Matrix<double, kArms, kArms> F = Eigen::Matrix<double, kArms, kArms>::Identity();
  F.block<3, 3>(kRate, kAcceleration) = dt_s * Eigen::Matrix3d::Identity();
  F.block<3, 3>(kForce, kForce) = turn;
  F.block<3, 3>(kForce, kRate) = dt_s * so3::hat(turn * force);
  state.x.segment<3>(kRate) += dt_s * state.x.segment<3>(kAcceleration);
  state.x.segment<3>(kForce) = turn * force;
  state.P.topRows<kArms>() = (F * state.P.topRows<kArms>()).eval();
  state.P.leftCols<kArms>() = (state.P.leftCols<kArms>() * F.transpose()).eval();
  const double walk = squared(params_.acceleration_walk_rad_s2_sqrts) * dt_s;
  auto diagonal = state.P.diagonal();
  diagonal.segment<3>(kRate).array() += walk * squared(dt_s) / 3.0;
  diagonal.segment<3>(kAcceleration).array() += walk;
  diagonal.segment<3>(kForce).array() += squared(params_.force_walk_m_s2_sqrts) * dt_s;
}

void RateRecovery::measure_rates(std::span<const ImuSample> units, double dt_s, State& state) const {
  const double shorter = std::max(1.0, kReading_s / dt_s);
  for (std::size_t k = 0; k < units.size(); ++k) {
    if (!is_finite(units[k])) continue;
    const Eigen::Matrix3d R_IC = params_.T_CI[k].linear().transpose();
    for (int axis = 0; axis < 3; ++axis) {
      const double reading = units[k].angular_velocity_rad_s[axis];
      const double missing = reading - R_IC.row(axis).dot(state.x.segment<3>(kRate));
      const bool railed = rate_railed(units[k], axis);
      if (railed && missing * reading < 0.0) continue;  // beyond the rail, as it may be
      Row row = Row::Zero();
      row.segment<3>(kRate) = R_IC.row(axis);
      const double sigma = params_.rate_noise_rad_s + params_.rate_noise_share * std::abs(reading);
      update(row, missing, shorter * squared(railed ? kRailSigma_rad_s : sigma), state);
    }
  }
}

void RateRecovery::measure_forces(std::span<const ImuSample> units, double dt_s, State& state) const {
  const double shorter = std::max(1.0, kReading_s / dt_s);
  for (std::size_t k = 0; k < units.size(); ++k) {
    if (!is_finite(units[k])) continue;
    const Eigen::Matrix3d R_IC = params_.T_CI[k].linear().transpose();
    const int arm = kArms + 3 * static_cast<int>(k);
    for (int axis = 0; axis < 3; ++axis) {
      const double reading = units[k].specific_force_m_s2[axis];
      if (force_railed(units[k], axis)) continue;
      const Eigen::Vector3d rate = state.x.segment<3>(kRate), acceleration = state.x.segment<3>(kAcceleration);
      const Eigen::Vector3d place = params_.T_CI[k].translation() + state.x.segment<3>(arm);
      const Eigen::Matrix3d by_place = so3::hat(acceleration) + so3::hat(rate) * so3::hat(rate);
      const auto axis_C = R_IC.row(axis);
      Row row = Row::Zero();
      row.segment<3>(kRate) = -axis_C * (so3::hat(rate.cross(place)) + so3::hat(rate) * so3::hat(place));
      row.segment<3>(kAcceleration) = -axis_C * so3::hat(place);
      row.segment<3>(kForce) = axis_C;
      row.segment<3>(arm) = axis_C * by_place;
      const double expected = axis_C.dot(state.x.segment<3>(kForce) + by_place * place);
      const double sigma = params_.force_noise_m_s2 + params_.force_noise_share * std::abs(reading);
      update(row, reading - expected, shorter * squared(sigma), state);
    }
  }
}

}  // namespace tumble
