// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/clouds/sweep_builder.hpp"
#include "scenarios/recordings/recording_file.hpp"
#include "scenarios/recordings/trajectories/reference.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct Imported {
  RecordingInfo info;  ///< `origin_ns`: source stamp of time 0
  sim::Sensors sensors;
  std::vector<PointStore> points;       ///< points on disk, or empty
  std::optional<sim::Truth> reference;  ///< see FORMAT.md, "References"
  std::vector<std::string> notes;
  std::vector<std::vector<std::string>> cloud_fields;  ///< of each lidar in files or bags
  /// If record stamps of a bag replaced the header stamps, shift of the lidar's clock relative to the clock of the
  /// primary IMU [s]. The shift is empty if the user chose header or record stamps.
  std::optional<double> record_shift_s;
  double imu_minus_lidar_clock_s = 0.0;         ///< clock offset that was added to the sweep times
  std::optional<Eigen::Isometry3d> T_base_imu;  ///< pose of the primary IMU in the base frame that the user names
};

enum class AccelUnit { m_s2, g };
enum class GyroUnit { rad_s, deg_s };

/// Reads the samples of one IMU from a text table with commas, semicolons, tabs or blanks (tables/csv_text.hpp).
/// If the rows of several IMUs alternate, one column must contain the number of the IMU to which the row belongs. The
/// first IMU is the primary IMU. The positions of the further IMUs are estimated from the readings
/// (tables/import_imu_csv.cpp); an IMU of unknown position is left out, with a note.
///
/// The header line identifies the columns by one of these naming schemes:
/// - names that export_csv writes, or their short forms (sec nsec wx.. fx.. or ax..),
/// - ROS names as written by `rostopic echo -p` and bagpy: ".../header/stamp" [s], ".../angular_velocity/x",
///   ".../linear_acceleration/x", and y and z,
/// - names of loggers and data sets (tables/logger_columns.hpp): "time,gyro_x,...,accel_x,...", "#timestamp
///   [ns],w_RS_S_x [rad s^-1],..."
///
/// Without a unit in the name of the time column, the unit is inferred from the time steps, with a note. Without a
/// header, the columns have fixed positions from 0: 0 stamp s, 1 stamp ns, 8-10 rate, 12-14 specific force.
///
/// @param columns   Names or positions (from 0) of the columns: "time=t,gyro=gx,gy,gz,accel=ax,ay,az"; may be empty.
/// @param device    Properties that the file lacks: name, device, ranges, noise, T_BI of the primary IMU.
/// @return          The samples and notes. Times count from the first stamp, and the period is the median time step. If
/// the stamps are rounded to milliseconds, the result contains corrected times, evenly spaced, and a note
/// (rounded_stamps.hpp).
///
/// A line is skipped, with a note, in each of these cases (left_out.hpp):
/// - The line has an invalid or non-finite number, or a wrong number of columns.
/// - The readings are all 0.
/// - The stamp does not increase.
///
/// Throws BadInput with file and line for unknown, repeated or missing columns, or an unexpected unit. Throws BadInput
/// for a truncated last line, more than 5 % of faulty lines, or fewer than two samples. Throws BadInput if the readings
/// violate one of these limits:
///
/// - The median specific force is 3 to 30 m/s^2, and the sample period is 20 us to 2 s.
/// - At most 1 % of the rates exceed twice the device's range (100 rad/s if unknown).
/// - The rotation that the gyro measures agrees with the rotation of gravity in the accelerometer axes. If the
///   rotations of gyro and gravity differ by a factor of 57, the unit of the rates (deg/s or rad/s) is wrong.
Imported import_imu_csv(const std::filesystem::path& path, const sim::ImuRecord& device,
                        AccelUnit unit = AccelUnit::m_s2, GyroUnit gyro_unit = GyroUnit::rad_s,
                        const std::string& columns = "");

/// Reads a folder of CSV tables, one per IMU. Each IMU has the name of its file, and the first IMU in alphabetical
/// order is the primary IMU. Tables without IMU readings are skipped.
Imported import_csv_folder(const std::filesystem::path& folder, const sim::ImuRecord& device, AccelUnit unit,
                           GyroUnit gyro_unit);

struct SweepSource {
  std::filesystem::path folder;
  std::string format;           ///< "ply", "pcd", "vtk" or "kitti" (.bin)
  std::string stem;             ///< file name before the number
  std::filesystem::path times;  ///< empty: STEM_times.txt or times.txt
  std::int64_t steady_ns = 0;   ///< sweep period if no times exist
  std::string bin_columns;      ///< columns of .bin files (read_cloud)
  SweepReading reading;
};

/// Reads the sweeps of a lidar from one file per sweep, in natural order of the file names (clouds/import_sweeps.hpp).
/// The stamp of a sweep comes from the first available source: the file `times`, the file name, absolute point times,
/// or the constant sweep period `steady_ns`. Time 0 of the recording is the start of the first sweep. If the first
/// sweep starts less than a second after the zero of the source clock, time 0 of the recording is the zero of the
/// source clock.
///
/// Throws BadInput if more than 5 % of the files are faulty; fewer faulty files are skipped with a note.
Imported import_sweeps(const SweepSource& source);

struct ReferenceSource {
  std::filesystem::path file;
  std::string format;           ///< "tum", "kitti" or "odometry"
  bool of_body = false;         ///< false: poses of the first lidar
  bool sorted = false;          ///< lines may be unsorted
  std::filesystem::path times;  ///< for KITTI files without sweeps
  std::int64_t steady_ns = 0;   ///< for KITTI files without sweeps
};

Imported import_trajectory(const ReferenceSource& source);

/// Uses the poses of a file as the truth of `recording`, up to the end of the sensor data. The time stamps of the poses
/// must come from the same clock as the time stamps of the imported sensor data. `RecordingInfo::origin_ns` is the time
/// stamp of time 0 of `recording` in the source clock. A KITTI pose file must have one pose per sweep.
void attach_reference(Imported& recording, const ReferenceSource& source);

/// Adds IMUs that use the same clock as `recording`. Time 0 of the result is time 0 of the recording or of the IMUs,
/// whichever is earlier.
void attach_imus(Imported& recording, Imported imu);

/// Adds a clock offset to the times of all sweeps. The shift `record_shift_s` decreases by the offset.
void correct_lidar_clock(double imu_minus_lidar_clock_s, Imported& recording);

}  // namespace tumble::scenarios
