// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_model.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tumble/common/types.hpp"

namespace tumble::hand_held {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using so3::hat;

using GyroRow = Eigen::Matrix<double, 1, 6>;
using BorderRow = Eigen::Matrix<double, 1, kBorderSize>;
// derivative of the specific-force residual with respect to attitude, rate, angular acceleration and hand acceleration
using ForceState = Eigen::Matrix<double, 3, 12>;
using ForceBorder = Eigen::Matrix<double, 3, kBorderSize>;

// Returns phi(u)/Phi(u) for the density phi and the distribution function Phi of the standard normal distribution:
// carried.md (C14). Below u = -12, where phi and Phi may underflow, the function uses an asymptotic series.
double normal_hazard_function(double u) {
  if (u < -12.0) return -u - 1.0 / u * (1.0 - 2.0 / (u * u));
  const double density = std::exp(-0.5 * u * u) / std::sqrt(2.0 * std::numbers::pi);
  return density / (0.5 * std::erfc(-u / std::numbers::sqrt2));
}

double minus_two_log_normal_cdf(double u) {
  if (u < -12.0) return u * u + 2.0 * std::log(-u * std::sqrt(2.0 * std::numbers::pi));
  return -2.0 * std::log(0.5 * std::erfc(-u / std::numbers::sqrt2));
}

void add_gyro_row(const GyroRow& state, const BorderRow& border, double weight, double slope, System::StateBlock& block,
                  System::BorderBlock& corner) {
  const GyroRow weighted = weight * state;
  block.diagonal.block<6, 6>(kRate, kRate).noalias() += weighted.transpose() * state;
  block.border_coupling.block<6, kBorderSize>(kRate, 0).noalias() += weighted.transpose() * border;
  block.gradient.segment<6>(kRate).noalias() -= slope * state.transpose();
  corner.matrix.noalias() += weight * border.transpose() * border;
  corner.gradient.noalias() -= slope * border.transpose();
}

struct GyroSensingAxisRow {
  GyroRow value = GyroRow::Zero(), row_derivative = GyroRow::Zero();
  BorderRow border_row = BorderRow::Zero();
  double predicted = 0.0, predicted_derivative = 0.0;
};

GyroSensingAxisRow predict_gyro(const Eigen::RowVector3d& m, const Node& node, const Constants& constants) {
  GyroSensingAxisRow rows;
  const Vector3d& w = node.w_WI_I_rad_s;
  const Vector3d& alpha = node.angular_acceleration_rad_s2;
  rows.value.head<3>() = m;
  rows.row_derivative.tail<3>() = rows.value.head<3>();
  rows.border_row.segment<3>(kGyroBias) = m;
  rows.predicted = m.dot(w + constants.gyro_bias_rad_s);
  rows.predicted_derivative = m.dot(alpha);
  return rows;
}

double clipped_axis_deficit(const NodeReadings& readings, const std::array<GyroSensingAxisRow, 3>& rows, int except) {
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const SensingAxisSums& element = readings.gyro[static_cast<std::size_t>(i)];
    if (i == except) continue;
    const double predicted = rows[static_cast<std::size_t>(i)].predicted;
    const double beyond = element.clipped_reading_count > 0.0
                              ? element.saturated_side * (predicted - element.mean_saturation_limit)
                              : 0.0;
    const double off = element.unusable_reading_count > 0.0 ? std::abs(predicted - element.mean_unusable_reading) : 0.0;
    sum += std::max({0.0, beyond, off});
  }
  return sum;
}

// Averaged over a time step, unclipped readings form two independent measurements, the rate at the mean time and the
// slope of the rate: carried.md (C13).
double add_unclipped_readings(const SensingAxisSums& e, const GyroSensingAxisRow& rows, double information,
                              System::StateBlock& block, System::BorderBlock& corner) {
  const double mean_t = e.time_sum_s / e.count;
  const double mean_z = e.reading_sum / e.count;
  const GyroRow row = rows.value + mean_t * rows.row_derivative;
  const double error = rows.predicted + mean_t * rows.predicted_derivative - mean_z;
  add_gyro_row(row, rows.border_row, e.count * information, e.count * information * error, block, corner);
  double cost = e.count * information * error * error;
  const double spread = e.time_squared_sum_s2 - e.time_sum_s * mean_t;
  if (e.count > 1.5 && spread > 1e-12) {
    const double slope_error = rows.predicted_derivative - (e.reading_time_sum - e.time_sum_s * mean_z) / spread;
    add_gyro_row(rows.row_derivative, BorderRow::Zero(), spread * information, spread * information * slope_error,
                 block, corner);
    cost += spread * information * slope_error * slope_error;
  }
  return cost;
}

// See carried.md (C14).
double add_bound(const SensingAxisSums& e, const GyroSensingAxisRow& rows, double sigma, double share,
                 System::StateBlock& block, System::BorderBlock& corner) {
  const GyroRow row = rows.value + e.clipped_time_s * rows.row_derivative;
  const double u = e.saturated_side *
                   (rows.predicted + e.clipped_time_s * rows.predicted_derivative - e.mean_saturation_limit) / sigma;
  const double h = normal_hazard_function(u);
  add_gyro_row(row, rows.border_row, share * h * (h + u) / (sigma * sigma), -e.saturated_side * h / sigma, block,
               corner);
  return minus_two_log_normal_cdf(u);
}

double add_zero_prior(const Vector3d& value, double w, int i, System::StateBlock& block) {
  block.diagonal.diagonal().segment<3>(i).array() += w;
  block.gradient.segment<3>(i) -= w * value;
  return w * value.squaredNorm();
}

template <int N>
double add_motion_factor(const Eigen::Matrix<double, 2 * N, 2 * N>& information, double scale, int first,
                         const Eigen::Matrix<double, 3, 2 * N>& values, System::StateBlock& block,
                         System::StateBlock& next) {
  const Eigen::Matrix<double, 3, 2 * N> slope = scale * values * information;
  for (int i = 0; i < N; ++i) {
    const int row = first + 3 * i;
    block.gradient.segment<3>(row) -= slope.col(i);
    next.gradient.segment<3>(row) -= slope.col(N + i);
    for (int j = 0; j < N; ++j) {
      const int column = first + 3 * j;
      block.diagonal.block<3, 3>(row, column).diagonal().array() += scale * information(i, j);
      next.diagonal.block<3, 3>(row, column).diagonal().array() += scale * information(N + i, N + j);
      block.coupling_to_next_state.block<3, 3>(row, column).diagonal().array() += scale * information(i, N + j);
    }
  }
  return (slope.array() * values.array()).sum();
}

}  // namespace

// See carried.md (C1).
void Node::move(const System::StateVector& step) {
  q_WI = (q_WI * so3::exp(step.segment<3>(kAttitudeError))).normalized();
  w_WI_I_rad_s += step.segment<3>(kRate);
  angular_acceleration_rad_s2 += step.segment<3>(kAngularAcceleration);
  a_W_m_s2 += step.segment<3>(kHandAccelerationIndex);
  v_W_m_s += step.segment<3>(kVelocity);
  p_W_m += step.segment<3>(kPosition);
}

void Constants::move(const System::BorderVector& step) {
  gyro_bias_rad_s += step.segment<3>(kGyroBias);
  accel_bias_m_s2 += step.segment<3>(kAccelBias);
  lever_arm_m += step.segment<3>(kLever);
}

double add_gyro(const NodeReadings& readings, const Matrix3d& rows, const ReadingNoise& noise, const Node& node,
                const Constants& constants, System::StateBlock& block, System::BorderBlock& corner) {
  std::array<GyroSensingAxisRow, 3> elements;
  for (int i = 0; i < 3; ++i) elements[static_cast<std::size_t>(i)] = predict_gyro(rows.row(i), node, constants);
  const double variance =
      noise.gyro_rad_s * noise.gyro_rad_s + noise.window_rate_sigma_rad_s * noise.window_rate_sigma_rad_s;
  double cost = 0.0;
  for (int i = 0; i < 3; ++i) {
    const SensingAxisSums& e = readings.gyro[static_cast<std::size_t>(i)];
    const GyroSensingAxisRow& element = elements[static_cast<std::size_t>(i)];
    if (e.count > 0.0) {
      // If one sensing element clips, errors of the sensing directions shift all readings of the other elements equally
      // within a time step. Averaging does not reduce a shift that is equal for all readings.
      const double tilt = noise.deficit_error_ratio * clipped_axis_deficit(readings, elements, i);
      cost += add_unclipped_readings(
          e, element,
          1.0 / (variance + e.count * (tilt * tilt + e.partial_saturation_sigma * e.partial_saturation_sigma)), block,
          corner);
    }
    if (e.clipped_reading_count > 0.0) {
      const double sigma = std::sqrt(variance / e.clipped_reading_count +
                                     noise.saturation_limit_sigma_rad_s * noise.saturation_limit_sigma_rad_s);
      cost += add_bound(e, element, sigma, noise.bound, block, corner);
    }
  }
  return cost;
}

// See carried.md (C16).
double add_force(const NodeReadings& readings, const Vector3d& g_W_m_s2, const ReadingNoise& noise, const Node& node,
                 const Constants& constants, System::StateBlock& block, System::BorderBlock& corner) {
  if (!(readings.force_reading_count > 0.0)) return 0.0;
  const Vector3d& w = node.w_WI_I_rad_s;
  const Vector3d& alpha = node.angular_acceleration_rad_s2;
  const Vector3d& r = constants.lever_arm_m;
  const double t = readings.mean_force_time_s;
  const Matrix3d later = so3::exp(-t * w).toRotationMatrix();
  const Matrix3d R_IW = later * node.q_WI.toRotationMatrix().transpose();
  const Vector3d push = R_IW * (node.a_W_m_s2 - g_W_m_s2);
  const Vector3d predicted = push + alpha.cross(r) + w.cross(w.cross(r)) + constants.accel_bias_m_s2;
  ForceState J;
  J.block<3, 3>(0, kAttitudeError) = hat(push) * later;
  J.block<3, 3>(0, kRate) = t * hat(push) - hat(w.cross(r)) - hat(w) * hat(r);
  J.block<3, 3>(0, kAngularAcceleration) = -hat(r);
  J.block<3, 3>(0, kHandAccelerationIndex) = R_IW;
  ForceBorder B = ForceBorder::Zero();
  B.block<3, 3>(0, kAccelBias).setIdentity();
  B.block<3, 3>(0, kLever) = hat(alpha) + hat(w) * hat(w);

  const double share = noise.force_noise_ratio * (readings.force_m_s2.norm() - g_W_m_s2.norm());
  const double variance = noise.accel_m_s2 * noise.accel_m_s2 / readings.force_reading_count + share * share +
                          readings.force_timing_sigma_m_s2 * readings.force_timing_sigma_m_s2;
  double cost = 0.0;
  Vector3d weight, slope;
  for (int i = 0; i < 3; ++i) {
    const double error = predicted[i] - readings.force_m_s2[i];
    if (readings.force_bound_m_s2[i] != 0.0) {
      const double sigma = std::sqrt(variance);
      const double u = readings.force_bound_m_s2[i] * error / sigma;
      const double h = normal_hazard_function(u);
      weight[i] = noise.force_bound_weight * h * (h + u) / variance;
      slope[i] = -readings.force_bound_m_s2[i] * h / sigma;
      cost += minus_two_log_normal_cdf(u);
    } else {
      weight[i] = 1.0 / variance;
      slope[i] = weight[i] * error;
      cost += slope[i] * error;
    }
  }
  const ForceState weighted = weight.asDiagonal() * J;
  block.diagonal.topLeftCorner<12, 12>().noalias() += weighted.transpose() * J;
  block.border_coupling.topRows<12>().noalias() += weighted.transpose() * B;
  block.gradient.head<12>().noalias() -= J.transpose() * slope;
  corner.matrix.noalias() += B.transpose() * weight.asDiagonal() * B;
  corner.gradient.noalias() -= B.transpose() * slope;
  return cost;
}

double add_rest(const ReadingNoise& noise, const Node& node, System::StateBlock& block) {
  return add_zero_prior(node.w_WI_I_rad_s,
                        1.0 / (noise.stationary_rate_sigma_rad_s * noise.stationary_rate_sigma_rad_s), kRate, block) +
         add_zero_prior(node.v_W_m_s, 1.0 / (noise.stationary_velocity_sigma_m_s * noise.stationary_velocity_sigma_m_s),
                        kVelocity, block) +
         add_zero_prior(node.a_W_m_s2,
                        1.0 / (noise.stationary_acceleration_sigma_m_s2 * noise.stationary_acceleration_sigma_m_s2),
                        kHandAccelerationIndex, block);
}

// See carried.md (C3).
Vector3d rotation_between_nodes(const Node& from, const Node& to, double h) {
  const Vector3d& w0 = from.w_WI_I_rad_s;
  const Vector3d& w1 = to.w_WI_I_rad_s;
  return 0.5 * h * (w0 + w1) +
         h * h / 12.0 * (from.angular_acceleration_rad_s2 - to.angular_acceleration_rad_s2 + w0.cross(w1));
}

Motion::Motion(const Params& params) : params_(params) {
  const double h = params.step_s;
  const double q = params.jerk_rad_s3_sqrts * params.jerk_rad_s3_sqrts;
  // See carried.md (C2).
  Eigen::Matrix2d Q;
  Q << h * h * h / 3.0, h * h / 2.0, h * h / 2.0, h;
  Eigen::Matrix<double, 2, 4> J;
  J << -1.0, -h, 1.0, 0.0, 0.0, -1.0, 0.0, 1.0;
  jerk_ = J.transpose() * (q * Q).inverse() * J;
  // variance of the rotation between two time steps (nodes) with known rate and angular acceleration: carried.md (C4)
  attitude_error_variance_ = q * std::pow(h, 5) / 720.0 + 1e-12;

  // See carried.md (C6), (C7), (C8).
  const double decay = std::exp(-h / params.hand_tau_s);
  const double density = (1.0 - decay * decay) * params.hand_sigma_m_s2 * params.hand_sigma_m_s2 / h;
  Eigen::Matrix<double, 1, 6> row;
  row << -decay, 0.0, 0.0, 1.0, 0.0, 0.0;
  hand_information_ = row.transpose() * row / (density * h);
  row << -0.5 * h, -1.0, 0.0, -0.5 * h, 1.0, 0.0;
  kinematics_ = row.transpose() * row / (density * h * h * h / 12.0 + 1e-10);
  const double leak = std::exp(-h / params.position_leak_s);
  row << 0.0, -0.5 * h, -leak, 0.0, -0.5 * h, 1.0;
  kinematics_ += row.transpose() * row / (density * std::pow(h, 5) / 120.0 + 1e-10);
}

// See carried.md (C4), (C5).
double Motion::add_attitude(const Node& from, const Node& to, double jerk, System::StateBlock& block,
                            System::StateBlock& next) const {
  const double h = params_.step_s;
  const Vector3d omega = rotation_between_nodes(from, to, h);
  const Eigen::Quaterniond step = so3::exp(omega);
  const Eigen::Quaterniond rotation = from.q_WI.conjugate() * to.q_WI;
  const Vector3d error = so3::logarithm(step.conjugate() * rotation);
  const Matrix3d by_next = so3::left_jacobian_inverse(error).transpose();
  const Matrix3d by_omega = -so3::left_jacobian_inverse(error) * so3::left_jacobian(omega).transpose();
  Eigen::Matrix<double, 3, 9> J0, J1;
  J0.leftCols<3>() = -by_next * rotation.toRotationMatrix().transpose();
  J0.middleCols<3>(kRate) = by_omega * (0.5 * h * Matrix3d::Identity() - h * h / 12.0 * hat(to.w_WI_I_rad_s));
  J0.middleCols<3>(kAngularAcceleration) = h * h / 12.0 * by_omega;
  J1.leftCols<3>() = by_next;
  J1.middleCols<3>(kRate) = by_omega * (0.5 * h * Matrix3d::Identity() + h * h / 12.0 * hat(from.w_WI_I_rad_s));
  J1.middleCols<3>(kAngularAcceleration) = -h * h / 12.0 * by_omega;
  const double error_2 = params_.rotation_error_sqrts * params_.rotation_error_sqrts * omega.squaredNorm() / h;
  const double w = 1.0 / (jerk * jerk * attitude_error_variance_ + error_2);
  block.diagonal.topLeftCorner<9, 9>().noalias() += w * J0.transpose() * J0;
  block.coupling_to_next_state.topLeftCorner<9, 9>().noalias() += w * J0.transpose() * J1;
  next.diagonal.topLeftCorner<9, 9>().noalias() += w * J1.transpose() * J1;
  block.gradient.head<9>().noalias() -= w * J0.transpose() * error;
  next.gradient.head<9>().noalias() -= w * J1.transpose() * error;
  return w * error.squaredNorm();
}

// Adds the motion model of one time step: carried.md (C2), (C4), (C6), (C7), (C8).
double Motion::add_motion_model(const Node& from, const Node& to, double hand, System::StateBlock& block,
                                System::StateBlock& next, double jerk) const {
  double cost = add_attitude(from, to, jerk, block, next);
  Eigen::Matrix<double, 3, 4> turn;
  turn << from.w_WI_I_rad_s, from.angular_acceleration_rad_s2, to.w_WI_I_rad_s, to.angular_acceleration_rad_s2;
  cost += add_motion_factor<2>(jerk_, 1.0 / (jerk * jerk), kRate, turn, block, next);
  Eigen::Matrix<double, 3, 6> ends;
  ends << from.a_W_m_s2, from.v_W_m_s, from.p_W_m, to.a_W_m_s2, to.v_W_m_s, to.p_W_m;
  cost += add_motion_factor<3>(hand_information_, 1.0 / hand, kHandAccelerationIndex, ends, block, next);
  cost += add_motion_factor<3>(kinematics_, 1.0, kHandAccelerationIndex, ends, block, next);
  return cost;
}

// See carried.md (C9).
double Motion::add_bounds(const Node& node, System::StateBlock& block) const {
  const double velocity = params_.velocity_m_s * params_.velocity_m_s * params_.velocity_tau_s;
  const double position = params_.position_m * params_.position_m * params_.position_tau_s;
  return add_zero_prior(node.v_W_m_s, params_.step_s / velocity, kVelocity, block) +
         add_zero_prior(node.p_W_m, params_.step_s / position, kPosition, block);
}

double Motion::add_initial_prior(const Node& node, System::StateBlock& block) const {
  const Vector3d up_I = node.q_WI.conjugate() * Vector3d::UnitZ();
  block.diagonal.topLeftCorner<3, 3>() += 1e6 * up_I * up_I.transpose() + 0.1 * Matrix3d::Identity();
  const double hand = params_.hand_sigma_m_s2, velocity = params_.velocity_m_s, position = params_.position_m;
  return add_zero_prior(node.w_WI_I_rad_s, 1e-4, kRate, block) +
         add_zero_prior(node.angular_acceleration_rad_s2, 1e-6, kAngularAcceleration, block) +
         add_zero_prior(node.a_W_m_s2, 1.0 / (hand * hand), kHandAccelerationIndex, block) +
         add_zero_prior(node.v_W_m_s, 1.0 / (velocity * velocity), kVelocity, block) +
         add_zero_prior(node.p_W_m, 1.0 / (position * position), kPosition, block);
}

}  // namespace tumble::hand_held
