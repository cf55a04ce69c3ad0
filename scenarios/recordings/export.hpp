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

/// Names that export_recording takes: csv kitti mcap pcd ply rosbag1 rosbag2 rosbag2_mcap tum.
std::vector<std::string> export_formats();

/// Those of them that are bags: mcap rosbag1 rosbag2 rosbag2_mcap.
bool is_bag_format(const std::string& format);

/// The format that the ending of a file tells (.mcap, .bag, .tum); empty for others.
std::string format_of_ending(const std::filesystem::path& out);

/// What is chosen of a format: of a bag what it holds besides the sensors and how its sweeps are written, of a
/// trajectory whose it is.
struct ExportChoices {
  bool truth = false;
  SweepLayout sweeps = own_sweep_layout();
  /// Called with sensors read, points and truth set aside, to add estimates (scenarios/exchange); may be empty.
  std::function<void(const sim::Sensors&, BagWriting&)> more = {};
  std::string frame = "body";  ///< `tum`, `kitti`: true_mounting's name of the frame whose true poses are written
};

/// Writes a recording file in somebody else's format. `tum` and `kitti` write one file, the true poses of a frame;
/// `mcap` and `rosbag1` write one file, the sensors; `csv`, `pcd`, `ply`, `rosbag2` and `rosbag2_mcap` write into a
/// folder, which is made when absent. Of bags (bag.hpp has their topics) `choices` says what else is in them. Files are
/// replaced whole. Throws BadInput: unknown format (nearest named), a recording without what the format needs, a place
/// that cannot be written. A bag is written sweep by sweep, its points and its truth set aside beside it; in memory are
/// the samples of the IMUs, 32 bytes a message, and the poses that `choices` adds. Returns which sensors are written
/// under another name than theirs (export_names.hpp), and which a bag has no message for.
std::vector<std::string> export_recording(const std::filesystem::path& recording, const std::string& format,
                                          const std::filesystem::path& out, const ExportChoices& choices = {});

/// T_BA of a frame A as it truly is, calibration errors included: `body`, `centre` (of the sphere's shell), or a sensor
/// by its name of export_names, else its own. Throws BadInput for another name, with those that there are.
Eigen::Isometry3d true_mounting(const sim::Truth& truth, const std::string& frame);

/// "t x y z qx qy qz qw" per physics sample: T_WA of the frame, seconds from the start with nine decimals, numbers that
/// read back exactly; `origin_ns` is added to the times. Without the instants that a reference does not know.
void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");
/// The same a segment at a time.
void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0,
                const std::string& frame = "body");

/// Upper three rows of T_WA, row by row, per physics sample; KITTI's format has no time: throws BadInput for a
/// reference with gaps.
void export_kitti(const sim::Truth& truth, const std::filesystem::path& file, const std::string& frame = "body");

/// NAME.csv per IMU in the columns of a sensor_msgs/Imu (stamp s, stamp ns, frame, attitude x y z w, its covariance,
/// rate, its covariance, specific force, its covariance; covariances in brackets, space separated; rad/s, m/s^2;
/// attitude is unknown: covariance -1 first, as ROS has it), and per series: stamp s, stamp ns, frame, and a column for
/// each quantity. With a truth also truth.csv: time, T_WB, v_WB_W, w_WB_B,
/// f_B, label. NAME is the sensor's by export_names, here and below.
void export_csv(const sim::Sensors& sensors, const sim::Truth* truth, const std::filesystem::path& folder);

/// NAME_000000.ply (or .pcd) per sweep, binary, not deskewed, in L: x y z intensity ring, and offset_ns where points
/// have times of their own; the sweeps' starts in NAME_times.txt, seconds. import_sweeps takes them back to the bit.
void export_ply(const sim::Sensors& sensors, const std::filesystem::path& folder);
void export_pcd(const sim::Sensors& sensors, const std::filesystem::path& folder);

}  // namespace tumble::scenarios
