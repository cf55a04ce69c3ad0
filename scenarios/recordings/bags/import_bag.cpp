// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <type_traits>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_imu.hpp"
#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/bag_sweeps.hpp"
#include "scenarios/recordings/bags/opened_bag.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"
#include "scenarios/recordings/export_names.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/repairable.hpp"

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

bool is_reference_type(const std::string& type) {
  return type == kOdometry || type == kPoseStamped || type == kTransformStamped;
}

NamedPoses reference_poses(const OpenedBag& bag, const std::string& topic, StampSource source) {
  const std::string type = bag.topic(topic).type;
  if (type == kOdometry) return read_poses<ros::Odometry>(bag, topic, source);
  if (type == kPoseStamped) return read_poses<ros::PoseStamped>(bag, topic, source);
  if (type == kTransformStamped) return read_poses<ros::TransformStamped>(bag, topic, source);
  throw WrongOption(fmt::format("{}: the reference topic '{}' has the type {}; its type must be {}, {} or {}{}",
                                bag.place, topic, type, kOdometry, kPoseStamped, kTransformStamped,
                                bag.topic_list(is_reference_type)));
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

/// If the user does not choose the frame of the reference poses, the child_frame_id of the messages is used, provided
/// that the bag contains the transform of this frame.
void attach_reference(const OpenedBag& bag, const SensorMountings& places, const BagReading& reading, Imported& out) {
  const std::string& topic = bag.topic(reading.reference_topic, is_reference_type).name;
  NamedPoses found = reference_poses(bag, topic, reading.stamps);
  const Eigen::Isometry3d T_BA = pose_of_reference(topic, found.frame, places, reading, out);
  attach_poses(out, std::move(found.poses), T_BA, bag.place + ": topic " + topic);
}

constexpr const char* kImu = "sensor_msgs/Imu";
constexpr const char* kCloud = "sensor_msgs/PointCloud2";
constexpr const char *kTransforms = "tf2_msgs/TFMessage", *kOldTransforms = "tf/tfMessage";
constexpr const char* kStaticTopic = "/tf_static";
constexpr const char* kNoMessage = ": the topic has no messages and is left out";
bool is_imu_type(const std::string& type) {
  return type == kImu;
}
bool is_cloud_type(const std::string& type) {
  return type == kCloud || is_livox_type(type);
}

StaticFrames read_frames(const OpenedBag& bag) {
  StaticFrames frames;
  for (const BagTopic& topic : bag.topics) {
    if (!topic.name.ends_with(kStaticTopic) || (topic.type != kTransforms && topic.type != kOldTransforms)) continue;
    bag.read<ros::TFMessage>(topic.name, [&](const ros::TFMessage& message, const MessageOrigin& origin) {
      for (const ros::TransformStamped& each : message.transforms) frames.add(each, origin.where);
    });
  }
  frames.require_no_cycle(bag.place + ": topic " + kStaticTopic);
  return frames;
}

void note_unread_clouds(const OpenedBag& bag, std::vector<std::string>& notes) {
  for (const BagTopic& topic : bag.topics) {
    const auto has = [&](const char* word) { return topic.type.find(word) != std::string::npos; };
    if (has("Packet") || has("packet") || has("VelodyneScan") || has("PandarScan")) {
      notes.push_back(fmt::format(
          "{}: caution: the import skips raw packets ({}); convert the packets to points with the lidar's driver",
          topic.name, topic.type));
    } else if (!is_cloud_type(topic.type) && (has("PointCloud") || has("CustomMsg"))) {
      notes.push_back(
          fmt::format("{}: caution: the import skips clouds of type {}; convert the clouds to {} (compressed clouds: "
                      "'ros2 run point_cloud_transport republish')",
                      topic.name, topic.type, kCloud));
    }
  }
}

void require_one_clock(const sim::Sensors& sensors, bool by_headers, const std::filesystem::path& path) {
  struct Span {
    std::string name;
    std::int64_t first_ns, last_ns;
  };
  std::vector<Span> spans;
  for (const sim::ImuRecord& imu : sensors.imus) {
    if (!imu.time_ns.empty()) spans.push_back({imu.name, imu.time_ns.front(), imu.time_ns.back()});
  }
  for (const sim::LidarRecord& lidar : sensors.lidars) {
    if (lidar.sweep_start_ns.empty()) continue;
    spans.push_back({lidar.name, lidar.sweep_start_ns.front(), lidar.sweep_start_ns.back() + lidar.sweep_period_ns});
  }
  for (const Span& early : spans) {
    for (const Span& late : spans) {
      if (late.first_ns <= early.last_ns) continue;
      const std::string text = fmt::format(
          "{}: the time ranges of '{}' and '{}' do not overlap: the first range ends {} s before the second begins; "
          "check that both sensors use the same clock{}",
          path.string(), early.name, late.name,
          std::to_string((static_cast<double>(late.first_ns) - static_cast<double>(early.last_ns)) * 1e-9),
          by_headers ? " (set '--stamps record')" : "");
      if (by_headers) throw RepairableInput(text, {"--stamps", "record"});
      throw BadInput(text);
    }
  }
}

class TopicsOfKind {
 public:
  TopicsOfKind(const std::vector<std::string>& topics, bool chosen, bool leave_out, const char* option)
      : topics_(topics), chosen_(chosen), leave_out_(leave_out), option_(option) {}

  template <class Read>
  void read(std::vector<std::string>& notes, Read&& read) const {
    std::exception_ptr first;
    std::size_t failed = 0;
    for (const std::string& topic : topics_) {
      try {
        read(topic);
      } catch (const BadInput& error) {
        if (topics_.size() < 2 || chosen_) throw;
        if (!leave_out_)
          throw BadInput(fmt::format("{}; the option {} can select other topics", error.what(), option_));
        if (!first) first = std::current_exception();
        ++failed;
        notes.push_back(
            fmt::format("{}: caution: the import cannot read this topic and leaves it out: {}", topic, error.what()));
      }
    }
    if (first && failed == topics_.size()) std::rethrow_exception(first);
  }

 private:
  const std::vector<std::string>& topics_;
  bool chosen_, leave_out_;
  const char* option_;
};

/// Returns the smallest delay from header stamp to record stamp of the primary IMU.
std::int64_t add_imus(const OpenedBag& bag, SensorMountings& places, const BagReading& reading, Imported& out) {
  std::int64_t imu_lag_ns = 0;
  const std::vector<std::string> topics = bag.chosen(reading.imu_topics, is_imu_type, kImu);
  const TopicsOfKind imus(topics, !reading.imu_topics.empty(), reading.for_odometry, "--imu-topic");
  imus.read(out.notes, [&](const std::string& topic) {
    BagReading own = reading;
    if (!out.sensors.imus.empty()) own.imu.T_BI.setIdentity(), own.imu_placed = false;  // of the first IMU only
    auto [imu, record_lag_ns] = read_imu(bag, places, topic, own, out.notes);
    if (imu.time_ns.empty()) {
      out.notes.push_back(topic + kNoMessage);
      return;
    }
    if (out.sensors.imus.empty()) imu_lag_ns = record_lag_ns;
    out.sensors.imus.push_back(std::move(imu));
  });
  if (out.sensors.imus.size() > 1 && reading.imu_topics.empty())
    out.notes.push_back(fmt::format(
        "IMU '{}' is the primary IMU, because its topic comes first (set --imu-topic to choose another topic)",
        out.sensors.imus.front().name));
  return imu_lag_ns;
}

/// @param imu_lag_ns  Smallest delay from header stamp to record stamp of the primary IMU.
void add_lidars(const OpenedBag& bag, SensorMountings& places, const BagReading& reading, std::int64_t imu_lag_ns,
                Imported& out) {
  const bool chosen = !reading.lidar_topics.empty();
  std::vector<std::pair<std::string, BuiltSweeps>> lidars;
  const auto read = [&](const std::string& topic) {
    const CloudHeaders headers = read_headers(bag, topic, reading);
    if (headers.left_out_as_map(reading)) {
      out.notes.push_back(
          fmt::format("{}: the points are in frame '{}', which is not the frame of a sensor; this topic is left out",
                      topic, headers.frame));
    } else if (headers.stamps.empty() && !chosen) {
      out.notes.push_back(topic + kNoMessage);
    } else {
      lidars.emplace_back(topic, read_lidar(bag, places, topic, headers, reading, out.notes));
    }
  };
  const std::vector<std::string> topics = bag.chosen(reading.lidar_topics, is_cloud_type, kCloud);
  TopicsOfKind(topics, chosen, reading.for_odometry, "--lidar-topic").read(out.notes, read);
  // Lidars whose points have times come first, because mapping uses the first lidar. The clouds of depth cameras have
  // no point times.
  const auto is_timed = [](const auto& each) { return has_timed_points(each.second.lidar); };
  if (!chosen) std::stable_partition(lidars.begin(), lidars.end(), is_timed);
  if (lidars.size() > 1 && !chosen) {
    out.notes.push_back(fmt::format(
        "{}: mapping methods use the lidar of this topic, because {} (set --lidar-topic to choose another topic)",
        lidars.front().first,
        is_timed(lidars.front()) && !is_timed(lidars.back()) ? "its points have times" : "it is listed first"));
  }
  if (!lidars.empty() && reading.stamps == StampSource::header && !reading.stamps_stated)
    out.record_shift_s = 1e-9 * static_cast<double>(lidars.front().second.record_lag_ns - imu_lag_ns);
  for (auto& [topic, built] : lidars) add_lidar(out, std::move(built));
}

Imported import_bag(BagReader& reader, const std::filesystem::path& path, const BagReading& reading) {
  const OpenedBag bag{reader, path.string(), reader.topics()};
  const StaticFrames frames = read_frames(bag);
  Imported out;
  out.notes = reader.notes;
  for (const std::string& remark : frames.remarks()) out.notes.push_back(std::string(kStaticTopic) + ": " + remark);
  SensorMountings places(frames, bag.place + ": topic " + kStaticTopic);
  const std::int64_t imu_lag_ns = add_imus(bag, places, reading, out);
  if (!reading.base_frame.empty()) out.T_base_imu = places.primary_imu_in(reading.base_frame);
  add_lidars(bag, places, reading, imu_lag_ns, out);
  note_unread_clouds(bag, out.notes);
  if (out.sensors.imus.empty() && out.sensors.lidars.empty()) {
    throw BadInput(fmt::format("{}: the bag contains no messages of type {}, {} or CustomMsg{}", path.string(), kImu,
                               kCloud, bag.topic_list()));
  }
  out.info.attribution = "imported from " + path.filename().string();
  require_one_clock(out.sensors, reading.stamps == StampSource::header, path);
  start_clock(out);
  if (!reading.reference_topic.empty()) {
    attach_reference(bag, places, reading, out);
  }
  return out;
}

}  // namespace

Imported import_ros1_bag(const std::filesystem::path& path, const BagReading& reading) {
  return import_bag(*open_ros1_bag(path), path, reading);
}

Imported import_ros2_bag(const std::filesystem::path& path, const BagReading& reading) {
  return import_bag(*open_ros2_bag(path), path, reading);
}

Imported import_mcap(const std::filesystem::path& file, const BagReading& reading) {
  return import_bag(*open_mcap({file}), file, reading);
}

}  // namespace tumble::scenarios
