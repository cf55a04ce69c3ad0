// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <span>

#include "tumble/attitude/detail/imu_merge_setup.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Estimates the rate of a body beyond the range of its gyros from the differences between several accelerometers. An
/// extended Kalman filter estimates rate, angular acceleration, specific force at the mean position of the IMUs, and
/// the error of each IMU position. Clipped readings are lower bounds.
///
/// AngularRateRecovery neglects scale errors; estimated IMU positions absorb the scale error of the gyros. IMUs at one
/// position provide no information about the rate.
class AngularRateRecovery {
 public:
  static constexpr int kImus = ImuMergeSetup::kImus;
  static constexpr int kStates = 9 + 3 * kImus;
  /// averaging time for which the noise constants below hold; shorter readings have more noise
  static constexpr double kReadingInterval_s = 4e-3;
  static constexpr double kMinSaturatedRangeFraction =
      0.5;  ///< the filter runs above this fraction of the gyro's range
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  struct State {
    Vector x = Vector::Zero();  ///< rate, angular acceleration, specific force, errors of the IMU positions (axes C)
    Covariance error_covariance = Covariance::Zero();
    bool started = false;
    bool running = false;
    bool operator==(const State&) const = default;
  };

  /// `mean_imu_position_m` is the mean position of the IMUs in the axes of `setup`.
  AngularRateRecovery(const ImuMergeSetup& setup, const Eigen::Vector3d& mean_imu_position_m);

  /// Processes the readings `units` of all IMUs, each in its own axes, `dt_s` after the previous readings. IMUs whose
  /// readings are not finite are ignored. `merged` contains the mean of the used IMUs in axes C, and receives the
  /// recovered rate and force. The gyro flags of `merged` are set if the rate could not be recovered. The accelerometer
  /// flags are set if most accelerometers are saturated, or if one accelerometer and a gyro are saturated. Cost:
  /// O(count), no allocation.
  void step(std::span<const ImuSample> units, double dt_s, State& state, ImuSample& merged) const;

 private:
  static constexpr double kLeverArmSigma_m = 1.5e-3;  // prior standard deviation of each IMU position
  static constexpr double kAccelerationWalk_rad_s2_sqrts = 200.0;
  static constexpr double kForceWalk_m_s2_sqrts = 25.0;
  static constexpr double kRecoveredSigma_rad_s =
      1.0;  // rates with a larger standard deviation remain flagged as clipped
  // Noise of a gyro reading: a constant, and a fraction of the reading.
  static constexpr double kRateNoise_rad_s = 0.03, kRateNoiseRatio = 0.003;
  static constexpr double kForceNoise_m_s2 = 0.3, kForceNoiseRatio = 0.004;

  struct SaturatedSensors {
    bool rate = false;
    bool force = false;  ///< enough accelerometers are saturated to corrupt the mean force
  };
  bool is_rate_saturated(const ImuSample& unit, int axis) const;
  bool is_force_saturated(const ImuSample& unit, int axis) const;
  SaturatedSensors find_saturated_sensors(std::span<const ImuSample> units) const;
  void start(const ImuSample& merged, State& state) const;
  void predict(double dt_s, State& state) const;
  void measure_rates(std::span<const ImuSample> units, double dt_s, State& state) const;
  void measure_forces(std::span<const ImuSample> units, double dt_s, State& state) const;

  ImuMergeSetup setup_;  // with poses relative to the mean position of the IMUs
};

}  // namespace tumble
