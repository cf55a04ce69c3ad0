// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lag_window.hpp"
#include "prediction.hpp"

namespace tumble::mapping {

/// FrameChange converts estimates from the local frame W to the frame M of a prior map.
struct FrameChange {
  Eigen::Isometry3d T_prior_map_world;
  /// covariance of T_MW in axes of M: displacement and rotation of frame W about the point `sensor_in_prior_map_m`
  Eigen::Matrix<double, 6, 6> covariance;
  Eigen::Vector3d sensor_in_prior_map_m;

  void apply(SweepBoundary& boundary) const;
  void apply(LagWindow& window) const;

 private:
  void apply(Registration::Estimate& mean) const;
  /// Rotates a covariance of all unknowns from frame W to frame M, and adds the error of T_MW.
  void apply(const Registration::Estimate& mean, Registration::Matrix& of_all) const;
  Registration::Matrix rotation() const;
};

}  // namespace tumble::mapping
