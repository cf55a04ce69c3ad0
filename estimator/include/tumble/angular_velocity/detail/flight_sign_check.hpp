// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Detects wrong signs or swapped axes of the accelerometer, and wrong sign or scale of the gyro, from free flight.
/// Checks at rest cannot detect mirrored forces (three axes flipped, one axis flipped, two axes swapped), because
/// mirrored gravity has the correct magnitude and rotation.
///
/// In free flight, the force at the lever arm t from the centre of mass is a x t + w x (w x t), with the rate w and the
/// angular acceleration a. FlightSignCheck compares the readings with the force of free flight, for the true sensor and
/// for each alternative in `kAlternatives`. If the readings agree with an alternative within `share` for at least
/// `run_s`, the flight time of the alternative increases. On the ground, readings agree with free flight only for a
/// shorter time. If one axis of the gyro is saturated, the force along the lever arm determines the rate of the
/// saturated axis. The force along the lever arm is
/// -|w x t|^2 for any angular acceleration. The remaining two components of the force verify that the body is in
/// flight.
///
/// A person who swings a body can produce the forces of a flight with a different lever arm. For a body that may be
/// hand-held, FlightSignCheck therefore reports only inverted accelerometers and a half-scale gyro, from unsaturated
/// rates. FlightSignCheck detects wrong sensors only if the body flies while spinning, the IMU is off the centre of
/// mass, and at most one gyro axis clips. A lever arm with the wrong sign looks like an inverted accelerometer.
class FlightSignCheck {
 public:
  static constexpr double kMemory_s = 60.0;

  /// Number of sensor alternatives, and index of the half-scale gyro. Alternative 0 is the true sensor. The next
  /// alternatives are errors of the accelerometer, then errors of the gyro: all axes flipped, one axis flipped, two
  /// axes swapped.
  static constexpr std::size_t kAlternatives = 17, kHalfScaleGyro = 16;

  enum class Body { may_be_hand_held, thrown };

  struct Params {
    Body body = Body::may_be_hand_held;
    /// Lever arm from the centre of mass to the IMU, in IMU axes.
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();
    double gyro_range_rad_s = 0.0;          ///< range from the data sheet; 0: unknown
    double reading_s = 0.01;                ///< averaging time of readings
    double force_min_m_s2 = 2.5;            ///< minimum force in free flight due to rotation about the centre of mass
    double share = 0.25;                    ///< tolerance of the agreement, relative to the force of free flight
    double run_s = 0.02;                    ///< minimum duration of agreement
    double alternative_flight_min_s = 0.1;  ///< minimum total flight time of an alternative sensor
    double half_scale_flight_min_s = 0.3;   ///< minimum total flight time of a half-scale gyro
    /// Minimum ratio of the flight times of an alternative and of the true sensor.
    double alternative_ratio_min = 4.0;
    double thrown_ratio_min = 2.0;  ///< like alternative_ratio_min, for a body that is not hand-held
    double gap_max_s = 0.1;         ///< a longer gap resets the current run

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.lever_arm_m,
            {"lever_arm_m", "m", -1e3, 1e3, "lever arm: vector from the centre of mass to the IMU, IMU axes"});
      visit(p.gyro_range_rad_s,
            {"gyro_range_rad_s", "rad/s", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
      visit(p.reading_s, {"reading_s", "s", 1e-3, 1.0, "duration over which readings are averaged"});
      visit(p.force_min_m_s2,
            {"force_min_m_s2", "m/s^2", 1e-3, 1e6,
             "minimum force that the rotation causes at the lever arm; readings with a smaller force are ignored"});
      visit(p.share, {"share", "1", 1e-3, 0.9,
                      "maximum difference between the measured force and the force predicted for flight, as a share of "
                      "the predicted force"});
      visit(p.run_s, {"run_s", "s", 0.0, 10.0, "minimum duration of a flight; shorter flights are ignored"});
      visit(p.alternative_flight_min_s,
            {"alternative_flight_min_s", "s", 0.0, 1e3,
             "minimum flight time that another sensor orientation must explain before a fault is reported"});
      visit(p.half_scale_flight_min_s,
            {"half_scale_flight_min_s", "s", 0.0, 1e3,
             "minimum flight time that twice the measured rate must explain before a fault is reported"});
      visit(p.alternative_ratio_min,
            {"alternative_ratio_min", "1", 0.0, 1e6,
             "minimum ratio for a fault: flight time that the other orientation explains, divided by the flight time "
             "that the stated orientation explains"});
      visit(p.thrown_ratio_min,
            {"thrown_ratio_min", "1", 0.0, 1e6, "minimum ratio for a fault if the body is not hand-held"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-3, 1e3, "maximum time between two samples of one flight"});
    }
  };
  /// Reading is one averaged IMU reading.
  struct Reading {
    TimeNs time_ns = 0;
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero(), force_m_s2 = Eigen::Vector3d::Zero();
    /// Sign of the rate on each saturated gyro axis; 0 for an unsaturated axis.
    Eigen::Vector3d at_rail = Eigen::Vector3d::Zero();
    bool known = false;  ///< false if an axis was saturated during a part of the window
    bool operator==(const Reading&) const = default;
  };
  struct State {
    ImuAverage average;
    std::array<Reading, 2> before{};                        ///< the last two readings, oldest first
    int readings = 0;                                       ///< number of valid entries of `before`
    std::array<double, kAlternatives> run_s{};              ///< current flight duration of each alternative
    std::array<double, kAlternatives> flight_duration_s{};  ///< total flight duration of each alternative
    TimeNs last_flight_end_ns = 0;                          ///< end of the last flight of an alternative
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit FlightSignCheck(const Params& params);

  /// Processes one IMU sample. Cost: O(1), no allocation. Samples that are not finite or out of order are ignored.
  void step(const ImuSample& sample, State& state) const;

  /// Returns `out_of_range` if the measured flights match a sensor with wrong signs, axes or scale, and otherwise `ok`.
  Status verdict(const State& state) const;
  /// Returns verdict() while the last flight of an alternative sensor is at most kMemory_s old, and otherwise `ok`.
  Status current_verdict(const State& state) const;

 private:
  Reading reading_of(const ImuSample& mean, double rate_peak_rad_s) const;
  void process_reading(const Reading& now, State& state) const;

  Params params_;
};

}  // namespace tumble
