// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/estimator/mapping/synthetic_room.hpp"
#include "tests/testing.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::test {

/// EndlessCorridor is a straight drive along an endless corridor, with a rib across its floor every few metres: rest
/// for half a second, a second of acceleration, then 1 m/s. The sensor data are generated sweep by sweep, so that a
/// drive of any length needs no memory.
class EndlessCorridor {
 public:
  /// `sweep_ns` is the duration of a sweep, in whole tenths of a second.
  explicit EndlessCorridor(int points_per_sweep, std::int64_t sweep_ns = kSweep_ns)
      : points_per_sweep_(points_per_sweep), sweep_ns_(sweep_ns) {}

  /// Returns the samples of the next sweep (100 Hz); then points() are those of this sweep.
  std::vector<ImuSample> advance();
  std::vector<LidarPoint> points() const;

  std::int64_t start_ns() const { return (sweep_ - 1) * sweep_ns_; }
  std::int64_t end_ns() const { return sweep_ * sweep_ns_; }
  double x_m() const { return x_m_; }  ///< position at the end of the sweep

 private:
  int points_per_sweep_;
  std::int64_t sweep_ns_;
  std::int64_t sweep_ = 0;  // number of the current sweep, from 1
  double start_m_ = 0.0, start_m_s_ = 0.0, a_m_s2_ = 0.0;
  double x_m_ = 0.0, v_m_s_ = 0.0;
};

/// Returns parameters for the corridor: the reach of lidar and map is short, so that the map is soon left behind.
LidarInertialOdometry::Params corridor_params();

}  // namespace tumble::test
