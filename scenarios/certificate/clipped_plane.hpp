// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/recording.hpp"

/// The plane on which a saturated sensing element keeps its readings, fitted and in closed form. M and o are those of
/// sim/imu/elements.hpp, r is the limit:
///   y_j = +-rho + b + sum over k != j of c_k y_k,  c_k = -M_jk / M_jj, rho = r / M_jj, b = -o_j / M_jj
namespace tumble::scenarios {

/// Returns a motion that saturates every element. It rotates about x, y and z in turn beyond the gyro's limit [rad/s],
/// with some rotation about the other axes. A push along x saturates each accelerometer element [m/s^2] as it rotates
/// past.
sim::Truth beyond_every_rail(double gyro_rail_rad_s, double accel_rail_m_s2);

/// Readings of one triad with its sensing elements.
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

/// Fits the plane by least squares to samples in whose whole window only element j was saturated. `samples` receives
/// their number for the sign that had fewer; below kFewestClipped the plane is NaN.
inline constexpr int kFewestClipped = 10;
ClippedPlane fit_clipped_plane(const SensedTriad& triad, int j, int& samples);

}  // namespace tumble::scenarios
