// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// remove_repeats removes repeated readings, which occur if a log is faster than its sensor (sample and hold).
namespace tumble::scenarios {

/// LoggedReadings contains the rows of a log; each row contains the latest reading of each sensor.
struct LoggedReadings {
  std::vector<std::int64_t> time_ns;
  std::vector<Eigen::Vector3d> gyro_rad_s, accel_m_s2;
};

/// RepeatReport contains the fractions of rows with repeated readings, for a note.
struct RepeatReport {
  double gyro_repeated = 0.0, accel_repeated = 0.0;
  bool gyro_repeats = false, accel_repeats = false;
  std::size_t rows = 0, readings = 0, accel_readings = 0;
  std::string text() const;
};

/// Converts a log to IMU samples, without repeated readings. A sensor repeats its readings if 5 to 98 % of its rows
/// equal the previous row in all three axes; with more, it counts as frozen. Only rows with a new gyro reading are
/// kept. The times of the kept readings become regular, within the log step in which each reading arrived. If the
/// accelerometer is slower than the gyro, its readings are interpolated linearly at the gyro's times, which acts as a
/// low-pass filter. Sets time_ns, gyro, accelerometer and clip_flags (0) of `imu`. The cost is O(N).
RepeatReport remove_repeats(const LoggedReadings& log, sim::ImuRecord& imu);

/// Describes a probable saturation of the accelerometer; empty if there is none. An axis is saturated in one direction
/// if readings accumulate at an extreme beyond 1.5 g. At least five readings must be within 2 % of the extreme (a
/// tilted limit), and three times as many as from 2 to 4 %. Each repeated reading counts once.
std::string accel_rail_text(const std::vector<Eigen::Vector3d>& logged);

}  // namespace tumble::scenarios
