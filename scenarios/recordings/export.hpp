// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/recordings/bags/bag.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

std::vector<std::string> export_formats();

bool is_bag_format(const std::string& format);

std::string format_of_ending(const std::filesystem::path& out);

/// Throws BadInput if the export would replace a file whose extension belongs to another format.
void require_own_kind(const std::string& format, const std::filesystem::path& out);

struct ExportChoices {
  bool truth = false;
  SweepLayout sweeps = own_sweep_layout();
  std::function<void(const sim::Sensors&, BagWriting&)> more = {};
  std::string frame = "body";  ///< for `tum` and `kitti`
};

/// Converts a recording to another format; existing files are replaced atomically. Time 0 of the recording becomes the
/// time stamp export_origin_ns in every format.
/// - `tum`, `kitti`: one file with the true poses of `choices.frame`
/// - `mcap`, `rosbag1`: one file with the sensor data
/// - `csv`, `pcd`, `ply`, `rosbag2`, `rosbag2_mcap`: a folder, which is created if missing
///
/// During bag export, memory contains the IMU samples, one sweep, 32 bytes per message, and the poses of estimates.
std::vector<std::string> export_recording(const std::filesystem::path& recording, const std::string& format,
                                          const std::filesystem::path& out, const ExportChoices& choices = {});

/// Returns the true mounting T_BA of a frame A on the body. The frame A is `body`, `centre` (of the sphere's shell), or
/// a sensor by its exported or original name.
Eigen::Isometry3d true_mounting(const sim::Truth& truth, const std::string& frame);

/// Writes the true poses T_WA of a frame A to a TUM file, one line "t x y z qx qy qz qw" per physics sample. The time t
/// is in seconds, rounded to nanoseconds. The TUM file omits times with an unknown pose.
void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");
void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");

/// Writes the true poses T_WA of a frame A to a KITTI file. Each line contains the upper three rows of the matrix T_WA
/// at one physics sample. Throws BadInput for a reference with gaps, because a KITTI file has no time stamps.
void export_kitti(const sim::Truth& truth, const std::filesystem::path& file, const std::string& frame = "body");

/// Writes one CSV file per IMU, with the fields of sensor_msgs/Imu as columns: rate [rad/s] and specific force [m/s^2],
/// each with covariance. The attitude is marked as unknown. If `truth` is not null, the file truth.csv contains time,
/// pose T_WB, velocity v_WB_W, rate w_WB_B, specific force f_B and contact label.
void export_csv(const sim::Sensors& sensors, const sim::Truth* truth, const std::filesystem::path& folder,
                std::int64_t origin_ns = 0);

/// Writes one binary PLY file per sweep. The columns are x y z intensity ring in lidar axes, not deskewed, and
/// offset_ns if the points have times. The file NAME_times.txt contains the start times of the sweeps in seconds, which
/// import_sweeps() restores bit-exactly.
void export_ply(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns = 0);
void export_pcd(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns = 0);

}  // namespace tumble::scenarios
