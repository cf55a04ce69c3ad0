// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/rate_model.hpp"

namespace tumble {

namespace {

constexpr int kGyroBias = 3;

// Adds the residual of one sensing element to the normal equations: rate_smoother.md (R8). `age` is the age of the gyro
// reading divided by time_scale_s_. If the sensing direction is fixed at an uncertain value (covariance `rig_spread`),
// the residual has a smaller weight: rate_stream.md (R92).
void add_row(const AngularRateFactor& gyro, int j, double age, double information, double pull,
             const BodyImuConstants::Matrix* rig_spread, arrow::Block& block, arrow::Corner& corner) {
  const int first = BodyImuConstants::kGyroMisalignmentIndex + 2 * j;
  if (rig_spread != nullptr) {
    const Eigen::RowVector2d by_slopes = gyro.jacobian_calibration.block<1, 2>(j, first);
    const Eigen::Matrix2d unknown = rig_spread->block<2, 2>(first, first);
    const double share = 1.0 / (1.0 + information * by_slopes.dot(by_slopes * unknown));
    information *= share;
    pull *= share;
  }
  const Eigen::Vector3d row = gyro.jacobian_knot.row(j).head<3>();
  const Eigen::Vector3d weighted = information * row;
  const Eigen::RowVector2d is_element_clipped = gyro.jacobian_calibration.block<1, 2>(j, first);
  const Eigen::Matrix3d square = weighted.lazyProduct(row.transpose());
  const Eigen::Matrix<double, 3, 2> mixed = weighted.lazyProduct(is_element_clipped);
  block.diagonal.topLeftCorner<3, 3>() += square;
  block.border_coupling.block<3, 3>(0, kGyroBias) += square;
  block.gradient.head<3>() -= pull * row;
  if (age != 0.0) {
    block.diagonal.topRightCorner<3, 3>() -= age * square;
    block.diagonal.bottomLeftCorner<3, 3>() -= age * square;
    block.diagonal.bottomRightCorner<3, 3>() += age * age * square;
    block.border_coupling.block<3, 3>(3, kGyroBias) -= age * square;
    if (rig_spread == nullptr) block.border_coupling.block<3, 2>(3, first) -= age * mixed;
    block.gradient.tail<3>() += age * pull * row;
  }
  corner.matrix.block<3, 3>(kGyroBias, kGyroBias) += square;
  corner.gradient.segment<3>(kGyroBias) -= pull * row;
  if (rig_spread != nullptr) return;
  block.border_coupling.block<3, 2>(0, first) += mixed;
  corner.matrix.block<3, 2>(kGyroBias, first) += mixed;
  corner.matrix.block<2, 3>(first, kGyroBias) += mixed.transpose();
  corner.matrix.block<2, 2>(first, first) += information * is_element_clipped.transpose() * is_element_clipped;
  corner.gradient.segment<2>(first) -= pull * is_element_clipped.transpose();
}

}  // namespace

void AngularRateModel::add_sensing_axis_readings(const AngularRateObservation& observation,
                                                 const AngularRateEstimate& estimate, const BodyImuConstants& rig,
                                                 arrow::Block& block, arrow::Corner& corner,
                                                 const BodyImuConstants::Matrix* rig_spread) const {
  const AngularRateFactor gyro =
      sensing_axis_factor(knot_at_reading(observation, estimate), rig, corrected_rate(observation, estimate));
  for (int j = 0; j < 3; ++j) {
    if ((observation.clipping.unusable_gyro >> j & 1u) != 0) continue;
    double information = gyro_information(observation, estimate, j);
    double pull = information * gyro.residual[j];
    if ((observation.partial_saturation_flags >> j & 1u) != 0) {
      pull = information * (gyro.residual[j] - observation.expected_saturation_deficit_rad_s[j]);
    } else if ((observation.clipping.gyro >> j & 1u) != 0) {
      const bool kept = gyro.residual[j] * observation.sample.angular_velocity_rad_s[j] >= 0.0;
      if (kept && !estimate.use_soft_bounds) continue;  // the hard bound is satisfied: rate_smoother.md (R9)
      information = 1.0 / (params_.expert.kRailSigma_rad_s * params_.expert.kRailSigma_rad_s);
      pull = information * gyro.residual[j];
      if (estimate.use_soft_bounds) {
        information = estimate.lower_bound_precision[j];
        pull = information * gyro.residual[j] - estimate.lower_bound_information_mean[j];
      }
    }
    add_row(gyro, j, observation.gyro_age_s / time_scale_s_, information, pull, rig_spread, block, corner);
  }
}

Eigen::Vector3d AngularRateModel::accel_sensing_axis_readings(const AngularRateObservation& observation,
                                                              AngularRateFactor& flight) {
  Eigen::Vector3d unknown = Eigen::Vector3d::Zero();
  const unsigned clipped = observation.clipping.accel;
  if (clipped == 0) return unknown;
  const SensingDirections& elements = observation.accel_sensing_directions;
  if (elements.has_misaligned_axes()) {
    flight.residual = elements.sensing_directions * flight.residual;
    flight.jacobian_knot = (elements.sensing_directions * flight.jacobian_knot).eval();
    flight.jacobian_calibration = (elements.sensing_directions * flight.jacobian_calibration).eval();
  }
  double hidden2 = 0.0;
  for (int j = 0; j < 3; ++j) {
    if ((clipped >> j & 1u) == 0) continue;
    // A saturated accelerometer reading is a lower bound of the specific force. If the modelled specific force exceeds
    // a saturated reading, the residual is zero: rate_smoother.md (R9).
    if (flight.residual[j] * observation.sample.specific_force_m_s2[j] < 0.0) continue;
    hidden2 += flight.residual[j] * flight.residual[j];
    flight.residual[j] = 0.0;
    flight.jacobian_knot.row(j).setZero();
    flight.jacobian_calibration.row(j).setZero();
  }
  for (int j = 0; j < 3; ++j) {
    if ((clipped >> j & 1u) == 0)
      unknown[j] = elements.cross_axis_slope_sigma[j] * elements.cross_axis_slope_sigma[j] * hidden2;
  }
  return unknown;
}

}  // namespace tumble
