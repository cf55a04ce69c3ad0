// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <cmath>

#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

using Eigen::Vector3d;

namespace {

using Eigen::Vector3d;
// derivatives of a reading with respect to the rate (columns 0 to 2), and with respect to time_scale_s_ times the
// angular acceleration (columns 3 to 5)
using AuxiliaryRow = Eigen::Matrix<double, 1, 6>;

void add_row(const AuxiliaryRow& row, double residual, double sigma, arrow::Block& block) {
  const double information = 1.0 / (sigma * sigma);
  block.diagonal.noalias() += information * row.transpose() * row;
  block.gradient.noalias() -= information * residual * row.transpose();
}

// Returns whether the specific force along `axis` of an auxiliary IMU depends only on unclipped readings of the primary
// IMU.
bool depends_only_on_unclipped_axes(const Eigen::RowVector3d& axis, const AngularRateObservation& observation) {
  constexpr double kNegligibleCoupling = 0.02;
  if (observation.clipping.accel == 0) return true;
  const bool tilted = observation.accel_sensing_directions.has_misaligned_axes();
  const Eigen::RowVector3d sees =
      tilted ? Eigen::RowVector3d(axis * observation.accel_sensing_directions.sensing_directions.inverse()) : axis;
  for (int i = 0; i < 3; ++i) {
    if ((observation.clipping.accel >> i & 1u) != 0 && std::abs(sees[i]) > kNegligibleCoupling) return false;
  }
  return true;
}

Eigen::Matrix3d axes_of_auxiliary(const Eigen::Matrix3d& R_CI, const SensingDirections& elements,
                                  bool is_element_clipped) {
  return is_element_clipped ? Eigen::Matrix3d(elements.sensing_directions * R_CI) : R_CI;
}

// Returns the standard deviation of a reading due to an uncertain sensing direction.
double sensing_direction_sigma(const SensingDirections& elements, bool is_element_clipped, int j, double most) {
  return is_element_clipped ? elements.cross_axis_slope_sigma[j] * most : 0.0;
}

// minimum free-flight weight (1: free flight, 0: contact) at which a specific-force residual may change the
// calibration; contact forces would falsify the calibration
constexpr double kRigWeightMin = 0.05;

}  // namespace

void AngularRateModel::add_auxiliary_imus(const AngularRateObservation& observation,
                                          const AngularRateEstimate& estimate, const BodyImuConstants& rig,
                                          arrow::Block& block) const {
  for (std::size_t i = 0; i < params_.auxiliary_imus.size(); ++i) {
    const AuxiliaryImu& mount = params_.auxiliary_imus[i];
    const AuxiliaryReading& reading = observation.auxiliary_imus[i];
    const Eigen::Matrix3d R_CI = mount.T_imu_device.linear().transpose();
    // The lever arm of an auxiliary IMU starts at the primary IMU, not at the centre of mass: rate_smoother.md (R15).
    const AngularRateFactor rotation =
        flight_force_factor(estimate.knot, {.lever_arm_m = mount.T_imu_device.translation()}, Vector3d::Zero());
    const Vector3d force = observation.sample.specific_force_m_s2 - rig.accel_bias_m_s2 + rotation.residual;
    const double position_error_sigma_m_s2 =
        mount.position_error_m * (estimate.knot.rate_rad_s.squaredNorm() + estimate.knot.acceleration_rad_s2.norm());
    const Eigen::Matrix3d gyro =
        axes_of_auxiliary(R_CI, mount.gyro_sensing_directions, reading.rate_along_sensing_axes);
    const Eigen::Matrix3d accel =
        axes_of_auxiliary(R_CI, mount.accel_sensing_directions, reading.force_along_sensing_axes);
    for (int j = 0; j < 3; ++j) {
      if (std::isfinite(reading.rate_rad_s[j])) {
        AuxiliaryRow row = AuxiliaryRow::Zero();
        row.head<3>() = gyro.row(j);
        const double unknown = sensing_direction_sigma(mount.gyro_sensing_directions, reading.rate_along_sensing_axes,
                                                       j, estimate.knot.rate_rad_s.norm());
        add_row(row, gyro.row(j).dot(estimate.knot.rate_rad_s) - reading.rate_rad_s[j],
                std::hypot(reading.rate_sigma_rad_s[j], unknown), block);
      }
      const Eigen::RowVector3d axis = accel.row(j);
      if (!std::isfinite(reading.force_m_s2[j]) || !depends_only_on_unclipped_axes(axis, observation)) continue;
      AuxiliaryRow row = axis * rotation.jacobian_knot;
      row.tail<3>() /= time_scale_s_;
      const double unknown =
          sensing_direction_sigma(mount.accel_sensing_directions, reading.force_along_sensing_axes, j, force.norm());
      const double lasting = std::sqrt((position_error_sigma_m_s2 * position_error_sigma_m_s2 + unknown * unknown) /
                                           independent_sample_fraction_ +
                                       total_accel_variance(observation));
      const double sigma = std::hypot(reading.force_sigma_m_s2[j], lasting);
      add_row(row, axis.dot(force) - reading.force_m_s2[j], sigma, block);
    }
  }
}

bool AngularRateModel::has_no_error_information(const AngularRateEstimate& estimate) {
  return estimate.flight_weight < kRigWeightMin;
}

// Sets the derivatives of the specific-force residual with respect to the calibration and the rates of unclipped axes
// to zero. A contact force therefore cannot change the calibration or the rates of unclipped axes.
void AngularRateModel::exclude_from_calibration(const AngularRateObservation& o, AngularRateFactor& flight) {
  flight.jacobian_calibration.setZero();
  for (int j = 0; j < 3; ++j) {
    if ((o.unmeasured_axes() >> j & 1u) == 0) flight.jacobian_knot.col(j).setZero();
  }
}

// See rate_smoother.md (R7).
AngularRateKnot AngularRateModel::knot_at_reading(const AngularRateObservation& observation,
                                                  const AngularRateEstimate& estimate) const {
  const AngularRateKnot& knot = estimate.knot;
  return {knot.rate_rad_s - observation.gyro_age_s * knot.acceleration_rad_s2, knot.acceleration_rad_s2};
}

Vector3d AngularRateModel::corrected_rate(const AngularRateObservation& observation,
                                          const AngularRateEstimate& estimate) const {
  const Vector3d& reading = observation.sample.angular_velocity_rad_s;
  if (uses_raw_readings_) return reading;
  return reading - params_.errors.gyro * estimate.knot.rate_rad_s -
         params_.errors.g_sensitivity_s_m * observation.sample.specific_force_m_s2;
}

AngularRateFactor AngularRateModel::flight(const AngularRateObservation& observation, const AngularRateKnot& knot,
                                           const BodyImuConstants& rig, Vector3d* jacobian_delay) const {
  const Vector3d& reading = observation.sample.specific_force_m_s2;
  const double delay_s = params_.errors.accel_delay_s + observation.accel_age_s;
  if (uses_raw_readings_ && delay_s == 0.0 && jacobian_delay == nullptr) return flight_force_factor(knot, rig, reading);
  const Vector3d force = reading - params_.errors.accel * reading;
  AngularRateFactor out = delayed_flight_force_factor(knot, rig, force, delay_s, jacobian_delay);
  // Averaging over the accelerometer's window changes the specific force in proportion to its second time derivative:
  // rate_smoother.md (R13).
  out.residual += 0.5 * params_.errors.accel_filter_time_variance_s2 * flight_angular_jerk(knot, rig);
  return out;
}

AngularRateFactor AngularRateModel::flight_force_calibration_jacobian(const AngularRateObservation& observation,
                                                                      const AngularRateKnot& knot,
                                                                      const BodyImuConstants& rig) const {
  const Vector3d& reading = observation.sample.specific_force_m_s2;
  const double delay_s = params_.errors.accel_delay_s + observation.accel_age_s;
  if (uses_raw_readings_ && delay_s == 0.0) return flight_force_factor(knot, rig, reading);
  AngularRateFactor out =
      delayed_flight_calibration_jacobian(knot, rig, reading - params_.errors.accel * reading, delay_s);
  out.residual += 0.5 * params_.errors.accel_filter_time_variance_s2 * flight_angular_jerk(knot, rig);
  return out;
}

// See rate_smoother.md (R36), (R38).
void AngularRateModel::add_sensor_errors(const AngularRateObservation& observation, const AngularRateEstimate& estimate,
                                         const BodyImuConstants& rig, arrow::ErrorMatrix& block,
                                         arrow::BorderErrors& border, SensorErrorInformation& evidence,
                                         bool rig_spread) const {
  constexpr int kGyroBias = 3, kAccelBias = 6;
  using Row = Eigen::Matrix<double, 1, SensorErrors::kSize>;
  const Vector3d &rate = estimate.knot.rate_rad_s, &force = observation.sample.specific_force_m_s2;
  const auto add = [&](const Row& by_errors, double information, double residual) {
    evidence.information.noalias() += information * by_errors.transpose() * by_errors;
    evidence.gradient.noalias() -= information * residual * by_errors.transpose();
  };

  const bool is_element_clipped = observation.has_clipped_sensing_axis();
  if (rig_spread && is_element_clipped) return;
  const Vector3d reading = corrected_rate(observation, estimate);
  const AngularRateFactor gyro = is_element_clipped
                                     ? sensing_axis_factor(knot_at_reading(observation, estimate), rig, reading)
                                     : gyro_factor(knot_at_reading(observation, estimate), rig, reading);
  const unsigned lost =
      observation.clipping.unusable_gyro | (observation.clipping.gyro & ~observation.partial_saturation_flags);
  for (int j = 0; j < 3; ++j) {
    if ((lost >> j & 1u) != 0) continue;
    const Eigen::RowVector3d sees = gyro.jacobian_knot.row(j).head<3>();
    Row by_errors = Row::Zero();
    for (int i = 0; i < 3; ++i) {
      by_errors.segment<3>(3 * i) = sees[i] * rate.transpose();
      by_errors.segment<3>(SensorErrors::kGSensitivity + 3 * i) = sees[i] * force.transpose();
    }
    const double information = gyro_information(observation, estimate, j);
    const double part =
        (observation.partial_saturation_flags >> j & 1u) != 0 ? observation.expected_saturation_deficit_rad_s[j] : 0.0;
    const Row pull = information * by_errors;
    block.topRows<3>().noalias() -= sees.transpose() * pull;
    block.bottomRows<3>().noalias() += observation.gyro_age_s / time_scale_s_ * sees.transpose() * pull;
    border.middleRows<3>(kGyroBias).noalias() -= sees.transpose() * pull;
    if (is_element_clipped) {
      const int first = BodyImuConstants::kGyroMisalignmentIndex + 2 * j;
      border.middleRows<2>(first).noalias() -= gyro.jacobian_calibration.block<1, 2>(j, first).transpose() * pull;
    }
    add(by_errors, information, gyro.residual[j] - part);
  }

  if (rig_spread || has_no_error_information(estimate)) return;
  if (observation.clipping.accel != 0 && observation.accel_sensing_directions.has_misaligned_axes())
    return;  // misaligned sensing elements mix the output axes
  auto [flight, information] = force_factor(observation, estimate, rig);
  Vector3d jacobian_delay;
  (void)this->flight(observation, estimate.knot, rig, &jacobian_delay);
  const Vector3d curvature = flight_angular_jerk(estimate.knot, rig);
  flight.jacobian_knot.rightCols<3>() /= time_scale_s_;
  for (int j = 0; j < 3; ++j) {
    if (flight.jacobian_knot.row(j).isZero()) continue;  // the lower bound from the saturated element is satisfied
    Row by_errors = Row::Zero();
    by_errors.segment<3>(SensorErrors::kAccel + 3 * j) = force.transpose();
    by_errors[SensorErrors::kDelay] = jacobian_delay[j];
    by_errors[SensorErrors::kAccelFilterTimeVariance] = 0.5 * curvature[j];
    const Row pull = information[j] * by_errors;
    block.noalias() -= flight.jacobian_knot.row(j).transpose() * pull;
    border.topRows<3>().noalias() -= flight.jacobian_calibration.row(j).head<3>().transpose() * pull;
    border.row(kAccelBias + j) -= pull;
    add(by_errors, information[j], flight.residual[j]);
  }
}

// See rate_smoother.md (R49).
Eigen::Matrix3d AngularRateModel::output_covariance(const Eigen::Matrix3d& covariance,
                                                    const AngularRateObservation& observation,
                                                    const AngularRateEstimate& estimate) const {
  const double factor = 1.0 + (params_.expert.contact.kSigmaFactor - 1.0) * (1.0 - estimate.flight_weight);
  Vector3d wider = Vector3d::Ones();
  for (int j = 0; j < 3; ++j) {
    if ((observation.clipping.gyro >> j & 1u) != 0 || (observation.clipping.unusable_gyro >> j & 1u) != 0)
      wider[j] = factor;
  }
  const Vector3d late = params_.expert.kGyroTimeSigma_s * estimate.knot.acceleration_rad_s2;
  Eigen::Matrix3d timed = covariance + late * late.transpose();
  if (observation.has_clipped_sensing_axis()) {
    // A contact force also changes the rate of unclipped axes within the averaging window of a sample.
    const double struck =
        params_.expert.kGyroTimeSigma_s * params_.expert.contact.kGain_rad_m * estimate.contact_force_m_s2.norm();
    timed.diagonal().array() += struck * struck;
  }
  return wider.asDiagonal() * timed * wider.asDiagonal();
}

}  // namespace tumble
