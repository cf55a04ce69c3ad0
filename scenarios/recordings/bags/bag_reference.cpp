// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag_reference.hpp"

#include <fmt/format.h>

#include <type_traits>
#include <utility>

#include "scenarios/recordings/bags/bag_stamps.hpp"
#include "scenarios/recordings/recording_clock.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kOdometry = "nav_msgs/Odometry";
constexpr const char* kPoseStamped = "geometry_msgs/PoseStamped";
constexpr const char* kTransformStamped = "geometry_msgs/TransformStamped";

struct NamedPoses {
  std::vector<ReferencePose> poses;
  std::string frame;
};

ReferencePose pose_in(const ros::TransformStamped& message) {
  ReferencePose pose{0, Eigen::Vector3d::Map(message.translation.data()), {}};
  pose.q_WA.coeffs() = Eigen::Vector4d::Map(message.rotation_xyzw.data());
  return pose;
}

template <class Message>
ReferencePose pose_in(const Message& message) {
  ReferencePose pose{0, Eigen::Vector3d::Map(message.position.data()), {}};
  pose.q_WA.coeffs() = Eigen::Vector4d::Map(message.orientation_xyzw.data());
  return pose;
}

template <class Message>
NamedPoses read_poses(const OpenedBag& bag, const std::string& topic, StampSource source) {
  NamedPoses out;
  std::vector<ReferencePose>& poses = out.poses;
  BagStamps stamps(source);
  bag.read<Message>(topic, [&](const Message& message, const MessageOrigin& origin) {
    const std::int64_t header_ns = stamp_of(message.header);
    stamps.add(header_ns, origin.record_ns);
    ReferencePose pose = pose_in(message);
    pose.time_ns = stamps.chosen(header_ns, origin.record_ns, origin.where);
    if (!poses.empty() && pose.time_ns <= poses.back().time_ns)
      throw BadInput(origin.where + ": " + stamps.disorder(poses.size()));
    if (std::string problem = problem_of(pose, poses.empty() ? nullptr : &poses.back()); !problem.empty())
      throw BadInput(origin.where + ": " + problem);
    poses.push_back(pose);
    if constexpr (!std::is_same_v<Message, ros::PoseStamped>) out.frame = without_slash(message.child_frame_id);
  });
  return out;
}

NamedPoses reference_poses(const OpenedBag& bag, const std::string& topic, StampSource source) {
  const std::string type = bag.topic(topic).type;
  if (type == kOdometry) return read_poses<ros::Odometry>(bag, topic, source);
  if (type == kPoseStamped) return read_poses<ros::PoseStamped>(bag, topic, source);
  if (type == kTransformStamped) return read_poses<ros::TransformStamped>(bag, topic, source);
  throw BadInput(fmt::format("{}: the reference topic '{}' has the type {}; its type must be {}, {} or {}", bag.place,
                             topic, type, kOdometry, kPoseStamped, kTransformStamped));
}

Eigen::Isometry3d pose_of_reference(const std::string& topic, const std::string& frame, const SensorMountings& places,
                                    const BagReading& reading, Imported& out) {
  const Eigen::Isometry3d body = Eigen::Isometry3d::Identity();
  if (reading.reference_of == ReferenceOf::lidar) return lidar_of_poses(out.sensors, topic);
  if (reading.reference_of == ReferenceOf::body || frame.empty() || frame == places.body()) return body;
  const auto T_BA = places.of(frame);
  const std::string whose =
      fmt::format("{}: according to the messages, the poses belong to the frame '{}'", topic, frame);
  if (T_BA) {
    out.notes.push_back(
        fmt::format("{}; the import converts the poses to poses of the body (set '--reference-frame body' to use the "
                    "poses unchanged)",
                    whose));
  } else if (frame != "body" && frame != "base_link") {
    out.notes.push_back(fmt::format(
        "{}. The pose of this frame on the body is unknown; the import assumes that the poses belong to the body frame",
        whose));
  }
  return T_BA.value_or(body);
}

}  // namespace

void attach_reference(const OpenedBag& bag, const SensorMountings& places, const BagReading& reading, Imported& out) {
  const std::string& topic = reading.reference_topic;
  NamedPoses found = reference_poses(bag, topic, reading.stamps);
  const Eigen::Isometry3d T_BA = pose_of_reference(topic, found.frame, places, reading, out);
  attach_poses(out, std::move(found.poses), T_BA, bag.place + ": topic " + topic);
}

}  // namespace tumble::scenarios
