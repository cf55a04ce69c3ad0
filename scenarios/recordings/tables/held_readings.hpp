// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// Removes sample-and-hold: a log that is faster than its sensor repeats readings. Private to scenarios/recordings.
namespace tumble::scenarios {

/// Rows of a log with the latest reading of each sensor.
struct LoggedReadings {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3d> gyro_rad_s, accel_m_s2;
};

/// Result for a note; shares are fractions of the rows.
struct HoldReport {
  double gyro_repeated = 0.0, accel_repeated = 0.0;
  bool gyro_held = false, accel_held = false;
  std::size_t rows = 0, readings = 0, accel_readings = 0;
  std::string text() const;
};

/// Extracts the readings of a log without repetitions. A sensor is held if more than 5 % and fewer than 98 % (then it
/// is frozen) of its rows repeat all three axes. Only new gyro readings are kept; their times are regularised within
/// the log step in which they came. An accelerometer that holds longer than the gyro is interpolated linearly at the
/// gyro's times, which low-passes it. Fills time_ns, gyro, accelerometer and clip_flags (0) of `imu`. O(N).
HoldReport undo_hold(const LoggedReadings& log, sim::ImuRecord& imu);

/// Returns a note on probable accelerometer saturation, or "". An axis and sign counts if its readings accumulate
/// beyond 1.5 g at their extreme: at least five within 2 % (a tilted limit), and three times as many as between 2 and 4
/// % below. Repeated readings count once.
std::string accel_rail_text(const std::vector<Eigen::Vector3d>& logged);

}  // namespace tumble::scenarios
