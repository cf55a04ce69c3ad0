// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <optional>

#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Unknowns of the registration in this order: position, attitude (left perturbation in world axes) and velocity of the
/// IMU at the start of the trajectory, saturation deficit of the gyro, LidarImuCalibration.
struct RegistrationUnknowns {
  static constexpr int kMotionSize = 9;
  static constexpr int kFirstDeficitUnknown = kMotionSize;  ///< saturation deficit, one support point after another
  static constexpr int kFirstCalibrationUnknown =
      kFirstDeficitUnknown + SweepTrajectory::kDeficitUnknowns;  ///< LidarImuCalibration
  static constexpr int kUnknowns = kFirstCalibrationUnknown + LidarImuCalibration::kErrorCount;
  using Vector = Eigen::Matrix<double, kUnknowns, 1>;
  using Matrix = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Deficit = SweepTrajectory::Deficit;

  struct Estimate {
    MotionState state;  ///< the covariance is not used
    LidarImuCalibration calibration;
    Deficit saturation_deficit_rad_s = Deficit::Zero();

    void add(const Vector& error);
    /// Returns the difference between this estimate and `other`, in the order of the unknowns.
    Vector minus(const Estimate& other) const;
  };

  /// Prior distribution of the registration's unknowns, from the inertial prediction. A saturation deficit or
  /// calibration value with variance 0 is not estimated.
  struct Prior {
    Estimate mean;
    Matrix covariance = Matrix::Zero();
    Deficit initial_saturation_deficit_rad_s = Deficit::Zero();  ///< value in the first iteration
    std::optional<MotionState> start;                            ///< motion in the first iteration; empty: the mean

    Prior() = default;
    /// Prior without estimation of saturation deficit and calibration.
    explicit Prior(const MotionState& state) : mean{state, {}, Deficit::Zero()} {
      covariance.topLeftCorner<kMotionSize, kMotionSize>() = state.covariance;
    }
  };
};

}  // namespace tumble
