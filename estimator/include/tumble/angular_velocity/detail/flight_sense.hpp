// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>

#include "tumble/common/detail/imu_average.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Whether the accelerometer has the sense that it says, all three axes at once, and the gyro its scale. Forces of a
/// mirrored world show neither in gravity at rest nor in its turning.
///
/// In free flight the force at the lever arm t from the centre of mass is a x t + w x (w x t) and nothing else.
/// Readings that are this within `share`, its negative, or what a gyro that reads half makes of it (2 a, 2 w) for
/// `run_s` at a time are flight by the one reading or the other; on the ground none lasts. Only readings of gyros that
/// are not at their rail count. Not seen: a body that never flies and spins, whose IMU sits at its centre of mass, or
/// whose gyro clips throughout its flights. A lever arm of the other sense looks the same.
class FlightSense {
 public:
  struct Params {
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Zero();  ///< from the centre of mass to the IMU, IMU axes
    double gyro_range_rad_s = 0.0;                          ///< as the device states it; 0: not stated
    double reading_s = 0.01;                                ///< readings are averaged to this length
    double force_min_m_s2 = 2.5;                            ///< that turning makes, to count
    double share = 0.25;                                    ///< of it, by which the reading may differ
    double run_s = 0.02;                                    ///< and for how long at least
    double against_s = 0.1;                                 ///< of flight of the other sense, from which on it is told,
    double halved_s = 0.3;      ///< of flight by twice the rate, likewise (a hand may make 0.15 s)
    double against_with = 4.0;  ///< and so many times what there is of the right one
    double gap_max_s = 0.1;     ///< after a longer one it begins anew

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.lever_arm_m, {"lever_arm_m", "m", -1e3, 1e3, "from the centre of mass to the IMU, IMU axes"});
      visit(p.gyro_range_rad_s,
            {"gyro_range_rad_s", "rad/s", 0.0, kUnbounded, "as the device states it; 0: not stated"});
      visit(p.reading_s, {"reading_s", "s", 1e-3, 1.0, "readings are averaged to this length"});
      visit(p.force_min_m_s2, {"force_min_m_s2", "m/s^2", 1e-3, 1e6, "that turning makes at the lever arm, to count"});
      visit(p.share, {"share", "1", 1e-3, 0.9, "of that force, by which a reading may differ from it in flight"});
      visit(p.run_s, {"run_s", "s", 0.0, 10.0, "shortest flight that counts"});
      visit(p.against_s, {"against_s", "s", 0.0, 1e3, "of flight of the other sense, from which on it is told"});
      visit(p.halved_s, {"halved_s", "s", 0.0, 1e3, "of flight by twice the rate, from which on it is told"});
      visit(p.against_with, {"against_with", "1", 0.0, 1e6, "times that of the right sense, by which it is longer"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-3, 1e3, "after a longer gap a flight begins anew"});
    }
  };
  /// One mean reading.
  struct Reading {
    TimeNs time_ns = 0;
    Eigen::Vector3d rate_rad_s = Eigen::Vector3d::Zero(), force_m_s2 = Eigen::Vector3d::Zero();
    bool free = false;  ///< the gyro was not at its rail
    bool operator==(const Reading&) const = default;
  };
  struct State {
    ImuAverage average;
    std::array<Reading, 2> before{};  ///< the last but one, the last
    int readings = 0;                 ///< in a row, two at most
    /// Of the flight that is on, as everything says, by forces of the other sense, by twice the rate.
    std::array<double, 3> run_s{};
    std::array<double, 3> flown_s{};  ///< in all
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit FlightSense(const Params& params);

  /// Takes a reading; one that is not finite or out of order is passed over. O(1), no allocation.
  void step(const ImuSample& sample, State& state) const;

  /// `out_of_range` where flights were of the other sense, or by twice the rate.
  Status verdict(const State& state) const;

 private:
  void take(const Reading& now, State& state) const;

  Params params_;
};

}  // namespace tumble
