// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/recording.hpp"

/// What another instrument saw of a real recording's motion: FORMAT.md, "References".
namespace tumble::scenarios {

/// A pose of the frame A (body, or lidar) in a world of the instrument's own, z up. A position that is not known is
/// NaN.
struct ReferencePose {
  std::int64_t time_ns = 0;
  Eigen::Vector3d p_WA_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WA = Eigen::Quaterniond::Identity();
};

/// How far the norm of a reference\'s quaternion may be from 1.
inline constexpr double kReferenceNormTolerance = 1e-2;

/// What is wrong with a pose that follows another one (or none): not finite, a quaternion whose norm is off by more
/// than a percent, a stamp that does not rise; "" when nothing is. A quaternion that passes is made of unit length.
std::string problem_of(ReferencePose& pose, const ReferencePose* before);

/// "tum" or "kitti", by the numbers in the first line that holds some (8 or 12), or "odometry" by its header. Throws
/// BadInput.
std::string pose_format(const std::filesystem::path& file);

/// Poses of a TUM file: "t x y z qx qy qz qw" a line, seconds, '#' begins a remark. `sorted` puts the lines in the
/// order of time and keeps the first of equal stamps. Throws BadInput with file and line: not eight finite numbers, a
/// quaternion whose norm is off by more than a percent, a stamp that does not rise (unless sorted), fewer than two.
std::vector<ReferencePose> read_tum_poses(const std::filesystem::path& file, bool sorted);

/// Poses of a KITTI file, the upper three rows of a matrix a line, at these times. Throws BadInput with file and line:
/// not twelve finite numbers, no rotation (to 1e-3), another number of poses than of times.
std::vector<ReferencePose> read_kitti_poses(const std::filesystem::path& file,
                                            const std::vector<std::int64_t>& times_ns);

/// Whether a file's first line is the header of a table of nav_msgs/Odometry.
bool is_odometry(const std::filesystem::path& file);

/// Poses of a table of nav_msgs/Odometry, a line a message, as rosbag tools write it: comma separated, in the header
/// the fields' names, of which header.stamp.sec, header.stamp.nanosec, pose.pose.position.x y z and
/// pose.pose.orientation.x y z w are read. The same errors as of a TUM file; a name that is missing or stands twice, a
/// nanosecond that is none.
std::vector<ReferencePose> read_odometry_poses(const std::filesystem::path& file);

/// Lines of a KITTI file that hold poses; the same errors but for the last.
std::size_t count_kitti_poses(const std::filesystem::path& file);

/// The truth that poses of the body make. `poses` rise, in the clock of the recording, and may begin before its time 0.
/// Sampled at their own step where all of them lie on one from time 0 (0.1 ms at least), so that they come back as they
/// were, else at 1 ms (more, when the recording would have more than two million samples); between poses no further
/// apart than 2.5 times the median step position is linear and attitude a slerp, elsewhere they are unknown. Ends with
/// the poses, or at `end_ns` where that is earlier. Throws BadInput when that holds no known pose, or more than a day.
sim::Truth reference_truth(const std::vector<ReferencePose>& poses, std::int64_t end_ns);

/// Axis times angle of a turn, the shorter way.
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& q);

/// Fills velocity and rate by central differences over `reach` samples before and after; unknown where one of them is.
void differentiate(sim::Truth& truth, std::size_t reach);

}  // namespace tumble::scenarios
