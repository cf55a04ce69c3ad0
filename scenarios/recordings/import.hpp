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

/// An imported recording, ready for write_recording.
struct Imported {
  RecordingInfo info;  ///< without scenario; `attribution` states the source, `origin_ns` the stamp of time 0
  sim::Sensors sensors;
  std::vector<PointStore> points;       ///< points of each lidar if stored on disk (SweepReading::scratch), else empty
  std::optional<sim::Truth> reference;  ///< motion measured by a reference instrument: FORMAT.md, "References"
  std::vector<std::string> notes;       ///< remarks for the user about omissions and assumptions
};

/// Unit of the accelerometer columns of a CSV; g is 9.80665 m/s^2.
enum class AccelUnit { m_s2, g };
enum class GyroUnit { rad_s, deg_s };

/// Reads the readings of one IMU from a text table. The separator is the most frequent of comma, semicolon and tab in
/// the first line.
///
/// Columns are identified by the names in the header:
/// - the names of export_csv (each once, no others);
/// - their short forms (sec nsec wx.. fx.. or ax..);
/// - flattened ROS messages: ".../header/stamp" (seconds), ".../angular_velocity/x", ".../linear_acceleration/x", and y
///   and z;
/// - names of loggers and data sets (tables/logger_columns.hpp): "time,gyro_x,...,accel_x,...", "#timestamp
///   [ns],w_RS_S_x [rad s^-1],...".
///
/// Units in names are used. If the unit of times is not stated, it is inferred from their steps and noted. If the first
/// line has numbers, it is a sample, and columns count by position (from 0): 0 stamp s, 1 stamp ns, 8-10 rate, 12-14
/// specific force.
///
/// `device` supplies what the file lacks: name, device, ranges, noise, T_BI; its period and readings are replaced.
/// Times count from the first stamp; the period is the median step. Stamps of a faster IMU in whole milliseconds are
/// resampled to its rate and noted (rounded_stamps.hpp). Units are checked against the size and rotation of gravity,
/// with a note if the motion allows it.
///
/// Throws BadInput with file and line for unknown, repeated or missing columns, an unexpected unit, or differing
/// numbers of columns. The same holds for an invalid or non-finite number, a stamp that does not increase, and a
/// truncated last line.
/// Throws BadInput for fewer than two samples, a median specific force outside 3 to 30 m/s^2, or a period outside 20 us
/// to 2 s. Also throws if more than 1 % of the rates exceed twice the device's range (100 rad/s if not stated).
/// Finally, throws if gravity rotates 57 times too fast or slow for the rates.
Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device,
                        AccelUnit unit = AccelUnit::m_s2, GyroUnit gyro_unit = GyroUnit::rad_s);

/// Files with the sweeps of one lidar.
struct SweepSource {
  std::filesystem::path folder;
  std::string format;           ///< "ply", "pcd", "vtk" or "kitti" (.bin)
  std::string stem;             ///< file name before the number: "lidar"; "": must be equal for all files
  std::filesystem::path times;  ///< file with a stamp per sweep; "": STEM_times.txt or times.txt in the folder, if
                                ///< present
  std::int64_t steady_ns = 0;   ///< sweep period if no times are available; 0: throws then
  std::string bin_columns;      ///< columns of .bin files: see read_cloud
  SweepReading reading;
};

/// Reads the sweeps of a lidar, one file each, in natural order of their names (sweep_stamps.hpp, cloud_file.hpp,
/// sweep_builder.hpp). The stamp of a sweep comes from `times`, else from file names, else from absolute point times,
/// else from `steady_ns`. Time 0 is the start of the first sweep, or the clock's zero if that is less than a second
/// earlier. Throws BadInput with the file: errors of those readers, a different number of stamps and files, files of
/// several lidars, sweeps without times.
Imported import_sweeps(const SweepSource& source);

/// A pose file of another program.
struct ReferenceSource {
  std::filesystem::path file;
  std::string format;           ///< "tum", "kitti" or "odometry"
  bool of_body = false;         ///< poses of the body; else of the first lidar, converted with its T_BL
  bool sorted = false;          ///< lines may be unsorted: read_tum_poses
  std::filesystem::path times;  ///< times of a KITTI file without sweeps
  std::int64_t steady_ns = 0;   ///< pose period of a KITTI file without sweeps
};

/// Reads a pose file as a recording with truth only; the poses are those of the body. Time 0 as for sweeps. Throws
/// BadInput.
Imported import_trajectory(const ReferenceSource& source);

/// Uses the poses as truth of `recording`, with stamps in its source's clock (`origin_ns`). A KITTI file has one pose
/// per sweep. The truth ends with the sensors. Throws BadInput: errors of the reader, lidar poses without a lidar, no
/// overlap.
void attach_reference(Imported& recording, const ReferenceSource& source);

/// Adds the IMUs of `imu`, which must use the same clock, to `recording`; the earlier time 0 is kept. Throws BadInput
/// if their times do not overlap.
void attach_imus(Imported& recording, Imported imu);

/// Reads a trial of BROAD (Laidig et al., Data 2021, 6(7), 72) from its HDF5 file: imu_gyr, imu_acc, imu_mag (converted
/// to tesla), sampling_rate. If both exist, opt_quat and opt_pos become the reference, unknown where the cameras lost
/// the markers. Rates and velocities are differences over 140 ms, sufficient to detect rest, but fast rotations are
/// blurred. Rates at the IMU's samples use 40 ms (reference_rate.hpp). Sample k has time k / sampling_rate. Ranges and
/// noise are not in the file and stay 0. Throws BadInput.
Imported import_broad(const std::filesystem::path& path);

/// Reads a recording of RepoIMU (Szczesna et al., ICCVG 2016) in its published form. Columns are separated by ';' after
/// two header lines (group, column): time s, "Vicon Orientation" W X Y Z, "IMU Acceleration" m/s^2, "IMU Gyroscope"
/// rad/s, "IMU Magnetometer" (without unit, omitted).
///
/// These defects are detected, corrected and noted:
/// - coarsely printed stamps are regularised within their rounding (steady_stamps.hpp);
/// - sample and hold: repeated readings are dropped, the others put on the gyro's rate. A slower accelerometer is
///   interpolated between its own readings (held_readings.hpp);
/// - glitches of the optical reference are removed (reference_glitches.hpp);
/// - delay, rotation and tilt between reference and IMU are estimated (align_reference.hpp). If `align` is set, they
///   are removed, so that the truth is the IMU's attitude in a world with z up.
///
/// The truth's rates at the IMU's stamps are derived from the attitudes (reference_rate.hpp); positions are unknown.
///
/// Throws BadInput with file, line, value and bound: unknown, missing or repeated columns, invalid numbers, non-finite
/// IMU readings, a stamp that does not increase, or a truncated last line. Also throws if more than a fifth of the
/// quaternions are off unit length by more than 1 %.
Imported import_repoimu(const std::filesystem::path& path, bool align);

/// Returns true if the file starts like a recording of RepoIMU.
bool is_repoimu(const std::filesystem::path& path);

/// Reads a flight log of AirbrakesV2 (NCSU High-Powered Rocketry Club, MIT). Columns by name: timestamp_seconds,
/// raw_acceleration_{x,y,z}_gs, raw_angular_rate_{x,y,z}_deg_per_s, and optionally magnetic_field_{x,y,z}_microteslas;
/// others are ignored. There is no reference; the log's own filter is not a truth. Rows with repeated stamps are
/// dropped and counted. Of segments more than a second apart, the longest is used, with a note. Throws BadInput as
/// above.
Imported import_airbrakes(const std::filesystem::path& path);

/// Returns true if the file has a header of AirbrakesV2.
bool is_airbrakes(const std::filesystem::path& path);

}  // namespace tumble::scenarios
