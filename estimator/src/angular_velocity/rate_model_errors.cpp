// SPDX-License-Identifier: BSD-3-Clause
// What cannot be told from a run: the part of RateModel that keeps contact from the rig's constants and counts the
// errors of scale and misalignment.
#include "tumble/angular_velocity/rate_model.hpp"

namespace tumble {

namespace {

// Weight below which a sample may still draw a clipped rate towards flight, but says nothing of the rig: what is left
// of the pull of contact is small for the rate and large for constants that are not known yet.
constexpr double kRigWeightMin = 0.05;

}  // namespace

bool RateModel::says_nothing_of_rig(const RateEstimate& estimate) {
  return estimate.flight_weight < kRigWeightMin;
}

// The force of a sample in contact draws the rates that are not seen, and nothing else.
void RateModel::keep_from_rig(const RateObservation& o, RateFactor& flight) {
  flight.by_rig.setZero();
  for (int j = 0; j < 3; ++j) {
    // a rate that is seen would hand the pull on to the gyro's bias
    if ((o.unseen() >> j & 1u) == 0) flight.by_knot.col(j).setZero();
  }
}

void RateModel::add_gyro_errors(const RateObservation& observation, const RateEstimate& estimate,
                                const RigConstants& rig, arrow::ErrorMatrix& block, arrow::BorderErrors& border) const {
  constexpr int kGyroBias = 3;
  const unsigned lost = observation.clipping.void_gyro | (observation.clipping.gyro & ~observation.partial);
  const auto pull = [&](int j) -> Eigen::RowVector3d {
    return gyro_information(observation, estimate, j) * estimate.knot.rate_rad_s.transpose();
  };
  if (!observation.by_elements()) {
    for (int j = 0; j < 3; ++j) {
      block.row(j).segment<3>(3 * j) += pull(j);
      border.row(kGyroBias + j).segment<3>(3 * j) += pull(j);
    }
    return;
  }
  const RateFactor gyro = element_factor(estimate.knot, rig, observation.sample.angular_velocity_rad_s);
  for (int j = 0; j < 3; ++j) {
    if ((lost >> j & 1u) != 0) continue;
    block.middleCols<3>(3 * j).noalias() += gyro.by_knot.row(j).transpose().lazyProduct(pull(j)).eval();
    border.middleCols<3>(3 * j).noalias() += gyro.by_rig.row(j).transpose().lazyProduct(pull(j)).eval();
  }
}

void RateModel::add_accel_errors(const RateObservation& observation, const RateEstimate& estimate,
                                 const RigConstants& rig, arrow::ErrorMatrix& block,
                                 arrow::BorderErrors& border) const {
  auto [flight, information] = force_factor(observation, estimate, rig);
  if (says_nothing_of_rig(estimate)) keep_from_rig(observation, flight);
  flight.by_knot.rightCols<3>() /= time_scale_s_;
  const Eigen::RowVector3d force = information * observation.sample.specific_force_m_s2.transpose();
  for (int j = 0; j < 3; ++j) {
    block.middleCols<3>(3 * j).noalias() += flight.by_knot.row(j).transpose().lazyProduct(force);
    border.middleCols<3>(3 * j).noalias() += flight.by_rig.row(j).transpose().lazyProduct(force);
  }
}

}  // namespace tumble
