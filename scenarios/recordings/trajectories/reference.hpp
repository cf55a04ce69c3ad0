// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// Motion of a real recording measured by a reference instrument: FORMAT.md, "References".
namespace tumble::scenarios {

/// A pose of frame A (body or lidar) in the instrument's world, z up. An unknown position is NaN.
struct ReferencePose {
  std::int64_t time_ns = 0;
  Eigen::Vector3d p_WA_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WA = Eigen::Quaterniond::Identity();
};

/// Tolerance of a reference quaternion's norm.
inline constexpr double kReferenceNormTolerance = 1e-2;

/// Returns why a pose is invalid after the previous one (or none), "" if valid: not finite, a quaternion norm off by
/// more than 1 %, or a stamp that does not increase. Normalises valid quaternions.
std::string problem_of(ReferencePose& pose, const ReferencePose* before);

/// Returns "tum" or "kitti", from the first line with numbers (8 or 12), or "odometry" from its header. Throws
/// BadInput.
std::string pose_format(const std::filesystem::path& file);

/// Reads a TUM file: "t x y z qx qy qz qw" per line, seconds, '#' starts a comment. `sorted` sorts by time and keeps
/// the first of equal stamps. Throws BadInput with file and line: not eight finite numbers, a quaternion norm off by
/// more than 1 %, a stamp that does not increase (unless sorted), fewer than two poses.
std::vector<ReferencePose> read_tum_poses(const std::filesystem::path& file, bool sorted);

/// Reads a KITTI file, the upper three rows of a matrix per line, with the given times. Throws BadInput with file and
/// line: not twelve finite numbers, not a rotation (within 1e-3), different numbers of poses and times.
std::vector<ReferencePose> read_kitti_poses(const std::filesystem::path& file,
                                            const std::vector<std::int64_t>& times_ns);

/// Returns true if the first line is the header of a nav_msgs/Odometry table.
bool is_odometry(const std::filesystem::path& file);

/// Reads a table of nav_msgs/Odometry, one message per line, as written by rosbag tools. It is comma separated, with
/// field names in the header. Reads header.stamp.sec, header.stamp.nanosec, pose.pose.position.x y z and
/// pose.pose.orientation.x y z w. Throws like read_tum_poses, and for a missing or repeated column and invalid
/// nanoseconds.
std::vector<ReferencePose> read_odometry_poses(const std::filesystem::path& file);

/// Returns the number of poses in a KITTI file; throws like read_kitti_poses, except for the times.
std::size_t count_kitti_poses(const std::filesystem::path& file);

/// Converts body poses to a truth. `poses` increase in the recording's clock and may start before time 0. If all poses
/// lie on a regular grid from time 0 (at least 0.1 ms), this grid is used, so that poses are unchanged; else 1 ms (more
/// for recordings above two million samples). Between poses at most 2.5 median steps apart, position is linear and
/// attitude a slerp; elsewhere both are unknown. Ends with the poses or at `end_ns`, whichever is earlier. Throws
/// BadInput without a known pose, or if longer than a day.
sim::Truth reference_truth(const std::vector<ReferencePose>& poses, std::int64_t end_ns);

/// Returns the rotation vector of the shorter rotation.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q);

/// Computes velocity and rate by central differences over `reach` samples on each side; unknown where a sample is.
void differentiate(sim::Truth& truth, std::size_t reach);

}  // namespace tumble::scenarios
