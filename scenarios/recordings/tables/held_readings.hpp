// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// Sample and hold: a log that is faster than its sensor repeats readings. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Rows of a log, each with what the sensors last said.
struct LoggedReadings {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3d> gyro_rad_s, accel_m_s2;
};

/// What was found and done, for a remark; shares are of the rows.
struct HoldReport {
  double gyro_repeated = 0.0, accel_repeated = 0.0;
  bool gyro_held = false, accel_held = false;
  std::size_t rows = 0, readings = 0, accel_readings = 0;
  std::string text() const;
};

/// The readings of a log without its repetitions. A sensor is held when more than a twentieth of its rows repeat all
/// three axes of the one before, and fewer than 98 % (which is frozen). Then the gyro's own readings alone are kept and
/// put on a steady beat within the step of the log in which they came; an accelerometer that holds longer than the gyro
/// is interpolated linearly between its own readings at the gyro's instants, which low-passes it: its own rate bounds
/// what it can tell. Fills time_ns, gyro, accelerometer and clip_flags (0) of `imu`. O(N).
HoldReport undo_hold(const LoggedReadings& log, sim::ImuRecord& imu);

/// A remark on logged readings, repetitions counted once, for each axis and sign of the accelerometer whose readings
/// gather at their extreme: at least five within two percent of it (a rail is tilted) and three times as many as
/// between two and four percent below, beyond 1.5 g; "" when none does.
std::string accel_rail_text(const std::vector<Eigen::Vector3d>& logged);

}  // namespace tumble::scenarios
