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

/// Returns the names of the export formats: csv kitti mcap pcd ply rosbag1 rosbag2 rosbag2_mcap tum.
std::vector<std::string> export_formats();

/// Returns true for a bag format: mcap rosbag1 rosbag2 rosbag2_mcap.
bool is_bag_format(const std::string& format);

/// Returns the export format for the extension of a file (.mcap, .bag, .tum); empty for other extensions.
std::string format_of_ending(const std::filesystem::path& out);

/// Throws BadInput if the export would replace a file whose extension belongs to another format. Formats that write a
/// folder are not checked.
void require_own_kind(const std::string& format, const std::filesystem::path& out);

/// ExportChoices contains the options of an export: extra content and sweep layout for bags, frame for trajectories.
struct ExportChoices {
  bool truth = false;
  SweepLayout sweeps = own_sweep_layout();
  /// The function adds estimates to a bag (scoring/estimate_in_bag.hpp); it may be empty. The points and the truth of
  /// the sensors that the function receives are on disk.
  std::function<void(const sim::Sensors&, BagWriting&)> more = {};
  std::string frame = "body";  ///< for `tum` and `kitti`: frame of the true poses, see true_mounting
};

/// Writes a recording file in another format. `tum` and `kitti` give one file with the true poses of a frame. `mcap`
/// and `rosbag1` give one file with the sensor data. `csv`, `pcd`, `ply`, `rosbag2` and `rosbag2_mcap` give a folder,
/// which is created if missing. `choices` selects further content of bags (topics: bag.hpp). Existing files are
/// replaced atomically. In all formats, time 0 of the recording is export_origin_ns.
///
/// Returns notes about renamed sensors (export_names.hpp), and about sensors for which a bag has no message type.
/// Throws BadInput for an unknown format; the message suggests the nearest name. Throws BadInput if the recording lacks
/// data that the format needs, or if the output path cannot be written. A bag is written sweep by sweep; memory
/// contains the IMU samples, 32 bytes per message, and the poses from `choices`.
std::vector<std::string> export_recording(const std::filesystem::path& recording, const std::string& format,
                                          const std::filesystem::path& out, const ExportChoices& choices = {});

/// Returns the mounting T_BA of a frame A on the body, without calibration errors. The frame is `body`, `centre` (of
/// the sphere's shell), or a sensor by its exported or original name. Throws BadInput for another name; the message
/// lists the known names.
Eigen::Isometry3d true_mounting(const sim::Truth& truth, const std::string& frame);

/// Writes the true poses T_WA of frame A to a TUM file. Each physics sample has one line "t x y z qx qy qz qw", with t
/// in seconds with nine decimals. Reading restores all numbers exactly, except for the rounded time. `origin_ns` is
/// added to all times. Times with an unknown pose are omitted.
void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");
/// Writes a truth that is on disk to a TUM file, part by part.
void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");

/// Writes the true poses to a KITTI file: the upper three rows of the matrix T_WA in one line per physics sample. The
/// format has no time, so a reference with gaps throws BadInput.
void export_kitti(const sim::Truth& truth, const std::filesystem::path& file, const std::string& frame = "body");

/// Writes NAME.csv for each IMU, with the columns of a sensor_msgs/Imu: stamp s, stamp ns, frame, attitude x y z w,
/// rate [rad/s], specific force [m/s^2]. Each quantity has a column with its covariance: numbers in brackets, separated
/// by spaces. The attitude is unknown, so its covariance starts with -1, as in ROS. Other sensors have the columns
/// stamp s, stamp ns, frame, and one column per quantity. If `truth` is not null, truth.csv contains time, T_WB,
/// v_WB_W, w_WB_B, f_B and contact label. NAME is the exported name of the sensor (export_names). `origin_ns` is added
/// to all times.
void export_csv(const sim::Sensors& sensors, const sim::Truth* truth, const std::filesystem::path& folder,
                std::int64_t origin_ns = 0);

/// Writes one file NAME_000000.ply (or .pcd) per sweep of a lidar. The binary file contains x y z intensity ring in
/// lidar axes, not deskewed, and offset_ns if the points have times. NAME_times.txt contains the sweep starts in
/// seconds, which import_sweeps restores bit-exactly. `origin_ns` is added to the sweep starts.
void export_ply(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns = 0);
void export_pcd(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns = 0);

}  // namespace tumble::scenarios
