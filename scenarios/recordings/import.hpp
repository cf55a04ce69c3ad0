// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/clouds/sweep_builder.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

/// A recording from elsewhere, ready for write_recording.
struct Imported {
  RecordingInfo info;  ///< without scenario; `attribution` says where it comes from, `origin_ns` what time 0 is
  sim::Sensors sensors;
  std::optional<sim::Truth> reference;  ///< what another instrument saw of the motion: FORMAT.md, "References"
  std::vector<std::string> notes;       ///< remarks for the user: what was left out or assumed
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

/// Where the sweeps of one lidar lie.
struct SweepSource {
  std::filesystem::path folder;
  std::string format;           ///< "ply", "pcd" or "kitti" (.bin)
  std::string stem;             ///< of the files' names, before the number: "lidar"; "": all files must have the same
  std::filesystem::path times;  ///< a stamp per sweep; "": STEM_times.txt or times.txt in the folder, if it is there
  std::int64_t steady_ns = 0;   ///< sweeps follow each other by this, where nothing tells their times; 0: refused
  SweepReading reading;
};

/// Reads the sweeps of a lidar, a file each, in natural order of their names (sweep_stamps.hpp, cloud_file.hpp,
/// sweep_builder.hpp). The stamp of a sweep is taken from `times`, else from the names, else from the absolute times of
/// its points, else from `steady_ns`. Time 0 is the first sweep's start, or the clock's own zero when that is less than
/// a second before. Throws BadInput with the file: what those say; another number of stamps than of files, files of
/// several lidars, sweeps without times.
Imported import_sweeps(const SweepSource& source);

/// A pose file of somebody else.
struct ReferenceSource {
  std::filesystem::path file;
  std::string format;           ///< "tum" or "kitti"
  bool of_body = false;         ///< poses of the body; else of the first lidar, by its T_BL
  bool sorted = false;          ///< lines may be in any order: read_tum_poses
  std::filesystem::path times;  ///< of a KITTI file without sweeps
  std::int64_t steady_ns = 0;   ///< the same: poses follow each other by this
};

/// Reads a pose file as a recording without sensors: its truth is all that it holds, the body being what the poses are
/// of. Time 0 as above. Throws BadInput.
Imported import_trajectory(const ReferenceSource& source);

/// Makes the poses the truth of `recording`, in the clock of its source (`origin_ns`); a KITTI file has a pose per
/// sweep. The truth ends with the sensors. Throws BadInput: what the reader says, no lidar for poses of one, no
/// overlap.
void attach_reference(Imported& recording, const ReferenceSource& source);

/// Puts the IMUs of `imu`, in the same clock, beside the sensors of `recording`; the earlier time 0 holds. Throws
/// BadInput when their times do not overlap.
void attach_imus(Imported& recording, Imported imu);

/// Reads a trial of BROAD (Laidig et al., Data 2021, 6(7), 72) from its HDF5 file: imu_gyr, imu_acc, imu_mag (to tesla)
/// and sampling_rate; opt_quat and opt_pos, when both are there, as the reference, unknown where the cameras saw too
/// little, with rates and velocities from its differences over 140 ms (which tell rest from motion and blur fast
/// turns). Sample k stands at k / sampling_rate. Ranges and noise are not stated by the file and left 0. Throws
/// BadInput.
Imported import_broad(const std::filesystem::path& path);

}  // namespace tumble::scenarios
