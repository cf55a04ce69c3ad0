// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cstring>
#include <sstream>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/static_frames.hpp"
#include "scenarios/recordings/clouds/sweep_stamps.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kImu = "sensor_msgs/Imu";
constexpr const char* kCloud = "sensor_msgs/PointCloud2";
constexpr const char* kOdometry = "nav_msgs/Odometry";
constexpr const char* kPose = "geometry_msgs/PoseStamped";
constexpr const char *kTransforms = "tf2_msgs/TFMessage", *kOldTransforms = "tf/tfMessage";
constexpr const char* kStaticTopic = "/tf_static";

std::int64_t stamp_of(const ros::Header& header) {
  return std::int64_t{header.sec} * 1000000000 + header.nanosec;
}

template <class Number>
void take_column(const ros::PointCloud2& cloud, std::size_t row_bytes, std::size_t offset, std::vector<double>& out) {
  std::size_t point = 0;
  for (std::uint32_t row = 0; row < cloud.height; ++row) {
    for (std::uint32_t i = 0; i < cloud.width; ++i) {
      Number value;
      std::memcpy(&value, cloud.data.data() + row * row_bytes + std::size_t{i} * cloud.point_step + offset,
                  sizeof(value));
      out[point++] = static_cast<double>(value);
    }
  }
}

struct FieldType {
  std::size_t bytes;
  void (*take)(const ros::PointCloud2&, std::size_t, std::size_t, std::vector<double>&);
};

/// By the number of the type; of others nothing is known.
const FieldType* type_of(std::uint8_t datatype) {
  static const FieldType known[] = {{1, take_column<std::int8_t>},  {1, take_column<std::uint8_t>},
                                    {2, take_column<std::int16_t>}, {2, take_column<std::uint16_t>},
                                    {4, take_column<std::int32_t>}, {4, take_column<std::uint32_t>},
                                    {4, take_column<float>},        {8, take_column<double>}};
  return datatype >= ros::PointField::int8 && datatype <= ros::PointField::float64 ? &known[datatype - 1] : nullptr;
}

/// Columns of a message, whose layout is held against its data first.
Cloud cloud_of(const ros::PointCloud2& message, const std::string& where) {
  if (message.is_bigendian != 0) throw BadInput(where + ": big-endian points are not read");
  const std::uint64_t tight = std::uint64_t{message.width} * message.point_step;
  const std::uint64_t row_bytes = std::max<std::uint64_t>(message.row_step, tight);
  Cloud out;
  if (message.width == 0 || message.height == 0) return out;
  if (message.point_step == 0 || row_bytes > message.data.size() / message.height) {
    throw BadInput(where + ": " + std::to_string(message.height) + " x " + std::to_string(message.width) +
                   " points of " + std::to_string(message.point_step) + " bytes do not fit its data of " +
                   std::to_string(message.data.size()) + " bytes");
  }
  out.points = std::size_t{message.width} * message.height;
  for (const ros::PointField& field : message.fields) {
    const FieldType* type = type_of(field.datatype);
    if (type == nullptr || field.count != 1) continue;
    if (std::uint64_t{field.offset} + type->bytes > message.point_step) {
      throw BadInput(where + ": field '" + field.name + "' at byte " + std::to_string(field.offset) +
                     " lies outside of its point of " + std::to_string(message.point_step) + " bytes");
    }
    out.names.push_back(field.name);
    type->take(message, row_bytes, field.offset, out.columns.emplace_back(out.points));
  }
  return out;
}

/// A bag, its place for messages, and its topics.
struct Bag {
  BagReader& reader;
  std::string place;
  std::vector<BagTopic> topics;

  const BagTopic& topic(const std::string& name) const {
    std::vector<std::string> names;
    for (const BagTopic& each : topics) {
      if (each.name == name) return each;
      names.push_back(each.name);
    }
    const std::string near = sim::nearest_name(name, names);
    throw BadInput(place + ": no topic '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }

  /// The topics named, which must be of this type; all of it when none is named.
  std::vector<std::string> chosen(const std::vector<std::string>& names, const std::string& type) const {
    std::vector<std::string> out = names;
    for (const std::string& name : names) {
      if (topic(name).type != type)
        throw BadInput(place + ": topic '" + name + "' is of type " + topic(name).type + ", must be " + type);
    }
    for (const BagTopic& each : topics) {
      if (names.empty() && each.type == type) out.push_back(each.name);
    }
    return out;
  }

  /// Calls `take(message, where)` for each message of the topic.
  template <class Message, class Take>
  void read(const std::string& name, Take&& take) const {
    std::size_t number = 0;
    reader.read(name, [&](ros::Bytes& bytes) {
      const std::string where = place + ": message " + std::to_string(number++) + " of " + name;
      Message message;
      try {
        message = reader.cdr(name) ? ros::from_cdr<Message>(bytes) : ros::from_ros1<Message>(bytes);
      } catch (const ros::BadMessage& error) {
        throw BadInput(where + ": " + error.what());
      }
      take(message, where);
    });
  }
};

/// A topic as the name of a sensor: "/imu/data" is imu_data, "/lidar/points" lidar.
std::string sensor_name(std::string topic) {
  while (topic.starts_with('/')) topic.erase(0, 1);
  if (topic.ends_with("/points")) topic.resize(topic.size() - 7);
  std::replace(topic.begin(), topic.end(), '/', '_');
  return topic;
}

StaticFrames read_frames(const Bag& bag) {
  StaticFrames frames;
  for (const BagTopic& topic : bag.topics) {
    if (topic.name != kStaticTopic || (topic.type != kTransforms && topic.type != kOldTransforms)) continue;
    bag.read<ros::TFMessage>(topic.name, [&](const ros::TFMessage& message, const std::string& where) {
      for (const ros::TransformStamped& each : message.transforms) frames.add(each, where);
    });
  }
  return frames;
}

/// Where the bag says that a sensor is, unless somebody else has said it: then both are shown where they differ.
void place_sensor(const Bag& bag, const StaticFrames& frames, const std::string& topic, const std::string& frame,
                  Eigen::Isometry3d& T_BA, std::vector<std::string>& notes) {
  const std::string body = frames.body();
  if (body.empty()) return;
  const auto stated = frames.pose(body, frame, bag.place + ": topic " + kStaticTopic);
  if (!stated) return;
  const auto text = [](const Eigen::Isometry3d& T) {
    std::ostringstream out;
    const Eigen::Quaterniond q(T.linear());
    const Eigen::IOFormat row(Eigen::StreamPrecision, Eigen::DontAlignCols, " ", " ");
    out << "(" << T.translation().transpose().format(row) << ") m, quaternion x y z w ("
        << q.coeffs().transpose().format(row) << ")";
    return out.str();
  };
  constexpr double kSame = 1e-3;  // m and, nearly, rad
  if (T_BA.isApprox(Eigen::Isometry3d::Identity())) {
    T_BA = *stated;
    notes.push_back(topic + ": placed in '" + body + "' by " + kStaticTopic + ", " + text(*stated));
  } else if (!(T_BA.matrix() - stated->matrix()).isZero(kSame)) {
    notes.push_back(topic + ": caution: " + kStaticTopic + " places it in '" + body + "' at " + text(*stated) +
                    ", but given was " + text(T_BA) + ", which holds");
  }
}

sim::ImuRecord read_imu(const Bag& bag, const StaticFrames& frames, const std::string& topic, const BagReading& reading,
                        std::vector<std::string>& notes) {
  sim::ImuRecord imu = without_readings(reading.imu);
  imu.name = sensor_name(topic);
  std::string frame;
  bag.read<ros::Imu>(topic, [&](const ros::Imu& message, const std::string& where) {
    add_reading(where, stamp_of(message.header), Eigen::Vector3d::Map(message.angular_velocity.data()),
                scale_of(reading.accel_unit) * Eigen::Vector3d::Map(message.linear_acceleration.data()), imu);
    frame = message.header.frame_id;
  });
  const std::string where = bag.place + ": topic " + topic;
  finish_readings(where, reading.accel_unit, imu);
  // messages are in rad/s by their definition, and not every driver keeps to it
  const std::string units = require_gravity_turns(where, imu, GyroUnit::rad_s);
  if (!units.empty()) notes.push_back(topic + ": " + units);
  place_sensor(bag, frames, topic, frame, imu.T_BI, notes);
  return imu;
}

/// What the headers of a topic's clouds say.
struct CloudHeaders {
  std::vector<std::int64_t> stamps;
  std::string frame;
  /// A map, or points that somebody has moved there.
  bool in_world() const { return frame == "world" || frame == "map" || frame == "odom"; }
};

CloudHeaders read_headers(const Bag& bag, const std::string& topic) {
  CloudHeaders out;
  bag.read<ros::PointCloud2>(topic, [&](const ros::PointCloud2& message, const std::string&) {
    out.stamps.push_back(stamp_of(message.header));
    out.frame = message.header.frame_id;
  });
  if (out.frame.starts_with('/')) out.frame.erase(0, 1);
  return out;
}

sim::LidarRecord read_lidar(const Bag& bag, const StaticFrames& frames, const std::string& topic,
                            const CloudHeaders& headers, const BagReading& reading, std::vector<std::string>& notes) {
  SweepReading sweeps = reading.sweeps;
  sweeps.device.name = sensor_name(topic);
  const std::int64_t given_ns = sweeps.device.sweep_period_ns;
  SweepBuilder builder(std::move(sweeps), given_ns > 0 ? given_ns : median_step_ns(headers.stamps));
  bag.read<ros::PointCloud2>(topic, [&](const ros::PointCloud2& message, const std::string& where) {
    builder.add(stamp_of(message.header), cloud_of(message, where), where);
  });
  sim::LidarRecord lidar = builder.finish(bag.place + ": topic " + topic, notes);
  place_sensor(bag, frames, topic, headers.frame, lidar.T_BL, notes);
  return lidar;
}

template <class Message>
std::vector<ReferencePose> read_poses(const Bag& bag, const std::string& topic) {
  std::vector<ReferencePose> poses;
  bag.read<Message>(topic, [&](const Message& message, const std::string& where) {
    ReferencePose pose{stamp_of(message.header), Eigen::Vector3d::Map(message.position.data()), {}};
    pose.q_WA.coeffs() = Eigen::Vector4d::Map(message.orientation_xyzw.data());
    if (std::string problem = problem_of(pose, poses.empty() ? nullptr : &poses.back()); !problem.empty())
      throw BadInput(where + ": " + problem);
    poses.push_back(pose);
  });
  return poses;
}

std::vector<ReferencePose> reference_poses(const Bag& bag, const std::string& topic) {
  const std::string type = bag.topic(topic).type;
  if (type == kOdometry) return read_poses<ros::Odometry>(bag, topic);
  if (type == kPose) return read_poses<ros::PoseStamped>(bag, topic);
  throw BadInput(bag.place + ": topic '" + topic + "' is of type " + type + ", must be " + kOdometry + " or " + kPose);
}

/// Sensors that never saw the same moment have no common clock, or nothing in common.
void require_one_clock(const sim::Sensors& sensors, const std::filesystem::path& path) {
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
    spans.push_back({lidar.name, lidar.sweep_start_ns.front(), lidar.sweep_start_ns.back()});
  }
  for (const Span& early : spans) {
    for (const Span& late : spans) {
      if (late.first_ns <= early.last_ns) continue;
      throw BadInput(path.string() + ": the clocks of '" + early.name + "' and '" + late.name +
                     "' do not meet: one ends " +
                     std::to_string((static_cast<double>(late.first_ns) - static_cast<double>(early.last_ns)) * 1e-9) +
                     " s before the other begins");
    }
  }
}

Imported import_bag(BagReader& reader, const std::filesystem::path& path, const BagReading& reading) {
  const Bag bag{reader, path.string(), reader.topics()};
  const StaticFrames frames = read_frames(bag);
  Imported out;
  for (const std::string& topic : bag.chosen(reading.imu_topics, kImu))
    out.sensors.imus.push_back(read_imu(bag, frames, topic, reading, out.notes));
  for (const std::string& topic : bag.chosen(reading.lidar_topics, kCloud)) {
    const CloudHeaders headers = read_headers(bag, topic);
    if (reading.lidar_topics.empty() && headers.in_world()) {
      out.notes.push_back(topic + ": its points lie in '" + headers.frame + "', in no sensor's frame: left out");
      continue;
    }
    out.sensors.lidars.push_back(read_lidar(bag, frames, topic, headers, reading, out.notes));
  }
  if (out.sensors.imus.empty() && out.sensors.lidars.empty()) {
    throw BadInput(path.string() + ": holds no topic of type " + kImu + " or " + kCloud + " among " +
                   std::to_string(bag.topics.size()));
  }
  out.info.attribution = "imported from " + path.filename().string();
  require_one_clock(out.sensors, path);
  start_clock(out);
  if (!reading.reference_topic.empty()) {
    attach_poses(out, reference_poses(bag, reading.reference_topic), reading.reference_of_body,
                 path.string() + ": topic " + reading.reference_topic);
  }
  return out;
}

}  // namespace

Imported import_ros1_bag(const std::filesystem::path& file, const BagReading& reading) {
  return import_bag(*open_ros1_bag(file), file, reading);
}

Imported import_ros2_bag(const std::filesystem::path& path, const BagReading& reading) {
  return import_bag(*open_ros2_bag(path), path, reading);
}

Imported import_mcap(const std::filesystem::path& file, const BagReading& reading) {
  return import_bag(*open_mcap({file}), file, reading);
}

}  // namespace tumble::scenarios
