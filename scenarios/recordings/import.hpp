// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "scenarios/recordings/recording_file.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// A recording from elsewhere, ready for write_recording.
struct Imported {
  RecordingInfo info;  ///< without scenario; `attribution` says where it comes from
  sim::Sensors sensors;
};

/// Reads the readings of one IMU from CSV: one header line, then a line per message of sensor_msgs/Imu; used are the
/// columns (from 0) 0 stamp s, 1 stamp ns, 8-10 rate rad/s, 12-14 specific force m/s^2. `device` gives what the file
/// does not state: name, device, ranges, noise, T_BI; its period and readings are replaced. Times are counted from the
/// first stamp; the period is the median step. Throws BadInput with file and line: too few or differing columns, not a
/// number, not finite, a stamp that does not rise; fewer than two samples. Does not judge units: an accelerometer in g
/// passes.
Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device);

/// Reads a trial of BROAD (Laidig et al., Data 2021, 6(7), 72): imu_gyr, imu_acc, sampling_rate of its HDF5 files.
/// Sample k stands at k / sampling_rate. Ranges and noise are not stated by the file and left 0. Magnetometer and
/// optical reference are not read. Throws BadInput.
Imported import_broad(const std::filesystem::path& path);

}  // namespace tumble::scenarios
