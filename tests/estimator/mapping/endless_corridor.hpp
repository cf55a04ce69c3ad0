// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <vector>

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::test {

/// A straight drive along a corridor without end, with a rib across its floor every few metres: rest for half a second,
/// then a second of acceleration, then 1 m/s. Sensor data sweep by sweep, so that a drive of any length needs no
/// memory.
class EndlessCorridor {
 public:
  /// `sweep_ns`: how long a sweep takes, tenths of a second.
  explicit EndlessCorridor(int points_per_sweep, std::int64_t sweep_ns = kSweep_ns)
      : points_per_sweep_(points_per_sweep), sweep_ns_(sweep_ns) {}

  /// Samples of the next sweep (100 Hz); then points() are those of that sweep.
  std::vector<ImuSample> advance();
  std::vector<LidarPoint> points() const;

  std::int64_t start_ns() const { return (sweep_ - 1) * sweep_ns_; }
  std::int64_t end_ns() const { return sweep_ * sweep_ns_; }
  double x_m() const { return x_m_; }  ///< at the end of the sweep

 private:
  int points_per_sweep_;
  std::int64_t sweep_ns_;
  std::int64_t sweep_ = 0;  // the present one, from 1
  double start_m_ = 0.0, start_m_s_ = 0.0, a_m_s2_ = 0.0;
  double x_m_ = 0.0, v_m_s_ = 0.0;
};

/// For a drive along it: the lidar's and the map's reach are short, so that the map is left behind soon.
LidarInertialOdometry::Params corridor_params();

}  // namespace tumble::test
