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

/// Whether the accelerometer's axes have the sense and the names that they say, and the gyro its sense and scale.
/// Forces of a mirrored world (all three axes flipped, one flipped, two swapped) show neither in gravity at rest nor in
/// its turning.
///
/// In free flight the force at the lever arm t from the centre of mass is a x t + w x (w x t) and nothing else.
/// Readings that are this within `share`, or would be of another sensor (`kSenses`), for `run_s` at a time are flight
/// as that sensor reads it; on the ground none lasts. Where one axis of the gyro is at its rail, the force along the
/// lever arm, which is -|w x t|^2 whatever the angular acceleration, tells its rate, and the other two components
/// whether it is flight. A hand that swings a body about itself makes the forces of a flight by a lever arm of its own:
/// of a body that is perhaps held only forces of the other sense and twice the rate are told, by rates that were read.
/// Not seen: a body that never flies and spins, whose IMU sits at its centre of mass, or two of
/// whose gyro's axes clip throughout its flights. A lever arm of the other sense looks the same.
class FlightSense {
 public:
  /// As it says; of the accelerometer, then of the gyro: all axes flipped, x, y or z flipped, x and y, y and z or z and
  /// x swapped; a gyro that reads half of what it should.
  static constexpr std::size_t kSenses = 17, kHalved = 16;

  enum class Body { perhaps_held, thrown };

  struct Params {
    Body body = Body::perhaps_held;
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from the centre of mass to the IMU, IMU axes
    double gyro_range_rad_s = 0.0;                          ///< as the device states it; 0: not stated
    double reading_s = 0.01;                                ///< readings are averaged to this length
    double force_min_m_s2 = 2.5;                            ///< that turning makes, to count
    double share = 0.25;                                    ///< of it, by which the reading may differ
    double run_s = 0.02;                                    ///< and for how long at least
    double against_s = 0.1;                                 ///< of flight by another sensor, from which on it is told,
    double halved_s = 0.3;      ///< of flight by twice the rate, likewise (a hand may make 0.15 s)
    double against_with = 4.0;  ///< and so many times what there is of the right one,
    double thrown_with = 2.0;   ///< of a body that nobody holds
    double gap_max_s = 0.1;     ///< after a longer one it begins anew

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.lever_arm_m,
            {"lever_arm_m", "m", -1e3, 1e3, "lever arm: vector from the centre of mass to the IMU, IMU axes"});
      visit(p.gyro_range_rad_s,
            {"gyro_range_rad_s", "rad/s", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
      visit(p.reading_s, {"reading_s", "s", 1e-3, 1.0, "duration over which readings are averaged"});
      visit(p.force_min_m_s2, {"force_min_m_s2", "m/s^2", 1e-3, 1e6,
                               "least force caused by the rotation at the lever arm, for a reading to count"});
      visit(p.share, {"share", "1", 1e-3, 0.9,
                      "largest difference between reading and predicted flight force, as a share of that force"});
      visit(p.run_s, {"run_s", "s", 0.0, 10.0, "shortest flight that counts"});
      visit(p.against_s, {"against_s", "s", 0.0, 1e3,
                          "flight time explained by another sensor orientation, from which a fault is reported"});
      visit(p.halved_s,
            {"halved_s", "s", 0.0, 1e3, "flight time explained by twice the rate, from which a fault is reported"});
      visit(p.against_with,
            {"against_with", "1", 0.0, 1e6,
             "least ratio of flight time explained by the other orientation to that of the stated one"});
      visit(p.thrown_with,
            {"thrown_with", "1", 0.0, 1e6, "least ratio of these flight times if the body is not hand-held"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-3, 1e3, "longest gap between samples within a flight"});
    }
  };
  /// One mean reading.
  struct Reading {
    TimeNs time_ns = 0;
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero(), force_m_s2 = Eigen::Vector3d::Zero();
    /// Sign of the gyro's axes that are at their rail, else 0.
    Eigen::Vector3d at_rail = Eigen::Vector3d::Zero();
    bool known = false;  ///< no axis met its rail in a part of it only
    bool operator==(const Reading&) const = default;
  };
  struct State {
    ImuAverage average;
    std::array<Reading, 2> before{};        ///< the last but one, the last
    int readings = 0;                       ///< in a row, two at most
    std::array<double, kSenses> run_s{};    ///< of the flight that is on, by each of the senses
    std::array<double, kSenses> flown_s{};  ///< in all
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit FlightSense(const Params& params);

  /// Takes a reading; one that is not finite or out of order is passed over. O(1), no allocation.
  void step(const ImuSample& sample, State& state) const;

  /// `out_of_range` where flights were those of another sensor.
  Status verdict(const State& state) const;

 private:
  Reading reading_of(const ImuSample& mean, double rate_peak_rad_s) const;
  void take(const Reading& now, State& state) const;

  Params params_;
};

}  // namespace tumble
