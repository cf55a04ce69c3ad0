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
  std::vector<PointStore> points;       ///< of each lidar, when they were set aside (SweepReading::scratch); else empty
  std::optional<sim::Truth> reference;  ///< what another instrument saw of the motion: FORMAT.md, "References"
  std::vector<std::string> notes;       ///< remarks for the user: what was left out or assumed
};

/// Unit of the accelerometer columns of a CSV; g is 9.80665 m/s^2.
enum class AccelUnit { m_s2, g };
enum class GyroUnit { rad_s, deg_s };

/// Reads the readings of one IMU from a table of text, separated by what the first line has most of: comma, semicolon
/// or tabulator. A header's names are believed before places: those of export_csv (each once and no other), short forms
/// of them (sec nsec wx.. fx.. or ax..), ".../header/stamp" (seconds, read to the nanosecond), ".../angular_velocity/x"
/// and
/// ".../linear_acceleration/x", y and z, as tools that flatten ROS messages write them, or those of loggers and data
/// sets ("time,gyro_x,...,accel_x,...", "#timestamp [ns],w_RS_S_x [rad s^-1],...": tables/logger_columns.hpp), whose
/// units are believed where they are stated; the unit of times that state none follows from their steps, and is said. A
/// first line of numbers is a sample, and columns stand by place (from 0): 0 stamp s, 1 stamp ns, 8-10 rate, 12-14
/// specific force. `device` gives what the file does not state: name, device, ranges, noise, T_BI; its period and
/// readings are replaced. Times are counted from the first stamp; the period is the median step; stamps in whole
/// milliseconds of a faster beat are put on it, and said (rounded_stamps.hpp). Units are held against gravity: its
/// size, and how it turns (a note says so where the motion tells). Throws BadInput with file and line: unknown, doubled
/// or missing columns, a unit other than the one asked for, differing numbers of columns, not a number, not finite, a
/// stamp that does not rise, a last line without its end; fewer than two samples; a median specific force outside 3 to
/// 30 m/s^2, a period outside 20 us to 2 s, more than 1 % of the rates beyond twice the device's range (100 rad/s where
/// none is stated), or gravity that turns 57 times too fast or too slow for the rates.
Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device,
                        AccelUnit unit = AccelUnit::m_s2, GyroUnit gyro_unit = GyroUnit::rad_s);

/// Where the sweeps of one lidar lie.
struct SweepSource {
  std::filesystem::path folder;
  std::string format;           ///< "ply", "pcd", "vtk" or "kitti" (.bin)
  std::string stem;             ///< of the files' names, before the number: "lidar"; "": all files must have the same
  std::filesystem::path times;  ///< a stamp per sweep; "": STEM_times.txt or times.txt in the folder, if it is there
  std::int64_t steady_ns = 0;   ///< sweeps follow each other by this, where nothing tells their times; 0: refused
  std::string bin_columns;      ///< of .bin files: read_cloud
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
  std::string format;           ///< "tum", "kitti" or "odometry"
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
/// turns), and with rates at the IMU's samples over 40 ms (reference_rate.hpp). Sample k stands at k / sampling_rate.
/// Ranges and noise are not stated by the file and left 0. Throws BadInput.
Imported import_broad(const std::filesystem::path& path);

/// A recording of RepoIMU (Szczesna et al., ICCVG 2016) as it is published: columns separated by ';', two header lines
/// (a group's name, then the column's), time s, "Vicon Orientation" W X Y Z, "IMU Acceleration" m/s^2, "IMU Gyroscope"
/// rad/s, "IMU Magnetometer" (of no unit, left out). What is recognised is undone and said in the notes:
///
/// - stamps printed more coarsely than they step are put on a steady beat within their rounding (steady_stamps.hpp);
/// - sample and hold: repeated readings are left out, the rest put on the gyro's own beat, an accelerometer that holds
///   longer interpolated between its own readings (held_readings.hpp);
/// - glitches of the optical reference are left out (reference_glitches.hpp);
/// - the delay, the rotation and the tilt between reference and IMU are estimated (align_reference.hpp) and, when
///   `align` is set, taken out, so that the truth is the IMU's attitude in a world whose z is up.
///
/// The truth's rates at the IMU's stamps are derived from the attitudes (reference_rate.hpp); it knows no position.
/// Throws BadInput with file, line, value and bound: unknown, missing or doubled columns, a number that is none, IMU
/// readings that are not finite, a stamp that does not rise, more than a fifth of the quaternions off unit length by
/// more than a percent, a last line without its end.
Imported import_repoimu(const std::filesystem::path& path, bool align);

/// Whether the file begins as a recording of RepoIMU does.
bool is_repoimu(const std::filesystem::path& path);

/// A flight log of AirbrakesV2 (NCSU High-Powered Rocketry Club, MIT): columns by name, timestamp_seconds,
/// raw_acceleration_{x,y,z}_gs, raw_angular_rate_{x,y,z}_deg_per_s, magnetic_field_{x,y,z}_microteslas if there; others
/// are left alone. There is no reference: what its own filter estimated is no truth. Rows that repeat a stamp are left
/// out and counted; of segments more than a second apart the longest is kept, and said. Throws BadInput as above.
Imported import_airbrakes(const std::filesystem::path& path);

/// Whether the file's header is one of AirbrakesV2.
bool is_airbrakes(const std::filesystem::path& path);

}  // namespace tumble::scenarios
