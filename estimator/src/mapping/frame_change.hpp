// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "lag_window.hpp"
#include "prediction.hpp"

namespace tumble::mapping {

/// FrameChange converts estimates from the local map frame W to the frame M of a prior map.
struct FrameChange {
  Eigen::Isometry3d T_prior_map_world;
  /// covariance of the transform from the local frame W to the prior map frame M, in axes of M: displacement and
  /// rotation of frame W about the point `sensor_in_prior_map_m`
  Eigen::Matrix<double, 6, 6> covariance;
  Eigen::Vector3d sensor_in_prior_map_m;

  void apply(SweepBoundary& boundary) const;
  void apply(LagWindow& window) const;

 private:
  void apply(Registration::Estimate& mean) const;
  void apply(const Registration::Estimate& mean, Registration::Matrix& of_all) const;
  Registration::Matrix rotation() const;
};

/// PosesBeforeChange transforms poses from before the localisation to the frame M of the prior map.
class PosesBeforeChange {
 public:
  /// `last` is the pose in the local map frame W at the time of the localisation in the prior map.
  PosesBeforeChange(const FrameChange& change, const PoseState& last);

  /// Computes the covariance of an earlier pose from the covariance of the last pose and the displacement between the
  /// two poses.
  void apply(PoseState& pose) const;

 private:
  Eigen::Isometry3d T_prior_map_world_;
  Eigen::Vector3d last_M_m_;                       // position of the last pose
  Eigen::Matrix<double, 6, 6> last_covariance_M_;  // covariance of the last pose
};

}  // namespace tumble::mapping
