// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "tumble/tumble.hpp"

/// A sphere that rolls without slip along x, from rest to rest, in closed form.
namespace tumble::test {

inline constexpr double kRadius_m = 0.145, kGravity_m_s2 = 9.80665, kRest_s = 1.5, kRoll_s = 2.0, kRevolutions = 2.0;

/// Turned so far [rad]: from rest to rest, two turns about y.
inline double angle_rad(double t_s) {
  const double u = std::clamp((t_s - kRest_s) / kRoll_s, 0.0, 1.0);
  return kRevolutions * 2.0 * M_PI * u * u * u * (10.0 + u * (-15.0 + 6.0 * u));
}

/// What a unit at p_B of a sphere that rolls without slip along x reads at 250 Hz: means of windows by differences of
/// the closed form.
inline std::vector<ImuSample> unit_at(const Eigen::Vector3d& p_B_m) {
  std::vector<ImuSample> out;
  constexpr double kStep_s = 0.004;
  const auto turned = [](double t_s) { return Eigen::AngleAxisd(angle_rad(t_s), Eigen::Vector3d::UnitY()); };
  const auto position = [&](double t_s) {
    return Eigen::Vector3d(Eigen::Vector3d(kRadius_m * angle_rad(t_s), 0.0, 0.0) + turned(t_s) * p_B_m);
  };
  for (int k = 1; k * kStep_s <= kRest_s + kRoll_s + 1.5; ++k) {
    const double a_s = (k - 1) * kStep_s, b_s = k * kStep_s, middle_s = 0.5 * (a_s + b_s), h_s = 0.5 * kStep_s;
    ImuSample sample;
    sample.time_ns = k * TimeNs{4'000'000};
    sample.angular_velocity_rad_s = {0.0, (angle_rad(b_s) - angle_rad(a_s)) / kStep_s, 0.0};
    const Eigen::Vector3d acceleration = (position(b_s) - 2.0 * position(middle_s) + position(a_s)) / (h_s * h_s);
    sample.specific_force_m_s2 =
        turned(middle_s).inverse() * Eigen::Vector3d(acceleration + kGravity_m_s2 * Eigen::Vector3d::UnitZ());
    out.push_back(sample);
  }
  return out;
}

/// Parameters of such a sphere with units at these positions.
inline RollingOdometry::Params params_of(const std::vector<Eigen::Vector3d>& positions_m) {
  RollingOdometry::Params params;
  params.radius_m = kRadius_m;
  params.lag_s = 0.5;
  for (const Eigen::Vector3d& position_m : positions_m) {
    RollingOdometry::ImuSetup& unit = params.imus.emplace_back();
    unit.data_sheet = sheets::phidget1044();
    unit.T_BI.translation() = position_m;
  }
  return params;
}

inline const std::vector<Eigen::Vector3d> kPositions = {{0.03, 0.0, 0.0}, {-0.02, 0.03, 0.01}, {0.0, -0.03, -0.02}};
inline const double kPathLength_m = kRevolutions * 2.0 * M_PI * kRadius_m;

}  // namespace tumble::test
