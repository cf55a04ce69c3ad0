// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/left_out.hpp"

/// imu_readings.hpp collects and checks the IMU readings of an import, from any source.
namespace tumble::scenarios {

/// Returns the IMU record without its readings.
sim::ImuRecord without_readings(sim::ImuRecord device);

/// Appends one reading to the record `imu`. If a value is not finite or exceeds 1e6, throws BadInput with a message
/// that starts with `where`.
void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu);

/// ReadingText returns a description of a reading for messages.
using ReadingText = std::function<std::string(std::size_t reading)>;

/// Removes lost readings (all six values are exactly 0), and readings whose time stamps are out of order
/// (stamps_in_order); `left_out` counts them. Sets the period to the median step of the time stamps in order. If a
/// driver delivered readings in bursts, their time stamps are first distributed over the time since the previous burst.
///
/// @param where     Returns the location of a reading, for messages.
/// @param disorder  Describes a time stamp that is out of order; null: relative to the previous time stamp.
/// @return          A note on bursts; may be empty. Throws BadInput if too many readings are faulty or all are 0.
std::string leave_out_faulty(const ReadingText& where, const ReadingText& disorder, LeftOut& left_out,
                             sim::ImuRecord& imu);

/// Sets a period of 0 to the median step, and checks the readings. Throws BadInput, with a message that starts with
/// `where`, for fewer than two readings or a probably wrong unit. The median specific force must be 3 to 30 m/s^2, and
/// the period must be 20 us to 2 s.
void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu);

/// Returns true if the specific force is in g instead of m/s^2, as from some lidar drivers. In g, the median norm is
/// within 10 % of 1, and a fifth of the norms are within 2 % of the median (rest). Readings without gravity have no
/// constant norm.
bool is_in_g(const sim::ImuRecord& imu);

/// Restores time stamps that were rounded to milliseconds (rounded_stamps.hpp), and sets the period to their mean step.
/// Returns a note; empty if no time stamp was rounded.
std::string even_out_stamps(sim::ImuRecord& imu);

/// Describes gaps longer than one second, which no estimator bridges; empty without such a gap.
std::string gaps_text(const sim::ImuRecord& imu);

/// RotationWindows selects the time windows in which the rotation of the measured gravity is compared with the gyro. In
/// a window of 0.2 s (`even`), the specific force must have the size of gravity within a tenth, and rotate by one to
/// about twenty degrees. The change of the force is compared with the product -(rotation vector) x force: `ratio` is
/// the factor between both (1 means correct units), and `correlation` is their correlation. A rolling sphere rotates
/// too far in 0.2 s, so windows of kind `brisk` end when the force has rotated by a quarter of gravity. The cost is
/// O(N).
enum class RotationWindows { even, brisk };
struct GravityRotation {
  int windows = 0;
  double ratio = 0.0, correlation = 0.0;
};
GravityRotation gravity_rotation(const sim::ImuRecord& imu, RotationWindows windows = RotationWindows::even);

/// Checks the unit of the rates against the rotation of gravity. Returns a note on the result, or on a gyro that always
/// reads 0; empty if the motion is insufficient. Throws BadInput if gravity indicates deg/s instead of rad/s or vice
/// versa (factor 57.3). Throws BadInput if more than 1 % of the rates exceed twice the range of the IMU (100 rad/s if
/// unknown). The message starts with `where`.
std::string require_plausible_rates(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

/// Returns a note on the unit of the rates, for a format without a specified unit. The note also states if the motion
/// is insufficient for a check.
std::string rates_text(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

/// Returns the factor that converts the unit to m/s^2 or rad/s.
double scale_of(AccelUnit unit);
double scale_of(GyroUnit unit);

}  // namespace tumble::scenarios
