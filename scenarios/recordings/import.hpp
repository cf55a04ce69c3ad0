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

/// Imported is an imported recording, ready for write_recording.
struct Imported {
  RecordingInfo info;  ///< without scenario; `attribution` states the source, `origin_ns` the stamp of time 0
  sim::Sensors sensors;
  std::vector<PointStore> points;       ///< points of each lidar if stored on disk (SweepReading::scratch), else empty
  std::optional<sim::Truth> reference;  ///< motion measured by a reference instrument: FORMAT.md, "References"
  std::vector<std::string> notes;       ///< remarks for the user about omissions and assumptions
};

/// AccelUnit is the unit of the accelerometer columns in a CSV file. One g is 9.80665 m/s^2.
enum class AccelUnit { m_s2, g };
enum class GyroUnit { rad_s, deg_s };

/// Reads the samples of one IMU from a text table. The separator is the comma, semicolon or tab that is most frequent
/// in the first line that is no comment. If the line contains no comma, semicolon or tab, blanks are the separator. The
/// table may have comments, a row of units below the names, and a separator at the end of each line
/// (tables/logged_table.hpp). Numbers may be in scientific notation.
///
/// The names in the header line identify the columns. The reader accepts the following column names.
/// - The reader accepts the names that export_csv writes (each once, without other names).
/// - The reader accepts short forms of these names (sec nsec wx.. fx.. or ax..).
/// - The reader accepts names of ROS messages: ".../header/stamp" (seconds), ".../angular_velocity/x",
///   ".../linear_acceleration/x", and y and z. Names of ROS messages may have points instead of slashes, as written by
///   `rostopic echo -p` and bagpy. The reader uses the stamps of the message headers, instead of the times of
///   recording.
/// - The reader accepts names of loggers and data sets (tables/logger_columns.hpp): "time,gyro_x,...,accel_x,...",
///   "#timestamp [ns],w_RS_S_x [rad s^-1],..."
///
/// A unit in a column name is used. If the name of the time column has no unit, the unit is inferred from the time
/// steps, with a note. If the first line contains numbers, it is a sample, and the positions identify the columns. The
/// positions count from 0: 0 stamp s, 1 stamp ns, 8-10 rate, 12-14 specific force. If `columns` is not empty, it names
/// the columns instead: "time=t,gyro=gx,gy,gz,accel=ax,ay,az". Each column name may also be a position, counted from 0.
///
/// The record `device` supplies properties that the file lacks: name, device, ranges, noise, T_BI. The period and the
/// readings of `device` are replaced. The time of the recording counts from the first stamp, and the period is the
/// median step. Stamps that are rounded to milliseconds are moved to the true period of the IMU, with a note
/// (rounded_stamps.hpp). The size and rotation of gravity confirm the units, with a note if the motion allows the
/// check.
///
/// A line is skipped, with a note, if it has an invalid or non-finite number, a wrong number of columns, or a stamp
/// that does not increase (left_out.hpp). A line whose readings are all 0 is also skipped.
///
/// Throws BadInput with file and line for unknown, repeated or missing columns, an unexpected unit, or a truncated last
/// line. Throws BadInput if more than 5 % of the lines are faulty, or for fewer than two samples. The median specific
/// force must be 3 to 30 m/s^2, and the period must be 20 us to 2 s. At most 1 % of the rates may exceed twice the
/// device's range (100 rad/s if unknown). Gravity must not rotate 57 times faster or slower than the gyro's rates.
Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device,
                        AccelUnit unit = AccelUnit::m_s2, GyroUnit gyro_unit = GyroUnit::rad_s,
                        const std::string& columns = "");

/// Reads all IMU tables (.csv) in a folder, for example in a folder of `export --format csv`. Each IMU has the name of
/// its file, and the first IMU by name is the primary IMU. Tables of poses are skipped, and other tables are skipped
/// with a note. Throws BadInput like import_imu_csv, and if no table has IMU readings.
Imported import_csv_folder(const std::filesystem::path& folder, const sim::ImuRecord& device, AccelUnit unit,
                           GyroUnit gyro_unit);

/// SweepSource describes the files with the sweeps of one lidar.
struct SweepSource {
  std::filesystem::path folder;
  std::string format;           ///< "ply", "pcd", "vtk" or "kitti" (.bin)
  std::string stem;             ///< file name before the number: "lidar"; "": must be equal for all files
  std::filesystem::path times;  ///< file with a stamp per sweep; "": STEM_times.txt or times.txt in the folder, if
                                ///< present
  std::int64_t steady_ns = 0;   ///< sweep period if no times are available; 0: missing times throw
  std::string bin_columns;      ///< columns of .bin files: see read_cloud
  SweepReading reading;
};

/// Reads the sweeps of a lidar from one file per sweep, in natural order of the file names (sweep_stamps.hpp,
/// cloud_file.hpp, sweep_builder.hpp). The stamp of a sweep comes from the file `times`, or else from the file names,
/// from absolute point times, or from `steady_ns`. Time 0 of the recording is the start of the first sweep. If the
/// clock started less than a second earlier, time 0 is the zero of the clock. A file that cannot be read or used is
/// skipped with a note. Throws BadInput with the file if more than 5 % of the files are faulty. Throws BadInput for
/// different numbers of stamps and files, files of several lidars, or sweeps without times.
Imported import_sweeps(const SweepSource& source);

/// ReferenceSource describes a pose file of another program.
struct ReferenceSource {
  std::filesystem::path file;
  std::string format;           ///< "tum", "kitti" or "odometry"
  bool of_body = false;         ///< poses of the body; else poses of the first lidar, converted with its T_BL
  bool sorted = false;          ///< lines may be unsorted: read_tum_poses
  std::filesystem::path times;  ///< times of a KITTI file without sweeps
  std::int64_t steady_ns = 0;   ///< pose period of a KITTI file without sweeps
};

/// Reads a pose file as a recording that contains only a truth. The poses in the file are those of the body. Time 0 of
/// the recording follows the rule of import_sweeps. Throws BadInput if the file is invalid.
Imported import_trajectory(const ReferenceSource& source);

/// Reads a pose file and uses its poses as the truth of `recording`. The stamps of the poses are in the clock of the
/// recording's source (`origin_ns`). A KITTI file must have one pose per sweep. The truth ends with the sensor data.
/// Throws BadInput for errors of the reader, for lidar poses without a lidar, or if the times do not overlap.
void attach_reference(Imported& recording, const ReferenceSource& source);

/// Adds the IMUs of the recording `imu` to `recording`. The recordings `imu` and `recording` must use the same clock.
/// The result has the earlier time 0 of the two recordings. Throws BadInput if the times of the two recordings do not
/// overlap.
void attach_imus(Imported& recording, Imported imu);

}  // namespace tumble::scenarios
