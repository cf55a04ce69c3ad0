// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/imu_merge_state.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "tumble/common/detail/scalar_update.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

constexpr int kForceBias = 0, kScale = 3, kPosition = 12;

constexpr int kRate = 0, kAcceleration = 3, kForce = 6, kArms = 9;
constexpr double kStartRateSigma_rad_s = 0.1, kStartAcceleration_rad_s2 = 200.0, kStartForce_m_s2 = 10.0;
constexpr double kRailSigma_rad_s = 0.1;

using Row = Eigen::Matrix<double, 1, AngularRateRecovery::kStates>;

void update_rate_state(const Row& row, double innovation, double variance, AngularRateRecovery::State& state) {
  state.x += scalar_update(row, innovation, variance, state.error_covariance);
}

// If a sensing element clips, `reading` contains the components along the sensing directions instead of the output
// axes: rails.md (R52).
struct SaturatedReading {
  Eigen::Matrix3d sensing_directions_mean_frame;
  Eigen::Vector3d reading, cross_axis_slope_sigma = Eigen::Vector3d::Zero();
  std::array<bool, 3> is_saturated{};

  double saturation_deficit(const Eigen::Vector3d& expected) const {
    double sum2 = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double missing = reading[axis] - expected[axis];
      if (is_saturated[static_cast<std::size_t>(axis)] && missing * reading[axis] < 0.0) sum2 += missing * missing;
    }
    return std::sqrt(sum2);
  }
};

template <typename Railed>
SaturatedReading saturated_reading_of_imu(const SensingDirections& elements, const Eigen::Matrix3d& R_IC,
                                          const Eigen::Vector3d& reading, const Railed& railed) {
  SaturatedReading out{R_IC, reading};
  bool any = false;
  for (int axis = 0; axis < 3; ++axis) any |= out.is_saturated[static_cast<std::size_t>(axis)] = railed(axis);
  if (!any) return out;
  out.sensing_directions_mean_frame = elements.sensing_directions * R_IC;
  out.reading = elements.sensing_directions * reading;
  for (int axis = 0; axis < 3; ++axis) {
    if (!out.is_saturated[static_cast<std::size_t>(axis)])
      out.cross_axis_slope_sigma[axis] = elements.cross_axis_slope_sigma[axis];
  }
  return out;
}

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

AngularRateRecovery::AngularRateRecovery(const ImuMergeSetup& setup, const Eigen::Vector3d& mean_imu_position_m)
    : setup_(setup) {
  for (int k = 0; k < setup.count; ++k)
    setup_.T_mean_imu[static_cast<std::size_t>(k)].translation() -= mean_imu_position_m;
}

bool AngularRateRecovery::is_rate_saturated(const ImuSample& unit, int axis) const {
  return std::abs(unit.angular_velocity_rad_s[axis]) >= setup_.gyro_range_rad_s ||
         (unit.device_clip_flags & (kClipGyroX << axis)) != 0;
}

bool AngularRateRecovery::is_force_saturated(const ImuSample& unit, int axis) const {
  return std::abs(unit.specific_force_m_s2[axis]) >= setup_.accel_range_m_s2 ||
         (unit.device_clip_flags & (kClipAccelX << axis)) != 0;
}

AngularRateRecovery::SaturatedSensors AngularRateRecovery::find_saturated_sensors(
    std::span<const ImuSample> units) const {
  SaturatedSensors out;
  std::size_t clipped = 0, received = 0;
  for (const ImuSample& unit : units) {
    if (!is_finite(unit)) continue;
    ++received;
    bool force = false;
    for (int axis = 0; axis < 3; ++axis) {
      out.rate |= is_rate_saturated(unit, axis);
      force |= is_force_saturated(unit, axis);
    }
    clipped += force;
  }
  // While all gyros are unsaturated, the mean of the unsaturated accelerometers is more accurate than the specific
  // force that AngularRateRecovery estimates.
  out.force = clipped > 0 && (out.rate || 2 * clipped > received);
  return out;
}

void AngularRateRecovery::step(std::span<const ImuSample> units, double dt_s, State& state, ImuSample& merged) const {
  const SaturatedSensors met = find_saturated_sensors(units);
  // Accelerometers saturate first at positions where gravity and centripetal force add up. The mean of the unsaturated
  // accelerometers is therefore biased.
  merged.device_clip_flags = met.force ? kClipAccelX | kClipAccelY | kClipAccelZ : 0;
  const bool fast =
      merged.angular_velocity_rad_s.cwiseAbs().maxCoeff() >= kMinSaturatedRangeFraction * setup_.gyro_range_rad_s;
  if (!fast && !met.rate) {
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
  state.error_covariance = (0.5 * (state.error_covariance + state.error_covariance.transpose())).eval();

  if (met.rate && state.error_covariance.diagonal().segment<3>(kRate).maxCoeff() < squared(kRecoveredSigma_rad_s)) {
    merged.angular_velocity_rad_s = state.x.segment<3>(kRate);
  } else if (met.rate) {
    merged.device_clip_flags = static_cast<std::uint8_t>(merged.device_clip_flags | kClipGyro);
  }
  if (met.rate || met.force) merged.specific_force_m_s2 = state.x.segment<3>(kForce);
}

void AngularRateRecovery::start(const ImuSample& merged, State& state) const {
  state.error_covariance.topRows<kArms>().setZero();
  state.error_covariance.leftCols<kArms>().setZero();
  auto diagonal = state.error_covariance.diagonal();
  if (!state.started) diagonal.tail<kStates - kArms>().setConstant(squared(kLeverArmSigma_m));
  state.x.head<kArms>() << merged.angular_velocity_rad_s, Eigen::Vector3d::Zero(), merged.specific_force_m_s2;
  diagonal.segment<3>(kRate).setConstant(squared(kStartRateSigma_rad_s));
  diagonal.segment<3>(kAcceleration).setConstant(squared(kStartAcceleration_rad_s2));
  diagonal.segment<3>(kForce).setConstant(squared(kStartForce_m_s2));
  state.started = state.running = true;
}

/// See imu_merge.md (I14), (I15).
void AngularRateRecovery::predict(double dt_s, State& state) const {
  const Eigen::Vector3d rate = state.x.segment<3>(kRate), force = state.x.segment<3>(kForce);
  // A specific force that is constant in the world frame rotates in the body frame C.
  const Eigen::Matrix3d turn = so3::exp(-dt_s * rate).toRotationMatrix();
  Eigen::Matrix<double, kArms, kArms> F = Eigen::Matrix<double, kArms, kArms>::Identity();
  F.block<3, 3>(kRate, kAcceleration) = dt_s * Eigen::Matrix3d::Identity();
  F.block<3, 3>(kForce, kForce) = turn;
  F.block<3, 3>(kForce, kRate) = dt_s * so3::hat(turn * force);
  state.x.segment<3>(kRate) += dt_s * state.x.segment<3>(kAcceleration);
  state.x.segment<3>(kForce) = turn * force;
  state.error_covariance.topRows<kArms>() = (F * state.error_covariance.topRows<kArms>()).eval();
  state.error_covariance.leftCols<kArms>() = (state.error_covariance.leftCols<kArms>() * F.transpose()).eval();
  const double walk = squared(kAccelerationWalk_rad_s2_sqrts) * dt_s;
  auto diagonal = state.error_covariance.diagonal();
  diagonal.segment<3>(kRate).array() += walk * squared(dt_s) / 3.0;
  diagonal.segment<3>(kAcceleration).array() += walk;
  diagonal.segment<3>(kForce).array() += squared(kForceWalk_m_s2_sqrts) * dt_s;
}

/// See imu_merge.md (I16).
void AngularRateRecovery::measure_rates(std::span<const ImuSample> units, double dt_s, State& state) const {
  const double shorter = std::max(1.0, kReadingInterval_s / dt_s);
  for (std::size_t k = 0; k < units.size(); ++k) {
    if (!is_finite(units[k])) continue;
    const Eigen::Matrix3d R_IC = setup_.T_mean_imu[k].linear().transpose();
    const auto railed = [&](int axis) { return is_rate_saturated(units[k], axis); };
    const SaturatedReading seen =
        saturated_reading_of_imu(setup_.gyro_sensing_directions[k], R_IC, units[k].angular_velocity_rad_s, railed);
    const double hidden = seen.saturation_deficit(seen.sensing_directions_mean_frame * state.x.segment<3>(kRate));
    for (int axis = 0; axis < 3; ++axis) {
      const double reading = seen.reading[axis];
      const double missing = reading - seen.sensing_directions_mean_frame.row(axis).dot(state.x.segment<3>(kRate));
      if (seen.is_saturated[static_cast<std::size_t>(axis)] && missing * reading < 0.0)
        continue;  // the predicted rate already exceeds the saturation level, so the lower bound adds no information
      Row row = Row::Zero();
      row.segment<3>(kRate) = seen.sensing_directions_mean_frame.row(axis);
      const double sigma = kRateNoise_rad_s + kRateNoiseRatio * std::abs(reading);
      const double variance =
          seen.is_saturated[static_cast<std::size_t>(axis)] ? squared(kRailSigma_rad_s) : squared(sigma);
      update_rate_state(row, missing, shorter * variance + squared(seen.cross_axis_slope_sigma[axis] * hidden), state);
    }
  }
}

/// See imu_merge.md (I17).
void AngularRateRecovery::measure_forces(std::span<const ImuSample> units, double dt_s, State& state) const {
  const double shorter = std::max(1.0, kReadingInterval_s / dt_s);
  for (std::size_t k = 0; k < units.size(); ++k) {
    if (!is_finite(units[k])) continue;
    const Eigen::Matrix3d R_IC = setup_.T_mean_imu[k].linear().transpose();
    const auto railed = [&](int axis) { return is_force_saturated(units[k], axis); };
    const SaturatedReading seen =
        saturated_reading_of_imu(setup_.accel_sensing_directions[k], R_IC, units[k].specific_force_m_s2, railed);
    const int arm = kArms + 3 * static_cast<int>(k);
    for (int axis = 0; axis < 3; ++axis) {
      const double reading = seen.reading[axis];
      if (seen.is_saturated[static_cast<std::size_t>(axis)]) continue;
      const Eigen::Vector3d rate = state.x.segment<3>(kRate), acceleration = state.x.segment<3>(kAcceleration);
      const Eigen::Vector3d position = setup_.T_mean_imu[k].translation() + state.x.segment<3>(arm);
      const Eigen::Matrix3d jacobian_position = so3::hat(acceleration) + so3::hat(rate) * so3::hat(rate);
      const auto axis_C = seen.sensing_directions_mean_frame.row(axis);
      Row row = Row::Zero();
      row.segment<3>(kRate) = -axis_C * (so3::hat(rate.cross(position)) + so3::hat(rate) * so3::hat(position));
      row.segment<3>(kAcceleration) = -axis_C * so3::hat(position);
      row.segment<3>(kForce) = axis_C;
      row.segment<3>(arm) = axis_C * jacobian_position;
      const Eigen::Vector3d force = state.x.segment<3>(kForce) + jacobian_position * position;
      const double hidden = seen.cross_axis_slope_sigma[axis] > 0.0
                                ? seen.saturation_deficit(seen.sensing_directions_mean_frame * force)
                                : 0.0;
      const double sigma = kForceNoise_m_s2 + kForceNoiseRatio * std::abs(reading);
      update_rate_state(row, reading - axis_C.dot(force),
                        shorter * squared(sigma) + squared(seen.cross_axis_slope_sigma[axis] * hidden), state);
    }
  }
}

}  // namespace tumble
