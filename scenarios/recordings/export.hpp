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

/// Returns whether the format is a bag format: mcap rosbag1 rosbag2 rosbag2_mcap.
bool is_bag_format(const std::string& format);

/// Returns the export format for a file extension (.mcap, .bag, .tum), or an empty text for other extensions.
std::string format_of_ending(const std::filesystem::path& out);

/// Throws BadInput if `out` is an existing file whose extension belongs to another format than `format`. The export
/// would replace this file. Formats that write a folder are not checked.
void require_own_kind(const std::string& format, const std::filesystem::path& out);

/// ExportChoices contains options of an export format: extra content and sweep layout for bags, frame for trajectories.
struct ExportChoices {
  bool truth = false;
  SweepLayout sweeps = own_sweep_layout();
  /// Function that adds estimates to a bag (scenarios/exchange); may be empty. The sensors that the function receives
  /// have their points and truth on disk.
  std::function<void(const sim::Sensors&, BagWriting&)> more = {};
  std::string frame = "body";  ///< for `tum` and `kitti`: frame of the written true poses, as in true_mounting
};

/// Writes a recording file in another format. The formats `tum` and `kitti` give one file with the true poses of a
/// frame. The formats `mcap` and `rosbag1` give one file with the sensor data. The formats `csv`, `pcd`, `ply`,
/// `rosbag2` and `rosbag2_mcap` give a folder, which is created if missing. `choices` states further content of bags
/// (topics: bag.hpp). Existing files are replaced atomically. All formats use one clock, with time 0 of the recording
/// at export_origin_ns.
///
/// Returns notes about sensors that were renamed (export_names.hpp) and sensors without a message type in a bag. Throws
/// BadInput for an unknown format; the message suggests the nearest name. Throws BadInput also if the recording lacks
/// data that the format needs, or if the output path cannot be written. Bags are written sweep by sweep. Memory holds
/// the IMU samples, 32 bytes per message, and the poses from `choices`.
std::vector<std::string> export_recording(const std::filesystem::path& recording, const std::string& format,
                                          const std::filesystem::path& out, const ExportChoices& choices = {});

/// Returns T_BA of a frame A without calibration errors. The frame is `body`, `centre` (of the sphere's shell), or a
/// sensor by its exported or original name. For another name, throws BadInput with a list of the known names.
Eigen::Isometry3d true_mounting(const sim::Truth& truth, const std::string& frame);

/// Writes one line "t x y z qx qy qz qw" per physics sample: T_WA of the frame A, and seconds with nine decimals.
/// Numbers are restored exactly when read. `origin_ns` is added to the times. Times without a known pose are omitted.
void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");
/// Writes the truth from disk segment by segment.
void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");

/// Writes the upper three rows of the matrix T_WA, row by row, one line per physics sample. KITTI's format has no time,
/// so references with gaps throw BadInput.
void export_kitti(const sim::Truth& truth, const std::filesystem::path& file, const std::string& frame = "body");

/// Writes NAME.csv for each IMU with the columns of a sensor_msgs/Imu: stamp s, stamp ns, frame, attitude x y z w, rate
/// [rad/s], specific force [m/s^2]. Each quantity has its covariance in brackets, separated by spaces. The attitude is
/// unknown, so its covariance starts with -1, as in ROS. Each additional sensor series has the columns stamp s, stamp
/// ns, frame, and one column per quantity. If `truth` is not null, truth.csv contains time, T_WB, v_WB_W, w_WB_B, f_B
/// and label. NAME is the exported name of the sensor (export_names). `origin_ns` is added to the times.
void export_csv(const sim::Sensors& sensors, const sim::Truth* truth, const std::filesystem::path& folder,
                std::int64_t origin_ns = 0);

/// Writes NAME_000000.ply (or .pcd) for each sweep. The exported file is binary, not deskewed, in lidar axes, with x y
/// z intensity ring, and offset_ns if points have times. NAME_times.txt contains the sweep starts in seconds, which
/// import_sweeps restores bit-exactly. `origin_ns` is added to the sweep starts.
void export_ply(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns = 0);
void export_pcd(const sim::Sensors& sensors, const std::filesystem::path& folder, std::int64_t origin_ns = 0);

}  // namespace tumble::scenarios
