// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/recording.hpp"

/// While sensing element j of an IMU is saturated, the readings y satisfy y_j = +-rho + b + sum over k != j of c_k y_k.
/// The equation describes a plane in the space of readings, with the limit rho, the offset b and the slopes c.
namespace tumble::scenarios {

sim::Truth beyond_every_rail(double gyro_rail_rad_s, double accel_rail_m_s2);

struct SensedTriad {
  const std::vector<Eigen::Vector3d>&readings, &unclipped;
  Eigen::Matrix3d axes;
  Eigen::Vector3d offset;
  double rail;
};
SensedTriad sensed_rates(const sim::ImuRecord& record, const sim::ImuTruth& truth, double rail_rad_s);
SensedTriad sensed_forces(const sim::ImuRecord& record, const sim::ImuTruth& truth, double rail_m_s2);

/// ClippedPlane is the plane that contains the readings of a gyro or accelerometer while one sensing element is
/// saturated. The slopes of the plane are the sensitivities of the sensing element to the two other axes, in cyclic
/// order.
struct ClippedPlane {
  double first_slope, second_slope;  // [1]
  double distance, offset;           // rho and b [unit of the readings]
};
ClippedPlane plane_of(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset, double rail, int j);

/// Fits a plane by least squares to the samples during which only the sensing element j was saturated.
inline constexpr int kFewestClipped = 10;
ClippedPlane fit_clipped_plane(const SensedTriad& triad, int j, int& samples);

}  // namespace tumble::scenarios
