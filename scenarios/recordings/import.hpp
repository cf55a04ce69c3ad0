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
  RecordingInfo info;  ///< no scenario; `attribution` names the source, `origin_ns` is the stamp of time 0
  sim::Sensors sensors;
  std::vector<PointStore> points;       ///< points of each lidar on disk (SweepReading::scratch); otherwise empty
  std::optional<sim::Truth> reference;  ///< motion measured by a reference instrument: FORMAT.md, "References"
  std::vector<std::string> notes;       ///< remarks for the user about omissions and assumptions
};

/// AccelUnit is the unit of the accelerometer columns in a CSV file. One g is 9.80665 m/s^2.
enum class AccelUnit { m_s2, g };
enum class GyroUnit { rad_s, deg_s };

/// Reads the IMU samples of a text table. If the rows of several IMUs alternate, the column with the numbers of the
/// IMUs separates them (tables/logger_columns.hpp); the first IMU is the primary IMU. The positions of the others are
/// estimated from the readings (tables/imu_position.hpp); an IMU of unknown position is left out, with a note. The
/// separator is the comma, semicolon or tab, whichever is most frequent in the first line that is no comment. If this
/// line has no comma, semicolon or tab, blanks are the separator. The table may have comments, a row of units below the
/// names, and a separator at the end of each line (tables/logged_table.hpp). Numbers may be in scientific notation.
///
/// The names in the header line identify the columns:
/// - names that export_csv writes (each once, without other names),
/// - short forms of these names (sec nsec wx.. fx.. or ax..),
/// - names of ROS messages: ".../header/stamp" (seconds), ".../angular_velocity/x", ".../linear_acceleration/x", and y
///   and z; with points instead of slashes, as written by `rostopic echo -p` and bagpy. The stamps are those of the
///   message headers, not the times of recording.
/// - names of loggers and data sets (tables/logger_columns.hpp): "time,gyro_x,...,accel_x,...", "#timestamp
///   [ns],w_RS_S_x [rad s^-1],..."
///
/// A unit in a column name is used. If the name of the time column has no unit, the unit is inferred from the time
/// steps, with a note. If the first line contains numbers, it is a sample, and the positions identify the columns (from
/// 0): 0 stamp s, 1 stamp ns, 8-10 rate, 12-14 specific force. A non-empty `columns` names the columns:
/// "time=t,gyro=gx,gy,gz,accel=ax,ay,az". Instead of a name, it may contain a position, from 0.
///
/// `device` supplies properties that the file lacks: name, device, ranges, noise, T_BI of the primary IMU. The period
/// and the readings of `device` are replaced. Times count from the first stamp; the period is the median step. Stamps
/// that are rounded to milliseconds are moved to the true period of the IMU, with a note (rounded_stamps.hpp). The size
/// and the rotation of gravity confirm the units, with a note, if the motion is sufficient.
///
/// A line is skipped, with a note, if it has an invalid or non-finite number, or a wrong number of columns
/// (left_out.hpp). A line is also skipped if its readings are all 0 or its stamp does not increase.
///
/// Throws BadInput with file and line for unknown, repeated or missing columns, an unexpected unit, or a truncated last
/// line. Throws BadInput if more than 5 % of the lines are faulty, for fewer than two samples, or if one of these
/// limits is exceeded:
///
/// - The median specific force is 3 to 30 m/s^2, and the period is 20 us to 2 s.
/// - At most 1 % of the rates exceed twice the device's range (100 rad/s if unknown).
/// - Gravity rotates neither 57 times faster nor 57 times slower than the gyro (deg/s in place of rad/s).
Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device,
                        AccelUnit unit = AccelUnit::m_s2, GyroUnit gyro_unit = GyroUnit::rad_s,
                        const std::string& columns = "");

/// Reads all IMU tables (.csv) in a folder, for example from `export --format csv`. Each IMU has the name of its file;
/// the first IMU by name is the primary IMU. Tables of poses are skipped; other tables are skipped with a note. Throws
/// BadInput like import_imu_csv, and if no table has IMU readings.
Imported import_csv_folder(const std::filesystem::path& folder, const sim::ImuRecord& device, AccelUnit unit,
                           GyroUnit gyro_unit);

/// SweepSource describes the files with the sweeps of one lidar.
struct SweepSource {
  std::filesystem::path folder;
  std::string format;           ///< "ply", "pcd", "vtk" or "kitti" (.bin)
  std::string stem;             ///< file name before the number: "lidar"; empty: equal in all files
  std::filesystem::path times;  ///< file with a stamp per sweep; "": STEM_times.txt or times.txt in the folder, if
                                ///< present
  std::int64_t steady_ns = 0;   ///< sweep period if no times exist; 0: missing times are an error
  std::string bin_columns;      ///< columns of .bin files (read_cloud)
  SweepReading reading;
};

/// Reads the sweeps of a lidar from one file per sweep, in natural order of the file names (sweep_stamps.hpp,
/// cloud_file.hpp, sweep_builder.hpp). The stamp of a sweep comes from the file `times`, or else from the file name,
/// from absolute point times, or from `steady_ns`. Time 0 of the recording is the start of the first sweep, or the zero
/// of the clock if it is less than a second earlier. A file that cannot be used is skipped with a note. Throws BadInput
/// with the file if more than 5 % of the files are faulty. Throws BadInput for different numbers of stamps and files,
/// files of several lidars, or sweeps without times.
Imported import_sweeps(const SweepSource& source);

/// ReferenceSource describes a pose file of another program.
struct ReferenceSource {
  std::filesystem::path file;
  std::string format;           ///< "tum", "kitti" or "odometry"
  bool of_body = false;         ///< true: poses of the body; false: of the first lidar, converted with its T_BL
  bool sorted = false;          ///< true: lines may be unsorted (read_tum_poses)
  std::filesystem::path times;  ///< times of a KITTI file without sweeps
  std::int64_t steady_ns = 0;   ///< pose period of a KITTI file without sweeps
};

/// Reads a pose file as a recording that contains only a truth: poses of the body. Time 0 follows the rule of
/// import_sweeps. Throws BadInput if the file is invalid.
Imported import_trajectory(const ReferenceSource& source);

/// Reads a pose file and uses its poses as the truth of `recording`. The stamps of the poses are in the clock of the
/// recording's source (`origin_ns`). A KITTI file must have one pose per sweep. The truth ends with the sensor data.
/// Throws BadInput for errors of the reader, for lidar poses without a lidar, or if the times do not overlap.
void attach_reference(Imported& recording, const ReferenceSource& source);

/// Adds the IMUs of `imu` to `recording`, which must use the same clock. The result has the earlier time 0 of both.
/// Throws BadInput if the times do not overlap.
void attach_imus(Imported& recording, Imported imu);

}  // namespace tumble::scenarios
