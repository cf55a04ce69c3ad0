// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Estimates the rate of a body beyond the range of its gyros from force differences between accelerometers. An
/// extended Kalman filter estimates rate, angular acceleration, the specific force at the mean position of the IMUs,
/// and the error of each lever arm. Readings that are flagged as clipped or beyond the range are lower bounds.
///
/// AngularRateRecovery neglects scale errors, and calibrates the lever arms relative to the gyro's scale. IMUs at one
/// position provide no information about the rate.
class AngularRateRecovery {
 public:
  static constexpr int kImus = 4;
  static constexpr int kStates = 9 + 3 * kImus;
  /// duration of a reading for which ReadingNoise holds; shorter readings have more noise
  static constexpr double kReadingInterval_s = 4e-3;
  static constexpr double kMinSaturatedRangeFraction =
      0.5;  ///< fraction of the gyro's range above which the filter runs
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  struct ReadingNoise {
    double rate_rad_s = 0.03;    ///< bound (0, 10]
    double rate_share = 0.003;   ///< additional noise, as a fraction of the reading; bound [0, 1]
    double force_m_s2 = 0.3;     ///< bound (0, 1e3]
    double force_share = 0.004;  ///< additional noise, as a fraction of the reading; bound [0, 1]
  };
  struct Params {
    std::array<Eigen::Isometry3d, kImus> T_mean_imu{};  ///< poses of the IMUs relative to their mean position
    int count = 1;                                      ///< bound [1, kUnits]
    double gyro_range_rad_s = 1e3;                  ///< readings at or above this rate are saturated; bound (0, 1e3]
    double accel_range_m_s2 = 1e5;                  ///< bound (0, 1e5]
    double lever_arm_sigma_m = 1.5e-3;              ///< prior standard deviation of the lever arm; bound (0, 10]
    double acceleration_walk_rad_s2_sqrts = 200.0;  ///< random walk of the angular acceleration; bound (0, 1e6]
    double force_walk_m_s2_sqrts = 25.0;            ///< random walk of the common force; bound (0, 1e6]
    double recovered_sigma_rad_s = 1.0;  ///< rates with a larger standard deviation remain clipped; bound (0, 1e3]
    ReadingNoise noise;
    /// sensing directions, along which the unsaturated elements of a clipped sensor are used
    std::array<SensingDirections, kImus> gyro_sensing_directions{}, accel_sensing_directions{};
  };
  struct State {
    Vector x = Vector::Zero();  ///< rate, angular acceleration, force, lever arm errors (axes C)
    Covariance error_covariance = Covariance::Zero();
    bool started = false;  ///< true if the filter has been initialised
    bool running = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit AngularRateRecovery(const Params& params);

  /// `dt_s` is the time since the previous readings; each IMU's readings are in its own axes. IMUs whose readings are
  /// not finite are ignored. `merged` contains the mean of the used IMUs in axes C, and receives the recovered rate and
  /// force. The gyro flags of `merged` are set if the rate could not be recovered. The accelerometer flags are set if
  /// most accelerometers are saturated, or if one accelerometer and a gyro are saturated. All other clip flags are
  /// cleared. Cost: O(count), no allocation.
  void step(std::span<const ImuSample> units, double dt_s, State& state, ImuSample& merged) const;

 private:
  struct SaturatedSensors {
    bool rate = false;   ///< a gyro is saturated
    bool force = false;  ///< enough accelerometers are saturated to corrupt the mean force
  };
  bool is_rate_saturated(const ImuSample& unit, int axis) const;
  bool is_force_saturated(const ImuSample& unit, int axis) const;
  SaturatedSensors find_saturated_sensors(std::span<const ImuSample> units) const;
  void start(const ImuSample& merged, State& state) const;
  void predict(double dt_s, State& state) const;
  void measure_rates(std::span<const ImuSample> units, double dt_s, State& state) const;
  void measure_forces(std::span<const ImuSample> units, double dt_s, State& state) const;

  Params params_;
};

}  // namespace tumble
