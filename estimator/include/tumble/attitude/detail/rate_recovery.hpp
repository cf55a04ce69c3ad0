// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "tumble/angular_velocity/detail/rail_plane.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// Estimates the rate of a body beyond the range of its gyros from the force differences between several
/// accelerometers.
///
/// An extended Kalman filter estimates rate w, angular acceleration a and specific force c at the mean position of the
/// IMUs, and the error of each lever arm r_k. The measurement model of IMU k is f_k = c + a x r_k + w x (w x r_k). The
/// filter predicts that the specific force c is constant in world axes. The filter runs while a gyro is clipped or
/// reads more than kActiveRangeRatio * range. RateRecovery therefore calibrates the lever arms before a gyro saturates.
/// RateRecovery treats a reading as clipped if the reading is flagged or beyond the range. ClippingFinder sets the
/// flags for devices that clip below their range without reporting saturation. Clipped readings of gyro and
/// accelerometer are lower bounds.
///
/// RateRecovery neglects scale errors, and calibrates the lever arms relative to the gyro's scale. IMUs at one position
/// provide no information about the rate. An impact increases the uncertainty of the rate, but does not change the
/// estimated rate.
class RateRecovery {
 public:
  static constexpr int kUnits = 4;
  static constexpr int kStates = 9 + 3 * kUnits;
  /// The parameters in ReadingNoise hold for a reading of this duration. Readings of a shorter duration d have noise
  /// that is larger by the factor sqrt(kReading_s / d), so a higher sample rate adds no information.
  static constexpr double kReading_s = 4e-3;
  static constexpr double kActiveRangeRatio = 0.5;  ///< fraction of the gyro's range above which the filter runs
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  /// ReadingNoise contains the standard deviations of readings over kReading_s.
  struct ReadingNoise {
    double rate_rad_s = 0.03;    ///< bound (0, 10]
    double rate_share = 0.003;   ///< additional noise, as a fraction of the reading; bound [0, 1]
    double force_m_s2 = 0.3;     ///< bound (0, 1e3]
    double force_share = 0.004;  ///< additional noise, as a fraction of the reading; bound [0, 1]
  };
  struct Params {
    std::array<Eigen::Isometry3d, kUnits> T_CI{};   ///< poses of the IMUs relative to their mean position
    int count = 1;                                  ///< bound [1, kUnits]
    double gyro_range_rad_s = 1e3;                  ///< readings at or above this rate are saturated; bound (0, 1e3]
    double accel_range_m_s2 = 1e5;                  ///< bound (0, 1e5]
    double lever_arm_sigma_m = 1.5e-3;              ///< prior standard deviation of the lever arm; bound (0, 10]
    double acceleration_walk_rad_s2_sqrts = 200.0;  ///< random walk of the angular acceleration; bound (0, 1e6]
    double force_walk_m_s2_sqrts = 25.0;            ///< random walk of the common force; bound (0, 1e6]
    double recovered_sigma_rad_s = 1.0;  ///< rates with a larger standard deviation remain clipped; bound (0, 1e3]
    ReadingNoise noise;
    /// Sensing directions of the IMUs' sensing elements. While a sensing element clips, its saturation deficit corrupts
    /// the readings of all axes of the sensor. RateRecovery then uses the unsaturated sensing elements along their
    /// sensing directions.
    std::array<SensingDirections, kUnits> gyro_elements{}, accel_elements{};
  };
  struct State {
    Vector x = Vector::Zero();  ///< rate, angular acceleration, force, lever arm errors (axes C)
    Covariance P = Covariance::Zero();
    bool started = false;  ///< true if the filter has been initialised
    bool running = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RateRecovery(const Params& params);

  /// Processes the readings of all IMUs, each in its own axes, `dt_s` after the previous readings. IMUs whose readings
  /// are not finite are ignored. The argument `merged` contains the mean of the used IMUs in axes C. Where saturation
  /// corrupts the mean, step() replaces rate and force in `merged` by the estimates of the filter. The gyro flags of
  /// `merged` are set if the rate could not be recovered. The accelerometer flags are set if most accelerometers are
  /// saturated, or if one accelerometer and a gyro are saturated. All other flags are cleared, because a recovered rate
  /// is not clipped. Cost: O(count), no allocation; almost no computation while the body rotates slowly and no gyro is
  /// clipped.
  void step(std::span<const ImuSample> units, double dt_s, State& state, ImuSample& merged) const;

 private:
  /// SaturatedSensors describes the saturation of the current readings.
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
