// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "sim/recording.hpp"

namespace tumble::scenarios {

/// ReferencePose is a pose from a reference instrument, in a world frame whose z axis points up. NaN marks an unknown
/// position.
struct ReferencePose {
  std::int64_t time_ns = 0;
  Eigen::Vector3d p_WA_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond q_WA = Eigen::Quaterniond::Identity();
};

inline constexpr double kReferenceNormTolerance = 1e-2;

/// Returns true for an unknown pose, in which all numbers are NaN. Optical systems and the command `export` write such
/// poses, and readers skip them.
bool is_unknown(const ReferencePose& pose);

/// Returns why a pose is invalid, or an empty text for a valid pose. A valid pose is finite, within 1e9 m of the
/// origin, and later than the pose `before`. The quaternion norm of a valid pose is 1 within 1 %; the function
/// normalises the quaternion.
std::string problem_of(ReferencePose& pose, const ReferencePose* before);

/// If `sorted` is true, sorts the poses by time and keeps the first of several poses with equal stamps.
void finish_poses(const std::filesystem::path& file, bool sorted, std::vector<ReferencePose>& poses);

std::string pose_format(const std::filesystem::path& file);

/// A line of a TUM file is "t x y z qx qy qz qw", with the time t in seconds. In TUM files, '#' starts a comment, and
/// blanks or commas separate numbers. Throws BadInput with file and line for a line without eight finite numbers, or a
/// quaternion norm that differs from 1 by more than 1 %. If `sorted` is true, the poses are sorted by time; otherwise,
/// a stamp that does not increase throws BadInput.
std::vector<ReferencePose> read_tum_poses(const std::filesystem::path& file, bool sorted);

/// Reads poses from a KITTI file, whose lines contain the upper three rows of pose matrices. Throws BadInput with file
/// and line for a line without twelve finite numbers, or a matrix that is not a rotation (within 1e-3).
std::vector<ReferencePose> read_kitti_poses(const std::filesystem::path& file,
                                            const std::vector<std::int64_t>& times_ns);

bool is_pose_table(const std::filesystem::path& file);

/// Reads a table with one pose per line, with the separators of IMU tables (tables/csv_text.hpp). The names in the
/// header identify the columns, in any order:
/// - ground truth of EuRoC and TUM VI ("#timestamp [ns],p_RS_R_x [m],...,q_RS_w [],..."),
/// - messages nav_msgs/Odometry, PoseStamped, TransformStamped ("header.stamp.sec", "pose.pose.position.x",
///   "field.transform.translation.x"),
/// - truth.csv of the command `export`, and short names ("timestamp tx ty tz qx qy qz qw").
///
/// If the column name states no unit, a time is in decimal seconds, or, depending on the number of digits, in ms, us or
/// ns since 1970.
std::vector<ReferencePose> read_pose_table(const std::filesystem::path& file, bool sorted);

std::size_t count_kitti_poses(const std::filesystem::path& file);

/// Computes the truth of a recording from reference poses. The time stamps of `poses` must increase and use the
/// recording's clock; the first time stamps may be negative. If the times of all poses are multiples of one time step
/// of at least 0.1 ms, the truth uses this time step with unchanged poses. Otherwise, the truth has time steps of 1 ms,
/// or longer time steps that limit the truth to two million samples. Position is interpolated linearly, and attitude by
/// slerp. Position and attitude are unknown in gaps longer than 2.5 median steps of the poses. The truth from reference
/// poses ends with the last pose or at `end_ns`, whichever is earlier.
sim::Truth reference_truth(const std::vector<ReferencePose>& poses, std::int64_t end_ns);

}  // namespace tumble::scenarios
