// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/ros2_metadata.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>

#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace {

class Ros2McapWriter : public BagWriter {
 public:
  explicit Ros2McapWriter(const std::filesystem::path& folder) : output_(folder) {
    const std::string name = std::filesystem::weakly_canonical(folder).filename().string();
    summary_ = {"mcap", (name.empty() ? "recording" : name) + "_0.mcap"};
    file_ = make_mcap_writer(folder / summary_.file);
  }
  bool begin_with(const std::vector<BagTopic>& topics) override {
    for (const BagTopic& topic : topics) summary_.place_of(topic);
    return file_->begin_with(topics);
  }
  void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) override {
    summary_.count({topic, ros::type_of(message)}, stamp_ns);
    file_->write(topic, stamp_ns, message);
  }
  void finish() override {
    file_->finish();
    replace_file(output_.path() / "metadata.yaml", ros2_metadata(summary_));
    output_.keep();
  }

 private:
  OutputFolder output_;
  Ros2Summary summary_;
  std::unique_ptr<BagWriter> file_;  ///< destroyed before the folder
};

}  // namespace

std::size_t Ros2Summary::place_of(const BagTopic& topic) {
  const auto same = [&](const Topic& each) { return each.topic.name == topic.name; };
  auto found = std::find_if(topics.begin(), topics.end(), same);
  if (found == topics.end()) found = topics.insert(topics.end(), {topic, 0});
  return static_cast<std::size_t>(found - topics.begin());
}

void Ros2Summary::count(const BagTopic& topic, std::int64_t stamp_ns) {
  const auto silent = [](const Topic& each) { return each.messages == 0; };
  const bool first = std::all_of(topics.begin(), topics.end(), silent);
  first_ns = first ? stamp_ns : std::min(first_ns, stamp_ns);
  last_ns = first ? stamp_ns : std::max(last_ns, stamp_ns);
  ++topics[place_of(topic)].messages;
}

std::string ros2_metadata(const Ros2Summary& bag) {
  std::int64_t all = 0;
  for (const Ros2Summary::Topic& each : bag.topics) all += each.messages;
  const std::int64_t start = all > 0 ? bag.first_ns : 0, duration = all > 0 ? bag.last_ns - bag.first_ns : 0;
  YAML::Emitter out;
  const auto entry = [&](const char* key, const auto& value) { out << YAML::Key << key << YAML::Value << value; };
  const auto times = [&] {
    out << YAML::Key << "duration" << YAML::Value << YAML::BeginMap;
    entry("nanoseconds", duration);
    out << YAML::EndMap << YAML::Key << "starting_time" << YAML::Value << YAML::BeginMap;
    entry("nanoseconds_since_epoch", start);
    out << YAML::EndMap;
    entry("message_count", all);
  };
  out << YAML::BeginMap << YAML::Key << "rosbag2_bagfile_information" << YAML::Value << YAML::BeginMap;
  entry("version", 5);
  entry("storage_identifier", bag.storage);
  times();
  out << YAML::Key << "topics_with_message_count" << YAML::Value << YAML::BeginSeq;
  for (const Ros2Summary::Topic& each : bag.topics) {
    out << YAML::BeginMap << YAML::Key << "topic_metadata" << YAML::Value << YAML::BeginMap;
    entry("name", each.topic.name);
    entry("type", ros2_type(each.topic.type));
    entry("serialization_format", "cdr");
    out << YAML::Key << "offered_qos_profiles" << YAML::Value << YAML::DoubleQuoted << ros2_qos(each.topic.name);
    out << YAML::EndMap;
    entry("message_count", each.messages);
    out << YAML::EndMap;
  }
  out << YAML::EndSeq;
  for (const char* key : {"compression_format", "compression_mode"})
    out << YAML::Key << key << YAML::Value << YAML::DoubleQuoted << "";
  out << YAML::Key << "relative_file_paths" << YAML::Value << YAML::BeginSeq << bag.file << YAML::EndSeq << YAML::Key
      << "files" << YAML::Value << YAML::BeginSeq << YAML::BeginMap;
  entry("path", bag.file);
  times();
  out << YAML::EndMap << YAML::EndSeq << YAML::EndMap << YAML::EndMap;
  return std::string(out.c_str()) + "\n";
}

std::unique_ptr<BagWriter> make_ros2_mcap_writer(const std::filesystem::path& folder) {
  return std::make_unique<Ros2McapWriter>(folder);
}

namespace {

const std::map<std::string, std::string>& definitions() {
  static const std::map<std::string, std::string> all = {
      {"builtin_interfaces/Time", "int32 sec\nuint32 nanosec\n"},
      {"std_msgs/Header", "builtin_interfaces/Time stamp\nstring frame_id\n"},
      {"geometry_msgs/Vector3", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Point", "float64 x\nfloat64 y\nfloat64 z\n"},
      {"geometry_msgs/Quaternion", "float64 x 0\nfloat64 y 0\nfloat64 z 0\nfloat64 w 1\n"},
      {"geometry_msgs/Pose", "geometry_msgs/Point position\ngeometry_msgs/Quaternion orientation\n"},
      {"geometry_msgs/PoseWithCovariance", "geometry_msgs/Pose pose\nfloat64[36] covariance\n"},
      {"geometry_msgs/Twist", "geometry_msgs/Vector3 linear\ngeometry_msgs/Vector3 angular\n"},
      {"geometry_msgs/TwistWithCovariance", "geometry_msgs/Twist twist\nfloat64[36] covariance\n"},
      {"geometry_msgs/Transform", "geometry_msgs/Vector3 translation\ngeometry_msgs/Quaternion rotation\n"},
      {"geometry_msgs/TransformStamped",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/Transform transform\n"},
      {"sensor_msgs/Imu",
       "std_msgs/Header header\ngeometry_msgs/Quaternion orientation\nfloat64[9] orientation_covariance\n"
       "geometry_msgs/Vector3 angular_velocity\nfloat64[9] angular_velocity_covariance\n"
       "geometry_msgs/Vector3 linear_acceleration\nfloat64[9] linear_acceleration_covariance\n"},
      {"sensor_msgs/PointField",
       "uint8 INT8=1\nuint8 UINT8=2\nuint8 INT16=3\nuint8 UINT16=4\nuint8 INT32=5\nuint8 UINT32=6\nuint8 FLOAT32=7\n"
       "uint8 FLOAT64=8\nstring name\nuint32 offset\nuint8 datatype\nuint32 count\n"},
      {"sensor_msgs/PointCloud2",
       "std_msgs/Header header\nuint32 height\nuint32 width\nsensor_msgs/PointField[] fields\nbool is_bigendian\n"
       "uint32 point_step\nuint32 row_step\nuint8[] data\nbool is_dense\n"},
      {"nav_msgs/Odometry",
       "std_msgs/Header header\nstring child_frame_id\ngeometry_msgs/PoseWithCovariance pose\n"
       "geometry_msgs/TwistWithCovariance twist\n"},
      {"tf2_msgs/TFMessage", "geometry_msgs/TransformStamped[] transforms\n"},
      {"rosgraph_msgs/Clock", "builtin_interfaces/Time clock\n"},
      // The message definition is from github.com/Livox-SDK/livox_ros_driver2.
      {"livox_ros_driver2/CustomPoint",
       "uint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\nuint8 reflectivity\nuint8 tag\nuint8 line\n"},
      {"livox_ros_driver2/CustomMsg",
       "std_msgs/Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\n"
       "livox_ros_driver2/CustomPoint[] points\n"}};
  return all;
}

void append_inner(const std::string& text, std::set<std::string>& there, std::string& out) {
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    const std::string type = word.substr(0, word.find('['));
    const auto found = definitions().find(type);
    if (found == definitions().end() || !there.insert(type).second) continue;
    out += std::string(80, '=') + "\nMSG: " + type + "\n" + found->second;
    append_inner(found->second, there, out);
  }
}

}  // namespace

std::string ros2_type(const std::string& type) {
  const std::size_t slash = type.find('/');
  return type.substr(0, slash) + "/msg" + type.substr(slash);
}

std::string ros1_type(std::string type) {
  const std::size_t middle = type.find("/msg/");
  if (middle != std::string::npos) type.erase(middle, 4);
  return type;
}

std::string ros2_definition(const std::string& type) {
  const auto found = definitions().find(type);
  if (found == definitions().end())
    throw std::logic_error(fmt::format("there is no message definition for type {}", type));
  std::set<std::string> there = {type};
  std::string out = found->second;
  append_inner(found->second, there, out);
  return out;
}

std::string ros2_qos(const std::string& topic) {
  if (topic != "/tf_static") return "";
  const std::string forever = "\n    sec: 9223372036\n    nsec: 854775807\n";
  // The value 1 in the enumerations of the ROS middleware means history "keep last", reliability "reliable", durability
  // "transient local", and liveliness "automatic".
  return "- history: 1\n  depth: 1\n  reliability: 1\n  durability: 1\n  deadline:" + forever +
         "  lifespan:" + forever + "  liveliness: 1\n  liveliness_lease_duration:" + forever +
         "  avoid_ros_namespace_conventions: false";
}

}  // namespace tumble::scenarios
