// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <span>

#include "tumble/attitude/detail/imu_merge_setup.hpp"

namespace tumble {

/// Estimates the errors of several accelerometers on one rigid body from the differences between their readings. For
/// each accelerometer, a Kalman filter estimates bias, scale and misalignment M, and position error. Errors that all
/// accelerometers share are not observable, and their estimates remain close to zero.
class ForceErrors {
 public:
  static constexpr int kImus = ImuMergeSetup::kImus;
  static constexpr int kErrorsPerImu = 15;  ///< bias, rows of M, position error
  static constexpr int kStates = kImus * kErrorsPerImu;
  static constexpr double kCorrelationTime_s = 0.032;
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  struct State {
    Vector x = Vector::Zero();
    Covariance error_covariance = Covariance::Zero();
    // Sums over the current averaging interval.
    Eigen::Matrix<double, 3, kImus> force_difference_m_s2 = Eigen::Matrix<double, 3, kImus>::Zero();
    Eigen::Matrix<double, 3, kImus> force_m_s2 = Eigen::Matrix<double, 3, kImus>::Zero();
    Eigen::Matrix3d jacobian_position = Eigen::Matrix3d::Zero();
    double acceleration_rad_s2 = 0.0;
    int samples = 0;
    double span_s = 0.0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  explicit ForceErrors(const ImuMergeSetup& setup) : setup_(setup) {}

  /// Processes the specific forces of all IMUs in common axes C, measured over `dt_s`. Cost: O((kErrorsPerImu
  /// count)^2), no allocation.
  void calibrate(std::span<const Eigen::Vector3d> forces_m_s2, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& acceleration_rad_s2, double dt_s, State& state) const;

  static Eigen::Vector3d corrected(int k, const Eigen::Vector3d& force_m_s2, const State& state);

  static Eigen::Vector3d position_error_m(int k, const State& state) {
    return state.x.segment<3>(kErrorsPerImu * k + kErrorsPerImu - 3);
  }

 private:
  // prior standard deviations of the bias, of each entry of M, and of the position error
  static constexpr double kBiasSigma_m_s2 = 0.05, kScaleSigma = 4e-3, kPositionSigma_m = 1.5e-3;
  static constexpr double kNoise_m_s2 =
      0.06;  // standard deviation of a force difference, averaged over kCorrelationTime_s
  static constexpr double kAccelerationNoiseRatio = 0.02;  // additional noise relative to the tangential force
  static constexpr double kGateSigmas = 5.0;               // largest accepted innovation, in standard deviations

  Eigen::Vector3d imu_position_m(int k) const { return setup_.T_mean_imu[static_cast<std::size_t>(k)].translation(); }
  void update(State& state) const;

  ImuMergeSetup setup_;
};

}  // namespace tumble
