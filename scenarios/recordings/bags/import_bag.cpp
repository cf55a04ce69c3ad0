// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_clouds.hpp"
#include "scenarios/recordings/bags/bag_reference.hpp"
#include "scenarios/recordings/bags/bag_stamps.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"
#include "scenarios/recordings/clouds/sweep_stamps.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/tables/imu_readings.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

constexpr const char* kImu = "sensor_msgs/Imu";
constexpr const char* kCloud = "sensor_msgs/PointCloud2";
constexpr const char *kTransforms = "tf2_msgs/TFMessage", *kOldTransforms = "tf/tfMessage";
constexpr const char* kStaticTopic = "/tf_static";
constexpr const char* kNoMessage = ": the topic is declared but has no messages; it is left out";
/// Differences between header and record stamps above this value are noted.
constexpr double kClocksApart_s = 1e-3;
/// Points that are later than their record by more than this value are noted; smaller differences are normal between
/// the clocks of two computers.
constexpr double kAhead_s = 0.01;

bool is_imu_type(const std::string& type) {
  return type == kImu;
}
bool is_cloud_type(const std::string& type) {
  return type == kCloud || is_livox_type(type);
}

/// Converts a topic to a sensor name: "/imu/data" to imu_data, "/lidar/points" to lidar.
std::string sensor_name(std::string topic) {
  while (topic.starts_with('/')) topic.erase(0, 1);
  if (topic.ends_with("/points")) topic.resize(topic.size() - 7);
  std::replace(topic.begin(), topic.end(), '/', '_');
  return topic;
}

StaticFrames read_frames(const OpenedBag& bag) {
  StaticFrames frames;
  for (const BagTopic& topic : bag.topics) {
    if (!topic.name.ends_with(kStaticTopic) || (topic.type != kTransforms && topic.type != kOldTransforms)) continue;
    bag.read<ros::TFMessage>(topic.name, [&](const ros::TFMessage& message, const MessageOrigin& origin) {
      for (const ros::TransformStamped& each : message.transforms) frames.add(each, origin.where);
    });
  }
  frames.require_no_ring(bag.place + ": topic " + kStaticTopic);
  return frames;
}

/// Returns the unit of the specific force. If the caller states no unit and the readings are in g, converts the
/// readings to m/s^2.
AccelUnit take_in_g(const std::string& topic, const BagReading& reading, sim::ImuRecord& imu,
                    std::vector<std::string>& notes) {
  if (reading.accel_unit || !is_in_g(imu)) return reading.accel_unit.value_or(AccelUnit::m_s2);
  for (Eigen::Vector3d& force : imu.accel_m_s2) force *= scale_of(AccelUnit::g);
  notes.push_back(
      fmt::format("{}: caution: the message definition requires m/s^2, but the magnitude at rest is 1, so it is read "
                  "in g (set '--accel-unit m/s^2' to use the definition)",
                  topic));
  return AccelUnit::g;
}

std::string repeats_text(std::size_t repeated) {
  if (repeated == 0) return "";
  return "number of duplicate messages (same stamp and content) that were read once: " + std::to_string(repeated);
}

sim::ImuRecord read_imu(const OpenedBag& bag, SensorPlaces& places, const std::string& topic, const BagReading& reading,
                        std::vector<std::string>& notes) {
  sim::ImuRecord imu = without_readings(reading.imu);
  imu.name = sensor_name(topic);
  std::string frame;
  BagStamps stamps(reading.stamps);
  const double force_scale = scale_of(reading.accel_unit.value_or(AccelUnit::m_s2));
  ros::Imu before;
  std::size_t repeated = 0;
  bag.read<ros::Imu>(topic, [&](const ros::Imu& message, const MessageOrigin& origin) {
    if (stamps.repeats(stamp_of(message.header)) && message.angular_velocity == before.angular_velocity &&
        message.linear_acceleration == before.linear_acceleration) {
      ++repeated;
      return;
    }
    add_reading(origin.where, stamps.take(stamp_of(message.header), origin.record_ns, origin.where),
                scale_of(reading.gyro_unit) * Eigen::Vector3d::Map(message.angular_velocity.data()),
                force_scale * Eigen::Vector3d::Map(message.linear_acceleration.data()), imu);
    frame = without_slash(message.header.frame_id);
    before = message;
  });
  const std::string where = bag.place + ": topic " + topic;
  if (imu.time_ns.empty() && reading.imu_topics.empty()) return imu;  // the topic has no messages
  const AccelUnit accel_unit = take_in_g(topic, reading, imu, notes);
  finish_readings(where, accel_unit, imu);
  // Messages should be in rad/s by definition, but not every driver conforms to the definition.
  const std::string evened = even_out_stamps(imu);
  const std::string units = rates_text(where, imu, reading.gyro_unit);
  for (const std::string& remark : {evened, gaps_text(imu), units, stamps.remark(), repeats_text(repeated)}) {
    if (!remark.empty()) notes.push_back(topic + ": " + remark);
  }
  places.place(topic, frame, "--lever-arm", reading.imu_placed, imu.T_BI, notes);
  return imu;
}

/// Information about the clouds of a topic from a first pass that does not read points.
struct CloudHeaders {
  std::vector<std::int64_t> stamps;  ///< sweep starts
  std::int64_t period_ns = 0;        ///< stated, or the median step of the stamps
  std::vector<bool> repeats;         ///< per message: true for a duplicate of the previous one
  std::string remark;
  bool follow_records = true;  ///< the records appear to use the same clock and lie after the stamps
  std::string frame;
  /// Returns true if the topic was not chosen by the caller and its frame is not a sensor's frame: a map, or points
  /// that are already transformed.
  bool left_out(const BagReading& reading) const {
    return reading.lidar_topics.empty() && (frame == "world" || frame == "map" || frame == "odom");
  }
};

/// Calls `take(message, origin)` for each cloud of the topic, of either type.
template <class Take>
void read_clouds(const OpenedBag& bag, const std::string& topic, Take&& take) {
  if (is_livox_type(bag.topic(topic).type)) return bag.read<ros::LivoxCustomMsg>(topic, take);
  bag.read<ros::PointCloud2>(topic, take);
}

CloudHeaders read_headers(const OpenedBag& bag, const std::string& topic, const BagReading& reading) {
  CloudHeaders out;
  BagStamps stamps(reading.stamps);
  std::uint64_t before = 0;
  read_clouds(bag, topic, [&](const auto& message, const MessageOrigin& origin) {
    out.frame = without_slash(message.header.frame_id);
    if (out.left_out(reading)) return;  // a map may have constant stamps
    const std::uint64_t now = content_of(message);
    out.repeats.push_back(stamps.repeats(stamp_of(message.header)) && now == before);
    before = now;
    if (!out.repeats.back())
      out.stamps.push_back(stamps.take(stamp_of(message.header), origin.record_ns, origin.where));
  });
  const std::int64_t given_ns = reading.sweeps.device.sweep_period_ns;
  out.period_ns = given_ns > 0 ? given_ns : median_step_ns(out.stamps);
  out.remark = stamps.remark();
  const auto repeated = static_cast<std::size_t>(std::count(out.repeats.begin(), out.repeats.end(), true));
  if (repeated > 0) out.remark += (out.remark.empty() ? "" : "; ") + repeats_text(repeated);
  out.follow_records = !stamps.other_clock();
  if (reading.stamps == StampSource::record) {
    for (std::int64_t& stamp : out.stamps) stamp -= out.period_ns;
    out.remark +=
        fmt::format("{}assumption: each sweep starts {} s before its record stamp", out.remark.empty() ? "" : "; ",
                    std::to_string(1e-9 * static_cast<double>(out.period_ns)));
  }
  return out;
}

/// Points that are later than their own record cannot have been measured yet, so their times count from another start
/// than the stamp.
void note_points_to_come(const std::string& topic, const BuiltSweeps& built, const std::vector<std::int64_t>& records,
                         std::vector<std::string>& notes) {
  std::vector<double> ahead_s;
  for (std::size_t k = 0; k < std::min(records.size(), built.last_point_ns.size()); ++k)
    ahead_s.push_back(1e-9 * static_cast<double>(built.last_point_ns[k] - records[k]));
  if (ahead_s.empty()) return;
  const double middle_s = upper_median(std::move(ahead_s));
  if (middle_s < kAhead_s) return;
  notes.push_back(
      fmt::format("{}: caution: the last points of a sweep, by their times after the stamp, are {} s later than the "
                  "record stamp; the stamp may be the end of the sweep. It is read as the start (set '--stamps record' "
                  "to start each sweep one period before its record stamp)",
                  topic, std::to_string(middle_s)));
}

BuiltSweeps read_lidar(const OpenedBag& bag, SensorPlaces& places, const std::string& topic,
                       const CloudHeaders& headers, const BagReading& reading, std::vector<std::string>& notes) {
  SweepReading sweeps = reading.sweeps;
  sweeps.device.name = sensor_name(topic);
  SweepBuilder builder(std::move(sweeps), headers.period_ns);
  double clocks_apart_s = 0.0;
  std::size_t number = 0, read = 0;
  std::vector<std::int64_t> records;
  read_clouds(bag, topic, [&]<class Message>(const Message& message, const MessageOrigin& origin) {
    if (read == headers.repeats.size()) throw BadInput(origin.where + ": uses another frame than the previous message");
    if (headers.repeats[read++]) return;
    if constexpr (std::is_same_v<Message, ros::LivoxCustomMsg>) {
      const double apart_ns = static_cast<double>(message.timebase) - static_cast<double>(stamp_of(message.header));
      clocks_apart_s = std::max(clocks_apart_s, 1e-9 * std::abs(apart_ns));
    }
    records.push_back(origin.record_ns);
    builder.add(headers.stamps[number++], cloud_of(message, origin.where), origin.where);
  });
  BuiltSweeps built = builder.finish(bag.place + ": topic " + topic, notes);
  if (!headers.remark.empty()) notes.push_back(topic + ": " + headers.remark);
  if (reading.stamps == StampSource::header && headers.follow_records)
    note_points_to_come(topic, built, records, notes);
  if (clocks_apart_s > kClocksApart_s) {
    notes.push_back(
        fmt::format("{}: caution: the messages' timebase and their header stamps differ by up to {} s; point times are "
                    "counted from the header stamps",
                    topic, std::to_string(clocks_apart_s)));
  }
  places.place(topic, headers.frame, "--T-body-lidar", reading.lidar_placed, built.lidar.T_BL, notes);
  return built;
}

/// Notes topics with raw lidar packets.
void note_packets(const OpenedBag& bag, std::vector<std::string>& notes) {
  for (const BagTopic& topic : bag.topics) {
    const auto has = [&](const char* word) { return topic.type.find(word) != std::string::npos; };
    if (!has("Packet") && !has("packet") && !has("VelodyneScan") && !has("PandarScan")) continue;
    notes.push_back(
        fmt::format("{}: caution: raw packets ({}) are not read; convert them to points with the lidar's driver",
                    topic.name, topic.type));
  }
}

/// Throws BadInput if the sensors do not overlap in time, and thus have no common clock.
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
      throw BadInput(
          fmt::format("{}: the time ranges of '{}' and '{}' do not overlap: one ends {} s before the other begins{}",
                      path.string(), early.name, late.name,
                      std::to_string((static_cast<double>(late.first_ns) - static_cast<double>(early.last_ns)) * 1e-9),
                      by_headers ? "; set '--stamps record' to use the record stamps" : ""));
    }
  }
}

/// Rethrows an error of an automatically chosen topic; if there are other topics, adds advice how to skip the faulty
/// topic.
[[noreturn]] void fail_of_several(const BadInput& error, const char* option) {
  throw BadInput(std::string(error.what()) + " (" + option + " selects which topics are read)");
}

void add_imus(const OpenedBag& bag, SensorPlaces& places, const BagReading& reading, Imported& out) {
  const std::vector<std::string> topics = bag.chosen(reading.imu_topics, is_imu_type, kImu);
  for (const std::string& topic : topics) {
    try {
      sim::ImuRecord imu = read_imu(bag, places, topic, reading, out.notes);
      if (imu.time_ns.empty()) {
        out.notes.push_back(topic + kNoMessage);
        continue;
      }
      out.sensors.imus.push_back(std::move(imu));
    } catch (const BadInput& error) {
      if (topics.size() < 2 || !reading.imu_topics.empty()) throw;
      fail_of_several(error, "--imu-topic");
    }
  }
  if (out.sensors.imus.size() > 1 && reading.imu_topics.empty())
    out.notes.push_back("'" + out.sensors.imus.front().name +
                        "' is the primary IMU because its topic comes first (set --imu-topic to choose another)");
}

void add_lidars(const OpenedBag& bag, SensorPlaces& places, const BagReading& reading, Imported& out) {
  for (const std::string& topic : bag.chosen(reading.lidar_topics, is_cloud_type, kCloud)) {
    const CloudHeaders headers = read_headers(bag, topic, reading);
    if (headers.left_out(reading)) {
      out.notes.push_back(
          fmt::format("{}: its points are in frame '{}', which is not the frame of a sensor; they are left out", topic,
                      headers.frame));
    } else if (headers.stamps.empty() && reading.lidar_topics.empty()) {
      out.notes.push_back(topic + kNoMessage);
    } else {
      add_lidar(out, read_lidar(bag, places, topic, headers, reading, out.notes));
    }
  }
}

Imported import_bag(BagReader& reader, const std::filesystem::path& path, const BagReading& reading) {
  const OpenedBag bag{reader, path.string(), reader.topics()};
  const StaticFrames frames = read_frames(bag);
  Imported out;
  for (const std::string& remark : frames.remarks()) out.notes.push_back(std::string(kStaticTopic) + ": " + remark);
  SensorPlaces places(frames, bag.place + ": topic " + kStaticTopic);
  add_imus(bag, places, reading, out);
  add_lidars(bag, places, reading, out);
  note_packets(bag, out.notes);
  if (out.sensors.imus.empty() && out.sensors.lidars.empty()) {
    throw BadInput(fmt::format("{}: has no topic of type {}, {} or CustomMsg with messages; number of topics: {}",
                               path.string(), kImu, kCloud, bag.topics.size()));
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
