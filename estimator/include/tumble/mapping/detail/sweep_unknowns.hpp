// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Order of the unknowns: position, attitude (left perturbation in world axes) and velocity at the start of the
/// trajectory, saturation deficit of clipped axes, calibration.
struct RegistrationUnknowns {
  static constexpr int kMotionSize = 9;  ///< position, attitude, velocity
  static constexpr int kFirstDeficitUnknown =
      kMotionSize;  ///< first unknown of the saturation deficit, one support point after another
  static constexpr int kFirstCalibrationUnknown =
      kFirstDeficitUnknown + SweepTrajectory::kDeficitUnknowns;  ///< first unknown of the calibration
  static constexpr int kUnknowns = kFirstCalibrationUnknown + LidarImuCalibration::kErrorCount;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Deficit = SweepTrajectory::Deficit;

  struct Estimate {
    MotionState state;  ///< motion state; its covariance is not used
    LidarImuCalibration calibration;
    Deficit saturation_deficit_rad_s = Deficit::Zero();

    void add(const Vector& error);
    /// Returns the errors that transform `other` to this estimate, in the order of the unknowns.
    Vector minus(const Estimate& other) const;
  };

  /// Prior distribution of the unknowns, from the inertial prediction. A variance of 0 fixes the saturation deficit or
  /// a calibration value.
  struct Prior {
    Estimate mean;
    Matrix covariance = Matrix::Zero();
    Deficit initial_saturation_deficit_rad_s = Deficit::Zero();  ///< initial value of the iterations
    std::optional<MotionState> start;                            ///< initial value of the motion; empty: the mean

    Prior() = default;
    /// The saturation deficit and the calibration are fixed.
    explicit Prior(const MotionState& state) : mean{state, {}, Deficit::Zero()} {
      covariance.topLeftCorner<kMotionSize, kMotionSize>() = state.covariance;
    }
  };
};

}  // namespace tumble
