// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/recordings/import.hpp"

/// Readings of an IMU that come one by one, whatever brings them. Private to scenarios/recordings.
namespace tumble::scenarios {

/// The device without readings of some other recording.
sim::ImuRecord without_readings(sim::ImuRecord device);

/// Appends a reading. Throws BadInput beginning with `where`: not finite, a stamp that does not rise.
void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu);

/// Fills the period, the median step. Throws BadInput beginning with `where`: fewer than two readings, a median
/// specific force outside 3 to 30 m/s^2, which says that the unit is another one.
void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu);

/// m/s^2 of one unit.
double scale_of(AccelUnit unit);

}  // namespace tumble::scenarios
