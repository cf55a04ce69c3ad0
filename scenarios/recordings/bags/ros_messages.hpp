// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace tumble::scenarios::ros {

struct Header {
  std::uint32_t seq = 0;
  std::uint32_t sec = 0, nanosec = 0;
  std::string frame_id;
};

struct Imu {
  Header header;
  std::array<double, 4> orientation_xyzw = {0, 0, 0, 1};
  std::array<double, 9> orientation_covariance = {-1};  ///< first element -1: attitude unknown
  std::array<double, 3> angular_velocity = {};
  std::array<double, 9> angular_velocity_covariance = {};
  std::array<double, 3> linear_acceleration = {};
  std::array<double, 9> linear_acceleration_covariance = {};
};

struct PointField {
  enum Type : std::uint8_t { int8 = 1, uint8, int16, uint16, int32, uint32, float32, float64 };
  std::string name;
  std::uint32_t offset = 0;
  std::uint8_t datatype = 0;
  std::uint32_t count = 1;
};

struct PointCloud2 {
  Header header;
  std::uint32_t height = 1, width = 0;
  std::vector<PointField> fields;
  std::uint8_t is_bigendian = 0;
  std::uint32_t point_step = 0, row_step = 0;
  std::vector<std::uint8_t> data;
  std::uint8_t is_dense = 1;
};

struct PoseStamped {
  Header header;
  std::array<double, 3> position = {};
  std::array<double, 4> orientation_xyzw = {0, 0, 0, 1};
};

struct Odometry {
  Header header;
  std::string child_frame_id;
  std::array<double, 3> position = {};
  std::array<double, 4> orientation_xyzw = {0, 0, 0, 1};
  std::array<double, 36> pose_covariance = {};
  std::array<double, 3> linear_velocity = {}, angular_velocity = {};  ///< in axes of the child frame
  std::array<double, 36> twist_covariance = {};
};

struct TransformStamped {
  Header header;
  std::string child_frame_id;
  std::array<double, 3> translation = {};
  std::array<double, 4> rotation_xyzw = {0, 0, 0, 1};
};

struct TFMessage {
  std::vector<TransformStamped> transforms;
};

struct Clock {
  std::uint32_t sec = 0, nanosec = 0;
};

/// The fields follow the section "Livox pointcloud custom message" in the README of Livox-SDK/livox_ros_driver.
struct LivoxPoint {
  std::uint32_t offset_time = 0;  ///< ns after `timebase` of the message
  float x = 0, y = 0, z = 0;      ///< m
  std::uint8_t reflectivity = 0, tag = 0, line = 0;
};

struct LivoxCustomMsg {
  Header header;
  std::uint64_t timebase = 0;  ///< time of the first point [ns]
  std::uint32_t point_num = 0;
  std::uint8_t lidar_id = 0;
  std::array<std::uint8_t, 3> rsvd = {};
  std::vector<LivoxPoint> points;
};

using Message = std::variant<Imu, PointCloud2, Odometry, TransformStamped, TFMessage, Clock, LivoxCustomMsg>;
inline const char* type_of(const Imu&) {
  return "sensor_msgs/Imu";
}
inline const char* type_of(const PointCloud2&) {
  return "sensor_msgs/PointCloud2";
}
inline const char* type_of(const Odometry&) {
  return "nav_msgs/Odometry";
}
inline const char* type_of(const TransformStamped&) {
  return "geometry_msgs/TransformStamped";
}
inline const char* type_of(const TFMessage&) {
  return "tf2_msgs/TFMessage";
}
inline const char* type_of(const Clock&) {
  return "rosgraph_msgs/Clock";
}
/// The type name of LivoxCustomMsg is "livox_ros_driver2/CustomMsg" in ROS 2 bags, and kLivoxRos1 in ROS 1 bags.
inline const char* type_of(const LivoxCustomMsg&) {
  return "livox_ros_driver2/CustomMsg";
}
inline constexpr const char* kLivoxRos1 = "livox_ros_driver/CustomMsg";
inline std::string type_of(const Message& message) {
  return std::visit([](const auto& each) { return std::string(type_of(each)); }, message);
}

}  // namespace tumble::scenarios::ros
