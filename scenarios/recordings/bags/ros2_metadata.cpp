// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/ros2_metadata.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>

#include "scenarios/recordings/bags/ros2_definitions.hpp"
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

}  // namespace tumble::scenarios
