// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

#include "state_estimate.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble::mapping {

struct SweepBoundary {
  StateEstimate state_estimate;
  /// derivative of the unknowns at the end of the last sweep with respect to the unknowns at the start of the last
  /// sweep
  Registration::Matrix end_by_start_jacobian = Registration::Matrix::Identity();
  /// absolute value of the saturation factor of each gyro axis at the end of the last sweep: s_j of mapping.md (R8); 0
  /// for an unclipped gyro axis
  Eigen::Vector3d clipped_axis_sign = Eigen::Vector3d::Zero();
  Eigen::Matrix3d clipped_velocity_variance_m2_s2 =
      Eigen::Matrix3d::Zero();              ///< velocity covariance due to accelerometer saturation, in frame W
  bool all_directions_constrained = false;  ///< surfaces constrained the last sweep in all directions

  TimeNs time_ns() const { return state_estimate.mean.state.time_ns; }
};

struct MotionWindow {
  std::span<const MotionSample> samples;  ///< samples since the boundary, including samples after the sweep
  TimeNs end_ns = 0;
  int resting_sweeps = 0;  ///< consecutive sweeps at rest, including the current sweep
  /// mean specific force of a rest that the IMU detected, but that contradicts the estimated attitude
  std::optional<Eigen::Vector3d> contradicting_rest_force_I_m_s2 = std::nullopt;
};

struct Prediction {
  Registration::Prior prior;
  /// derivative of the predicted unknowns with respect to the unknowns at the end of the last sweep
  Registration::Matrix boundary_jacobian = Registration::Matrix::Identity();
  Registration::Matrix noise = Registration::Matrix::Zero();  ///< process noise
  Registration::Matrix motion_error_covariance =
      Registration::Matrix::Zero();  ///< covariance of the actual errors of the mean

  /// Before a call of compose_with_boundary(), the caller must set all other members.
  void compose_with_boundary(const StateEstimate& at_boundary);
  /// Sets the velocity to zero and removes the correlations of the velocity: mapping.md (R33). Must be called before
  /// compose_with_boundary().
  void zero_velocity_update(double sigma_m_s);
  /// Replaces the tilt by the tilt from the specific force at rest, and removes the correlations of the tilt. Must be
  /// called before compose_with_boundary().
  void level_update(const Eigen::Vector3d& force_I_m_s2, double sigma_rad);
};

/// `trajectory` is the inertially predicted motion since the end of the last sweep. `reading` is the odometer reading
/// of the sweep, or empty.
Prediction predict(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                   const MotionWindow& window, const SweepTrajectory& trajectory,
                   const std::optional<OdometerReading>& reading);

/// Predicts zero velocity for a sweep at rest after a tracking failure, because an integrated velocity would drift.
void predict_stationary_sweep(const SweepBoundary& boundary, Prediction& prediction);

bool prior_is_certain(const LidarInertialOdometry::Params& params, const SweepBoundary& boundary,
                      const MotionWindow& window, const SweepTrajectory& trajectory);

StateEstimate posterior(const Prediction& prediction);
/// See mapping.md (R52).
StateEstimate posterior(const Prediction& prediction, const Registration::Result& aligned);

/// Returns the normalised difference between registered and predicted motion: mapping.md (R62).
double innovation(const Prediction& prediction, const Registration::Estimate& aligned);

/// Returns whether the difference between registered and predicted pose passes a chi-square test, and is at most the
/// matching distance: mapping.md (R67). If the difference exceeds the matching distance, lidar returns may match wrong
/// surfaces by chance.
bool agrees_with_prediction(const LidarInertialOdometry::Params& params, const Prediction& prediction,
                            const Registration::Estimate& aligned, double innovation);

/// `alignment` is null if the sweep was not registered.
void sweep_boundary_after(const LidarInertialOdometry::Params& params, const StateEstimate& start,
                          const MotionWindow& window, const SweepTrajectory& trajectory,
                          const Registration::Result* alignment, SweepBoundary& boundary);

/// process noise covariance of position, attitude and velocity within a sweep
using MotionNoise = Eigen::Matrix<double, 9, 9>;

/// Updates the prediction of a sweep with an odometer reading that was measured during the sweep: mapping.md (R34) to
/// (R37). An odometer reading from a time outside of the sweep has no effect.
void fuse_reading(const OdometerReading& reading, const SweepBoundary& boundary, const MotionWindow& window,
                  const MotionNoise& within, Prediction& prediction);

}  // namespace tumble::mapping
