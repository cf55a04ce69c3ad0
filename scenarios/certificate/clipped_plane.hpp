// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/recording.hpp"

/// The plane that a sensing element at its rail keeps its readings on, fitted and in closed form, for the rows that
/// hold one to the other. For M and o of sim/imu/elements.hpp and the rail r:
///   y_j = +-rho + b + sum over k != j of c_k y_k,  c_k = -M_jk / M_jj, rho = r / M_jj, b = -o_j / M_jj
namespace tumble::scenarios {

/// Turns about x, y and z in turn beyond a gyro's rail [rad/s], and somewhat about the others; pushed along x so hard
/// that each element of an accelerometer meets its rail [m/s^2] as it comes round.
sim::Truth beyond_every_rail(double gyro_rail_rad_s, double accel_rail_m_s2);

/// One triad's readings with what its elements were.
struct SensedTriad {
  const std::vector<Eigen::Vector3d>&readings, &unclipped;
  Eigen::Matrix3d axes;
  Eigen::Vector3d offset;
  double rail;
};
SensedTriad sensed_rates(const sim::ImuRecord& record, const sim::ImuTruth& truth, double rail_rad_s);
SensedTriad sensed_forces(const sim::ImuRecord& record, const sim::ImuTruth& truth, double rail_m_s2);

/// The plane of element j; its slopes are against the axes j + 1 and j + 2, cyclically.
struct ClippedPlane {
  double first_slope, second_slope;  // [1]
  double distance, offset;           // rho and b [unit of the readings]
};
ClippedPlane plane_of(const Eigen::Matrix3d& axes, const Eigen::Vector3d& offset, double rail, int j);

/// Least squares over the samples in whose whole window element j alone was at its rail. `samples` gets their number of
/// the sign that had fewer: below kFewestClipped there is no plane (NaN).
inline constexpr int kFewestClipped = 10;
ClippedPlane fit_clipped_plane(const SensedTriad& triad, int j, int& samples);

}  // namespace tumble::scenarios
