// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// repeated_readings.hpp removes sample-and-hold repetitions, which occur if a log is faster than its sensor. Used only
/// within scenarios/recordings.
namespace tumble::scenarios {

/// LoggedReadings contains the rows of a log. Each row has the latest reading of each sensor.
struct LoggedReadings {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3d> gyro_rad_s, accel_m_s2;
};

/// RepeatReport is the result of remove_repeats for a note. Each number is a fraction of the rows.
struct RepeatReport {
  double gyro_repeated = 0.0, accel_repeated = 0.0;
  bool gyro_repeats = false, accel_repeats = false;
  std::size_t rows = 0, readings = 0, accel_readings = 0;
  std::string text() const;
};

/// Extracts the readings of a log without repetitions. A sensor repeats readings (sample-and-hold) if 5 to 98 % of its
/// rows repeat all three axes. A sensor whose rows repeat more often counts as frozen. The function keeps only new gyro
/// readings. The times of the readings are regularised within the log step in which they arrived. If the accelerometer
/// repeats readings for longer than the gyro, its readings are interpolated linearly at the gyro's times, which
/// low-passes the specific force. The function fills in time_ns, gyro, accelerometer and clip_flags (0) of `imu`. O(N).
RepeatReport remove_repeats(const LoggedReadings& log, sim::ImuRecord& imu);

/// Returns a note on probable accelerometer saturation, or "". An axis and sign counts as saturated if readings
/// accumulate at an extreme beyond 1.5 g. At least five readings must be within 2 % of the extreme (a tilted limit),
/// and three times as many as between 2 and 4 % below the extreme. Repeated readings count once.
std::string accel_rail_text(const std::vector<Eigen::Vector3d>& logged);

}  // namespace tumble::scenarios
