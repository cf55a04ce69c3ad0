// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/recordings/recording_file.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// A recording from elsewhere, ready for write_recording.
struct Imported {
  RecordingInfo info;  ///< without scenario; `attribution` says where it comes from
  sim::Sensors sensors;
  std::optional<sim::Truth> reference;  ///< what another instrument saw of the motion: FORMAT.md, "References"
};

/// Unit of the accelerometer columns of a CSV; g is 9.80665 m/s^2.
enum class AccelUnit { m_s2, g };

/// Reads the readings of one IMU from CSV: one header line, then a line per message of sensor_msgs/Imu. Columns are
/// found by name when the header holds ".../header/stamp" (seconds, read to the nanosecond), ".../angular_velocity/x"
/// and
/// ".../linear_acceleration/x", y and z, as tools that flatten ROS messages write them; else by place (from 0): 0 stamp
/// s, 1 stamp ns, 8-10 rate rad/s, 12-14 specific force. `device` gives what the file does not state: name, device,
/// ranges, noise, T_BI; its period and readings are replaced. Times are counted from the first stamp; the period is the
/// median step. Throws BadInput with file and line: too few or differing columns, not a number, not finite, a stamp
/// that does not rise; fewer than two samples; a median specific force outside 3 to 30 m/s^2, which says that the unit
/// is another one. Does not judge the unit of the rates: degrees pass.
Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device,
                        AccelUnit unit = AccelUnit::m_s2);

/// Reads a trial of BROAD (Laidig et al., Data 2021, 6(7), 72) from its HDF5 file: imu_gyr, imu_acc, imu_mag (to tesla)
/// and sampling_rate; opt_quat and opt_pos, when both are there, as the reference, unknown where the cameras saw too
/// little, with rates and velocities from its differences over 140 ms (which tell rest from motion and blur fast
/// turns). Sample k stands at k / sampling_rate. Ranges and noise are not stated by the file and left 0. Throws
/// BadInput.
Imported import_broad(const std::filesystem::path& path);

}  // namespace tumble::scenarios
