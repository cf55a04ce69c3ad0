// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/recording.hpp"

/// A saturated sensing element limits the readings to a plane, which this file computes by a fit or in closed form. The
/// plane is y_j = +-rho + b + sum over k != j of c_k y_k, with c_k = -M_jk / M_jj, rho = r / M_jj and b = -o_j / M_jj.
/// The file sim/imu/elements.hpp defines the matrix M and the offset o; r is the saturation limit.
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

/// ClippedPlane is the saturation plane of sensing element j; its slopes are the sensitivities to the readings of the
/// axes j + 1 and j + 2, cyclically.
struct ClippedPlane {
  double first_slope, second_slope;  // [1]
  double distance, offset;           // rho and b [unit of the readings]
};
ClippedPlane plane_of(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset, double rail, int j);

/// Fits the saturation plane by least squares to the samples during which only sensing element j was saturated. The
/// plane is NaN if `samples` is below kFewestClipped.
inline constexpr int kFewestClipped = 10;
ClippedPlane fit_clipped_plane(const SensedTriad& triad, int j, int& samples);

}  // namespace tumble::scenarios
