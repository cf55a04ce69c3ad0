// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "scenarios/recordings/import.hpp"

/// Readings of an IMU that come one by one, whatever brings them. Private to scenarios/recordings.
namespace tumble::scenarios {

/// The device without readings of some other recording.
sim::ImuRecord without_readings(sim::ImuRecord device);

/// Appends a reading. Throws BadInput beginning with `where`: not finite or beyond 1e6, a stamp that
/// does not rise.
void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu);

/// Fills the period, the median step. Throws BadInput beginning with `where`: fewer than two readings, a median
/// specific force outside 3 to 30 m/s^2 or a period outside 20 us to 2 s, which says that the unit is another one.
void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu);

/// Whether readings that were taken for m/s^2 are in g by their own size, as the drivers of some lidars give them: the
/// median within a tenth of 1, and a fifth of them within 2 % of it, at rest. What gravity was taken out of has no size
/// that it keeps to.
bool is_in_g(const sim::ImuRecord& imu);

/// Puts stamps in whole milliseconds of a faster IMU on its beat (rounded_stamps.hpp), whose mean step becomes the
/// period, and says so; else nothing.
std::string even_out_stamps(sim::ImuRecord& imu);

/// Where and for how long an IMU was silent, of gaps beyond a second, which no estimator bridges; else nothing.
std::string gaps_text(const sim::ImuRecord& imu);

/// How gravity turns in the accelerometer against what the gyro says: over windows of 0.2 s in which the specific force
/// keeps the size of gravity within a tenth and turns by one to some twenty degrees, the change of the force is held
/// against
/// -(angle turned) x force. `ratio`: the factor between them, 1 when the units agree; `correlation`: of the two.
/// Brisk windows end before, once the force has turned by a quarter of gravity: within 0.2 s a sphere that rolls turns
/// too far. O(N).
enum class RotationWindows { even, brisk };
struct GravityRotation {
  int windows = 0;
  double ratio = 0.0, correlation = 0.0;
};
GravityRotation gravity_rotation(const sim::ImuRecord& imu, RotationWindows windows = RotationWindows::even);

/// A remark on the units that gravity shows, in even windows or else in brisk ones, or on a gyro that reads nothing but
/// 0, or none where the motion does not tell. Throws BadInput beginning with `where` when the rates are in the other
/// unit by it (a factor of 57.3), or when more than 1 % of them lie beyond twice the stated range (100 rad/s where none
/// is stated).
std::string require_plausible_rates(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

/// The same of readings whose format does not state what they are: where the motion does not tell, that is the remark.
std::string rates_text(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

/// What magnetometers are read in.
inline constexpr double kTeslaPerMicrotesla = 1e-6;

/// m/s^2 and rad/s of one unit.
double scale_of(AccelUnit unit);
double scale_of(GyroUnit unit);

}  // namespace tumble::scenarios
