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

/// What a bag holds besides the sensors, and how its sweeps are written.
struct BesideSensors {
  bool truth = false;
  SweepLayout sweeps = own_sweep_layout();
  /// Called with sensors read, points and truth set aside, to add estimates (scenarios/exchange); may be empty.
  std::function<void(const sim::Sensors&, BagWriting&)> more = {};
};

/// Writes a recording file in somebody else's format. `tum` and `kitti` write one file, the true poses of the body;
/// `mcap` and `rosbag1` write one file, the sensors; `csv`, `pcd`, `ply`, `rosbag2` and `rosbag2_mcap` write into a
/// folder, which is made when absent. Of bags (bag.hpp has their topics) `beside` says what else is in them. Files are
/// replaced whole. Throws BadInput: unknown format (nearest named), a recording without what the format needs, a place
/// that cannot be written. A bag is written sweep by sweep, its points and its truth set aside beside it; in memory are
/// the samples of the IMUs, 32 bytes a message, and the poses that `beside` adds.
void export_recording(const std::filesystem::path& recording, const std::string& format,
                      const std::filesystem::path& out, const BesideSensors& beside = {});

/// "t x y z qx qy qz qw" per physics sample: T_WB, seconds from the start with nine decimals, numbers that read back
/// exactly; `origin_ns` is added to the times. Without the instants that a reference does not know.
void export_tum(const sim::Truth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0);
/// The same a stretch at a time.
void export_tum(const StoredTruth& truth, const std::filesystem::path& file, std::int64_t origin_ns = 0);

/// Upper three rows of T_WB, row by row, per physics sample; KITTI's format has no time: throws BadInput for a
/// reference with gaps.
void export_kitti(const sim::Truth& truth, const std::filesystem::path& file);

/// NAME.csv per IMU in the columns of a sensor_msgs/Imu (stamp s, stamp ns, frame, attitude x y z w, its covariance,
/// rate, its covariance, specific force, its covariance; covariances in brackets, space separated; rad/s, m/s^2;
/// attitude is unknown: covariance -1 first, as ROS has it). With a truth also truth.csv: time, T_WB, v_WB_W, w_WB_B,
/// f_B, label. Throws BadInput for an IMU whose file would be another's or the truth's.
void export_csv(const sim::Sensors& sensors, const sim::Truth* truth, const std::filesystem::path& folder);

/// NAME_000000.ply (or .pcd) per sweep, binary, not deskewed, in L: x y z intensity ring, and offset_ns where points
/// have times of their own; the sweeps' starts in NAME_times.txt, seconds. import_sweeps takes them back to the bit.
void export_ply(const sim::Sensors& sensors, const std::filesystem::path& folder);
void export_pcd(const sim::Sensors& sensors, const std::filesystem::path& folder);

}  // namespace tumble::scenarios
