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

/// Returns the format names of export_recording: csv kitti mcap pcd ply rosbag1 rosbag2 rosbag2_mcap tum.
std::vector<std::string> export_formats();

/// Returns true for bag formats: mcap rosbag1 rosbag2 rosbag2_mcap.
bool is_bag_format(const std::string& format);

/// Returns the format for a file extension (.mcap, .bag, .tum); empty for others.
std::string format_of_ending(const std::filesystem::path& out);

/// Options of a format: for bags the extra content and the layout of sweeps, for trajectories the frame.
struct ExportChoices {
  bool truth = false;
  SweepLayout sweeps = own_sweep_layout();
  /// Called with the sensors (points and truth on disk) to add estimates (scenarios/exchange); may be empty.
  std::function<void(const sim::Sensors&, BagWriting&)> more = {};
  std::string frame = "body";  ///< for `tum` and `kitti`: frame of the written true poses, as in true_mounting
};

/// Writes a recording file in another format. `tum` and `kitti` write one file with the true poses of a frame. `mcap`
/// and `rosbag1` write one file with the sensors. `csv`, `pcd`, `ply`, `rosbag2` and `rosbag2_mcap` write to a folder,
/// which is created if missing. `choices` lists further content of bags (topics: bag.hpp). Existing files are replaced
/// atomically.
///
/// Returns notes: which sensors were renamed (export_names.hpp), and which have no message type in a bag. Throws
/// BadInput: unknown format (suggests the nearest), missing data for the format, or an output path that cannot be
/// written. Bags are written sweep by sweep; memory holds the IMU samples, 32 bytes per message, and the poses from
/// `choices`.
std::vector<std::string> export_recording(const std::filesystem::path& recording, const std::string& format,
                                          const std::filesystem::path& out, const ExportChoices& choices = {});

/// Returns T_BA of a frame A without calibration errors: `body`, `centre` (of the sphere's shell), or a sensor by its
/// exported or original name. Throws BadInput for another name and lists the known ones.
Eigen::Isometry3d true_mounting(const sim::Truth& truth, const std::string& frame);

/// Writes "t x y z qx qy qz qw" per physics sample: T_WA of the frame, seconds from the start with nine decimals.
/// Numbers round-trip exactly; `origin_ns` is added to the times. Omits times without a known pose.
void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");
/// The same, segment by segment.
void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");

/// Writes the upper three rows of T_WA, row by row, per physics sample. KITTI's format has no time, so references with
/// gaps throw BadInput.
void export_kitti(const sim::Truth& truth, const std::filesystem::path& file, const std::string& frame = "body");

/// Writes NAME.csv per IMU with the columns of a sensor_msgs/Imu: stamp s, stamp ns, frame, attitude x y z w, rate,
/// specific force, each with its covariance (in brackets, space separated; rad/s, m/s^2). The attitude is unknown: its
/// covariance starts with -1, as in ROS.
/// Per series: stamp s, stamp ns, frame, and one column per quantity. With a truth also truth.csv: time, T_WB, v_WB_W,
/// w_WB_B, f_B, label. NAME is the exported name of the sensor (export_names), also below.
void export_csv(const sim::Sensors& sensors, const sim::Truth* truth, const std::filesystem::path& folder);

/// Writes NAME_000000.ply (or .pcd) per sweep, binary, not deskewed, in L: x y z intensity ring, and offset_ns if
/// points have times. Sweep starts are in NAME_times.txt, in seconds. import_sweeps restores them bit-exactly.
void export_ply(const sim::Sensors& sensors, const std::filesystem::path& folder);
void export_pcd(const sim::Sensors& sensors, const std::filesystem::path& folder);

}  // namespace tumble::scenarios
