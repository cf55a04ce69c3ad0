// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/left_out.hpp"

/// imu_readings.hpp collects IMU readings from any source, one by one. Used only within scenarios/recordings.
namespace tumble::scenarios {

/// Returns the device without its readings.
sim::ImuRecord without_readings(sim::ImuRecord device);

/// Appends a reading to the record. Throws BadInput for a value that is not finite or beyond 1e6; the message starts
/// with `where`.
void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu);

/// ReadingText returns a description of a reading for messages.
using ReadingText = std::function<std::string(std::size_t reading)>;

/// Leaves out lost readings (all six values are exactly 0), and readings whose stamps are not in order
/// (stamps_in_order). `left_out` counts these readings. The period is set to the median step of the stamps in order.
/// Stamps of bursts are evened out first: readings that a driver delivers in groups are distributed over the time since
/// the previous group.
///
/// @param where     Returns the place of a reading, for messages.
/// @param disorder  Describes a stamp that is not in order; null: relative to the previous stamp.
/// @return          A note on bursts, or "". Throws BadInput if too many readings are left out as faulty, or if all are
///         0.
std::string leave_out_faulty(const ReadingText& where, const ReadingText& disorder, LeftOut& left_out,
                             sim::ImuRecord& imu);

/// Sets the period to the median step if the period is 0, and checks the readings. Throws BadInput, with a message that
/// starts with `where`, for fewer than two readings or a probably wrong unit: a median specific force outside 3 to 30
/// m/s^2, or a period outside 20 us to 2 s.
void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu);

/// Returns true if the specific force is in g instead of m/s^2, as from some lidar drivers. The median norm of the
/// specific force is then within 10 % of 1, and a fifth of the norms are within 2 % of the median (rest). Readings from
/// which gravity was removed have no constant norm.
bool is_in_g(const sim::ImuRecord& imu);

/// Restores stamps that were rounded to milliseconds (rounded_stamps.hpp), and sets the period to their mean step.
/// Returns a note on the restored stamps, or "".
std::string even_out_stamps(sim::ImuRecord& imu);

/// Returns a note on gaps longer than one second, which no estimator bridges, or "".
std::string gaps_text(const sim::ImuRecord& imu);

/// RotationWindows selects the time windows in which the gyro is compared with the rotation of gravity in the
/// accelerometer. In windows of 0.2 s, the specific force must keep the size of gravity within a tenth and rotate by
/// one to about twenty degrees. The change of the specific force is compared with the product -(rotation vector) x
/// force. `ratio` is the factor between the measured change and the product; 1 means correct units. `correlation` is
/// the correlation between the measured change and the product. Windows of kind `brisk` end early, once the force has
/// rotated by a quarter of gravity, because a rolling sphere rotates too far in 0.2 s. Cost: O(N).
enum class RotationWindows { even, brisk };
struct GravityRotation {
  int windows = 0;
  double ratio = 0.0, correlation = 0.0;
};
GravityRotation gravity_rotation(const sim::ImuRecord& imu, RotationWindows windows = RotationWindows::even);

/// Returns a note on the units that gravity indicates (in `even` windows, else in `brisk` windows), or on a gyro that
/// always reads 0. Returns "" if the motion is insufficient for the check. Throws BadInput if gravity indicates that
/// rates are in deg/s instead of rad/s or vice versa (factor 57.3). Throws BadInput also if more than 1 % of the rates
/// exceed twice the stated range (100 rad/s if no range is stated). The error message starts with `where`.
std::string require_plausible_rates(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

/// Returns the note on units for a format that does not state the unit. If the motion is insufficient, the note says
/// so.
std::string rates_text(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

inline constexpr double kTeslaPerMicrotesla = 1e-6;

/// Returns the factor from the unit to m/s^2 or rad/s.
double scale_of(AccelUnit unit);
double scale_of(GyroUnit unit);

}  // namespace tumble::scenarios
