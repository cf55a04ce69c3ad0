// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

namespace tumble {

/// What is unknown of a sweep, in the order of its vectors and matrices: position, attitude (left perturbation in W)
/// and velocity at the start of the trajectory, the saturation deficit of clipped axes, the calibration.
struct SweepUnknowns {
  static constexpr int kMotion = 9;         ///< position, attitude, velocity
  static constexpr int kDeficit = kMotion;  ///< first unknown of the saturation deficit, knot after knot
  static constexpr int kCalibration = kDeficit + SweepTrajectory::kDeficit;  ///< first unknown of the calibration
  static constexpr int kUnknowns = kCalibration + SweepCalibration::kErrors;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Deficit = SweepTrajectory::Deficit;

  /// Where the unknowns stand: motion at the start of the trajectory, saturation deficit, calibration.
  struct Estimate {
    MotionState state;  ///< its covariance is not used
    SweepCalibration calibration;
    Deficit deficit_rad_s = Deficit::Zero();

    /// Adds small errors in the order of the unknowns.
    void add(const Vector& error);
    /// The errors that take `other` to this.
    Vector minus(const Estimate& other) const;
  };

  /// What the inertial side believes, and how surely; an unknown of the deficit or the calibration with variance 0 is
  /// not estimated.
  struct Prior {
    Estimate mean;
    Matrix covariance = Matrix::Zero();
    Deficit deficit_start_rad_s = Deficit::Zero();  ///< where the iterations begin
    std::optional<MotionState> start;               ///< likewise for the motion; empty: at the mean

    Prior() = default;
    /// The state with its covariance, nothing else to be estimated.
    explicit Prior(const MotionState& state) : mean{state, {}, Deficit::Zero()} {
      covariance.topLeftCorner<kMotion, kMotion>() = state.covariance;
    }
  };
};

}  // namespace tumble
