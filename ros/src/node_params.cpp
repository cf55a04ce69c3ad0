// SPDX-License-Identifier: BSD-3-Clause
#include "tumble_ros/node_params.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <span>
#include <string>

namespace tumble::ros {

namespace {

template <class Sheet>
Sheet sheet_of(const char* parameter, const std::string& name, std::span<const sheets::Named<Sheet>> all) {
  if (name.empty()) return {};
  std::string known;
  for (const sheets::Named<Sheet>& each : all) {
    if (name == each.name) return each.data_sheet;
    known += std::string(known.empty() ? "one of " : ", ") + each.name;
  }
  throw InvalidParams(std::string(parameter) + " '" + name + "'", std::numeric_limits<double>::quiet_NaN(), known);
}

constexpr double kQuaternionLength = 1e-3;  // tolerance for quaternions that are written with four digits

}  // namespace

std::span<const TextParameter> text_parameters() {
  static constexpr TextParameter kAll[] = {
      {"odom_frame", "odom", 0, "frame in which the odometry is published"},
      {"base_frame", "base_link", 0, "frame whose pose is published"},
      {"imu_frame", "", 0, "frame of the IMU; empty: frame_id of its messages"},
      {"lidar_frame", "", 0, "frame of the lidar; empty: frame_id of its messages"},
      {"tf", "imu", 0, "source of /tf: imu (every IMU sample), sweep (registered sweeps) or none"},
      {"imu_sheet", "", 0, "data sheet of the IMU, which gives the defaults of imu_*"},
      {"lidar_sheet", "", 0, "data sheet of the lidar, which gives the defaults of range_*"},
      {"time_field", "", 0, "field of PointCloud2 with the times of the points; empty: by the usual names"},
      {"map_file", "map.tumblemap", 0, "map that the service save_map writes (.tumblemap or .ply)", false},
      {"prior_map_file", "", 0,
       "map of an earlier run (.tumblemap), or a PLY or PCD file, in which the node localises itself at the start and "
       "after the service load_map; empty: none",
       false},
      {"calibration_file", "calibration.yaml", 0, "file that the service save_calibration writes", false},
      {"own_body", "", 6,
       "box around the robot in lidar axes, whose returns are dropped: x y z min, x y z max; empty: none"},
      {"position_arm", "", 3, "position x y z of the antenna in the base frame; empty: its origin"},
      {"T_base_imu", "", 7,
       "pose of the IMU in the base frame: x y z qx qy qz qw; empty: from TF. A sphere needs it, once for each IMU"},
      {"T_base_lidar", "", 7, "pose of the lidar in the base frame: x y z qx qy qz qw; empty: from TF"}};
  return kAll;
}

Eigen::Isometry3d pose_of(const std::string& parameter, std::span<const double> numbers) {
  if (numbers.size() != 7)
    throw InvalidParams(parameter, static_cast<double>(numbers.size()), "7 numbers: x y z qx qy qz qw");
  for (const double number : numbers)
    if (!std::isfinite(number)) throw InvalidParams(parameter, number, "finite numbers");
  const Eigen::Quaterniond q(numbers[6], numbers[3], numbers[4], numbers[5]);
  if (std::abs(q.norm() - 1.0) > kQuaternionLength)
    throw InvalidParams(parameter, q.norm(), "a quaternion of length 1: x y z qx qy qz qw");
  return Eigen::Translation3d(numbers[0], numbers[1], numbers[2]) * q.normalized();
}

Eigen::AlignedBox3d box_of(const std::string& parameter, std::span<const double> numbers) {
  if (numbers.empty()) return {};
  if (numbers.size() != 6)
    throw InvalidParams(parameter, static_cast<double>(numbers.size()), "6 numbers: x y z min, x y z max");
  return {Eigen::Vector3d(numbers[0], numbers[1], numbers[2]), Eigen::Vector3d(numbers[3], numbers[4], numbers[5])};
}

Eigen::Vector3d position_of(const std::string& parameter, std::span<const double> numbers) {
  if (numbers.empty()) return Eigen::Vector3d::Zero();
  if (numbers.size() != 3) throw InvalidParams(parameter, static_cast<double>(numbers.size()), "3 numbers: x y z");
  return {numbers[0], numbers[1], numbers[2]};
}

ImuDataSheet imu_sheet(const std::string& name) {
  return sheet_of<ImuDataSheet>("imu_sheet", name, sheets::imus());
}

LidarDataSheet lidar_sheet(const std::string& name) {
  return sheet_of<LidarDataSheet>("lidar_sheet", name, sheets::lidars());
}

}  // namespace tumble::ros
