// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <string>

#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/left_out.hpp"

namespace tumble::scenarios {

sim::ImuRecord without_readings(sim::ImuRecord device);

void add_reading(const std::string& where, std::int64_t stamp_ns, const Eigen::Vector3d& rate_rad_s,
                 const Eigen::Vector3d& force_m_s2, sim::ImuRecord& imu);

using ReadingText = std::function<std::string(std::size_t reading)>;

/// Removes lost readings (all six values are exactly 0), and readings whose time stamps are out of order
/// (stamps_in_order). The sample period becomes the median time step. If a driver delivers readings in bursts, the time
/// stamps of a burst are first distributed evenly over the time since the previous burst.
///
/// @param disorder Function that returns the error message for a time stamp that is out of order; null: default
///     message.
/// @return A remark for the user if the driver delivered bursts of readings, otherwise an empty text.
std::string leave_out_faulty(const ReadingText& where, const ReadingText& disorder, LeftOut& left_out,
                             sim::ImuRecord& imu);

/// Checks imported IMU readings, and sets an unknown sample period to the median time step. Throws BadInput for fewer
/// than two IMU samples, a median specific force outside 3 to 30 m/s^2, or a sample period outside 20 us to 2 s.
void finish_readings(const std::string& where, AccelUnit unit, sim::ImuRecord& imu);

/// Returns true if the accelerometer readings are probably in g instead of m/s^2. The median norm of the readings must
/// be 0.9 to 1.1, and a fifth of the norms must be 0.98 to 1.02.
bool is_in_g(const sim::ImuRecord& imu);

std::string even_out_stamps(sim::ImuRecord& imu);

std::string gaps_text(const sim::ImuRecord& imu);

/// RotationWindows selects the time windows in which the rotation of the measured gravity is compared with the gyro.
/// RotationWindows::even selects windows of 0.2 s. RotationWindows::brisk ends a window before 0.2 s if the specific
/// force has changed by a quarter of gravity. A window is used if the norm of its specific force differs from gravity
/// by at most 10 %, and if the specific force changes by 2 to 40 % of gravity. The value `ratio` is the measured change
/// of the specific force divided by the predicted change, -(rotation vector) x force, by least squares. For correct
/// units, `ratio` is 1.
enum class RotationWindows { even, brisk };
struct GravityRotation {
  int windows = 0;
  double ratio = 0.0, correlation = 0.0;
};
GravityRotation gravity_rotation(const sim::ImuRecord& imu, RotationWindows windows = RotationWindows::even);

/// Compares the rotation of the measured gravity with the gyro. Returns a note on the unit of the rates, or on a gyro
/// that always reads 0; the note is empty if the motion is insufficient. Throws BadInput if gravity indicates deg/s
/// instead of rad/s or vice versa. Also throws BadInput if more than 1 % of the rates exceed twice the range of the IMU
/// (100 rad/s if unknown).
std::string require_plausible_rates(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

std::string rates_text(const std::string& where, const sim::ImuRecord& imu, GyroUnit unit);

double scale_of(AccelUnit unit);
double scale_of(GyroUnit unit);

}  // namespace tumble::scenarios
