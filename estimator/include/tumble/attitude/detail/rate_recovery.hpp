// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>

#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/common/imu.hpp"

namespace tumble {

/// The rate of a body beyond the range of its gyros, from what the turning does to several accelerometers on it.
///
/// An extended Kalman filter of rate, angular acceleration and the specific force at the units' mean position, which
/// turns in the body as gravity does, with the error of each unit's lever arm: f_k = c + a x r_k + w x (w x r_k). It
/// runs while a gyro is clipped or reads more than kFast of its range, so that the lever arms are learnt before the
/// gyro stands at its rail. A reading is clipped where its flag says so (which whoever has judged the unit sets, see
/// ClippingFinder: a device that flags nothing may clip below its range) and from the range on; of gyro and
/// accelerometer, such readings are bounds and no measurements.
///
/// Not modelled: errors of scale (the gyro's is what the lever arms are learnt with), units that share a position,
/// which tell nothing. An impact on the body reads as a spell of doubt, not as a rate.
class RateRecovery {
 public:
  static constexpr int kUnits = 4;
  static constexpr int kStates = 9 + 3 * kUnits;
  /// Shorter readings are noisier by the square root of their shortness, and say no more by being many.
  static constexpr double kReading_s = 4e-3;
  static constexpr double kFast = 0.5;  ///< share of the gyro's range from which on the filter runs
  using Vector = Eigen::Matrix<double, kStates, 1>;
  using Covariance = Eigen::Matrix<double, kStates, kStates>;

  /// What readings over kReading_s are off by.
  struct ReadingNoise {
    double rate_rad_s = 0.03;    ///< bound (0, 10]
    double rate_share = 0.003;   ///< more, as a share of the reading; bound [0, 1]
    double force_m_s2 = 0.3;     ///< bound (0, 1e3]
    double force_share = 0.004;  ///< more, as a share of the reading; bound [0, 1]
  };
  struct Params {
    std::array<Eigen::Isometry3d, kUnits> T_CI{};   ///< mountings of the units, about their mean position
    int count = 1;                                  ///< bound [1, kUnits]
    double gyro_range_rad_s = 1e3;                  ///< from here on a reading is at its rail; bound (0, 1e3]
    double accel_range_m_s2 = 1e5;                  ///< bound (0, 1e5]
    double lever_arm_sigma_m = 1.5e-3;              ///< prior; bound (0, 10]
    double acceleration_walk_rad_s2_sqrts = 200.0;  ///< of the angular acceleration; bound (0, 1e6]
    double force_walk_m_s2_sqrts = 25.0;            ///< of the common force; bound (0, 1e6]
    double recovered_sigma_rad_s = 1.0;             ///< a rate known no better than this stays clipped; bound (0, 1e3]
    ReadingNoise noise;
    /// Along what the elements of the units sense: while one clips, the axes beside it are off by what it hides, and
    /// the free ones are read along their rows.
    std::array<ElementRows, kUnits> gyro_elements{}, accel_elements{};
  };
  struct State {
    Vector x = Vector::Zero();  ///< rate, angular acceleration, force (C), lever arms of the units in error
    Covariance P = Covariance::Zero();
    bool started = false;  ///< lever arms have their prior
    bool running = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit RateRecovery(const Params& params);

  /// Takes the units' readings (of a unit that is not finite, none), each in its own axes, `dt_s` after the last ones;
  /// `merged` (C) holds the mean of those in use and gets rate and force of the filter where a rail made them wrong.
  /// Its clip flags of the gyro are set when the rate could not be recovered, those of the accelerometer when most
  /// units' were at their rail, or one's and a gyro's; else cleared: a rate that was recovered is none that is clipped.
  /// O(count), no allocation; little to do while the body turns slowly and no gyro is clipped.
  void step(std::span<const ImuSample> units, double dt_s, State& state, ImuSample& merged) const;

 private:
  /// What the units met.
  struct Met {
    bool rate = false;   ///< a gyro's rail
    bool force = false;  ///< so many accelerometers' that the common force is off
  };
  bool rate_railed(const ImuSample& unit, int axis) const;
  bool force_railed(const ImuSample& unit, int axis) const;
  Met met_by(std::span<const ImuSample> units) const;
  void start(const ImuSample& merged, State& state) const;
  void predict(double dt_s, State& state) const;
  void measure_rates(std::span<const ImuSample> units, double dt_s, State& state) const;
  void measure_forces(std::span<const ImuSample> units, double dt_s, State& state) const;

  Params params_;
};

}  // namespace tumble
