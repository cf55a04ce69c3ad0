// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/LU>
#include <cmath>

#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

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

}  // namespace tumble
