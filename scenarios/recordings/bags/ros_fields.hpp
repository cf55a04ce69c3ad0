// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "scenarios/recordings/bags/ros_messages.hpp"

/// The fields of each message type have the order of the message definition. An archive (encoder or decoder) has these
/// members:
/// - operator()(uint8 | uint32 | uint64 | float | text | array of doubles) handles one field.
/// - ros1_only(uint32) handles a field that ROS 2 removed.
/// - count(number of entries, minimum bytes of an entry) handles the length of a list, and returns the decoded length.
/// - raw(first byte, bytes) handles a block of bytes.
namespace tumble::scenarios::ros {

template <class Archive, class Entry, class Fields>
void list(Archive& archive, std::vector<Entry>& entries, std::size_t least_bytes, Fields&& fields_of) {
  entries.resize(archive.count(entries.size(), least_bytes));
  for (Entry& entry : entries) fields_of(entry);
}

template <class Archive>
void blob(Archive& archive, std::vector<std::uint8_t>& bytes) {
  bytes.resize(archive.count(bytes.size(), 1));
  archive.raw(bytes.data(), bytes.size());
}

template <class Archive>
void header_fields(Archive& archive, Header& header) {
  archive.ros1_only(header.seq);
  archive(header.sec);
  archive(header.nanosec);
  archive(header.frame_id);
}

template <class Archive>
void fields(Archive& archive, Imu& imu) {
  header_fields(archive, imu.header);
  archive(imu.orientation_xyzw);
  archive(imu.orientation_covariance);
  archive(imu.angular_velocity);
  archive(imu.angular_velocity_covariance);
  archive(imu.linear_acceleration);
  archive(imu.linear_acceleration_covariance);
}

template <class Archive>
void fields(Archive& archive, PointCloud2& cloud) {
  header_fields(archive, cloud.header);
  archive(cloud.height);
  archive(cloud.width);
  constexpr std::size_t kFieldBytes = 13;
  list(archive, cloud.fields, kFieldBytes, [&](PointField& field) {
    archive(field.name);
    archive(field.offset);
    archive(field.datatype);
    archive(field.count);
  });
  archive(cloud.is_bigendian);
  archive(cloud.point_step);
  archive(cloud.row_step);
  blob(archive, cloud.data);
  archive(cloud.is_dense);
}

template <class Archive>
void fields(Archive& archive, PoseStamped& pose) {
  header_fields(archive, pose.header);
  archive(pose.position);
  archive(pose.orientation_xyzw);
}

template <class Archive>
void fields(Archive& archive, Odometry& odometry) {
  header_fields(archive, odometry.header);
  archive(odometry.child_frame_id);
  archive(odometry.position);
  archive(odometry.orientation_xyzw);
  archive(odometry.pose_covariance);
  archive(odometry.linear_velocity);
  archive(odometry.angular_velocity);
  archive(odometry.twist_covariance);
}

template <class Archive>
void fields(Archive& archive, TransformStamped& transform) {
  header_fields(archive, transform.header);
  archive(transform.child_frame_id);
  archive(transform.translation);
  archive(transform.rotation_xyzw);
}

template <class Archive>
void fields(Archive& archive, TFMessage& message) {
  constexpr std::size_t kTransformBytes = 72;
  list(archive, message.transforms, kTransformBytes, [&](TransformStamped& each) { fields(archive, each); });
}

template <class Archive>
void fields(Archive& archive, Clock& clock) {
  archive(clock.sec);
  archive(clock.nanosec);
}

template <class Archive>
void fields(Archive& archive, LivoxCustomMsg& message) {
  header_fields(archive, message.header);
  archive(message.timebase);
  archive(message.point_num);
  archive(message.lidar_id);
  for (std::uint8_t& reserved : message.rsvd) archive(reserved);
  constexpr std::size_t kPointBytes = 19;
  list(archive, message.points, kPointBytes, [&](LivoxPoint& point) {
    archive(point.offset_time);
    archive(point.x);
    archive(point.y);
    archive(point.z);
    archive(point.reflectivity);
    archive(point.tag);
    archive(point.line);
  });
}

}  // namespace tumble::scenarios::ros
