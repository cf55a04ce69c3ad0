// SPDX-License-Identifier: BSD-3-Clause
#include <SQLiteCpp/SQLiteCpp.h>
#include <unistd.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <sstream>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/ros2_definitions.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

[[noreturn]] void fail(const path& place, const std::string& what) {
  throw BadInput(place.string() + ": " + what);
}

struct TopicState {
  BagTopic topic;
  std::int64_t id = 0, messages = 0;
};

class Ros2BagWriter : public BagWriter {
 public:
  explicit Ros2BagWriter(const path& folder) : folder_(folder) {
    output_.emplace(folder);
    const std::string name = std::filesystem::weakly_canonical(folder).filename().string();
    file_ = folder / ((name.empty() ? "recording" : name) + "_0.db3");
    part_ = file_.string() + "." + std::to_string(getpid()) + ".part";
    guarded([&] {
      std::filesystem::remove(part_);
      database_ = std::make_unique<SQLite::Database>(part_.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
      database_->exec("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF");
      database_->exec(
          "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
          "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);"
          "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format "
          "TEXT "
          "NOT NULL, offered_qos_profiles TEXT NOT NULL);"
          "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data "
          "BLOB NOT NULL);"
          "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
          "INSERT INTO schema VALUES (3, 'humble')");
      database_->exec("BEGIN");
    });
  }
  ~Ros2BagWriter() override {
    insert_.reset();
    database_.reset();
    std::error_code ignored;
    std::filesystem::remove(part_, ignored);
  }
  void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) override {
    insert({topic, ros::type_of(message)}, stamp_ns, ros::to_cdr(message));
  }
  void finish() override {
    guarded([&] {
      insert_.reset();
      database_->exec("COMMIT");
      database_.reset();
      std::filesystem::rename(part_, file_);
    });
    replace_file(folder_ / "metadata.yaml", metadata());
    output_->keep();
  }

 private:
  template <class Call>
  void guarded(Call&& call) {
    try {
      call();
    } catch (const std::exception& error) {
      fail(file_, std::string("cannot be written: ") + error.what());
    }
  }

  TopicState& state_of(const BagTopic& topic) {
    const auto same = [&](const TopicState& each) { return each.topic.name == topic.name; };
    const auto found = std::find_if(topics_.begin(), topics_.end(), same);
    if (found != topics_.end()) return *found;
    topics_.push_back({topic, static_cast<std::int64_t>(topics_.size()) + 1, 0});
    SQLite::Statement statement(*database_, "INSERT INTO topics VALUES (?, ?, ?, 'cdr', ?)");
    statement.bind(1, topics_.back().id);
    statement.bind(2, topic.name);
    statement.bind(3, ros2_type(topic.type));
    statement.bind(4, ros2_qos(topic.name));
    statement.exec();
    return topics_.back();
  }

  void insert(const BagTopic& topic, std::int64_t stamp_ns, const ros::Bytes& bytes) {
    guarded([&] {
      TopicState& state = state_of(topic);
      if (!insert_) {
        insert_ = std::make_unique<SQLite::Statement>(
            *database_, "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)");
      }
      insert_->bind(1, state.id);
      insert_->bind(2, stamp_ns);
      insert_->bindNoCopy(3, bytes.data(), static_cast<int>(bytes.size()));
      insert_->exec();
      insert_->reset();
      ++state.messages;
      first_ns_ = std::min(first_ns_, stamp_ns);
      last_ns_ = std::max(last_ns_, stamp_ns);
    });
  }

  std::string metadata() const {
    std::int64_t all = 0;
    for (const TopicState& each : topics_) all += each.messages;
    const std::int64_t start = all > 0 ? first_ns_ : 0, duration = all > 0 ? last_ns_ - first_ns_ : 0;
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
    entry("storage_identifier", "sqlite3");
    times();
    out << YAML::Key << "topics_with_message_count" << YAML::Value << YAML::BeginSeq;
    for (const TopicState& each : topics_) {
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
    out << YAML::Key << "relative_file_paths" << YAML::Value << YAML::BeginSeq << file_.filename().string()
        << YAML::EndSeq << YAML::Key << "files" << YAML::Value << YAML::BeginSeq << YAML::BeginMap;
    entry("path", file_.filename().string());
    times();
    out << YAML::EndMap << YAML::EndSeq << YAML::EndMap << YAML::EndMap;
    return std::string(out.c_str()) + "\n";
  }

  path folder_, file_, part_;
  std::optional<OutputFolder> output_;
  std::unique_ptr<SQLite::Database> database_;
  std::unique_ptr<SQLite::Statement> insert_;
  std::vector<TopicState> topics_;
  std::int64_t first_ns_ = std::numeric_limits<std::int64_t>::max(), last_ns_ = 0;
};

/// The files of a bag, in order, and how they are stored: "sqlite3" or "mcap".
struct Storage {
  std::string kind = "sqlite3";
  std::vector<path> files;
};

Storage storage_of(const path& bag) {
  if (!std::filesystem::is_directory(bag)) return {bag.extension() == ".mcap" ? "mcap" : "sqlite3", {bag}};
  const path metadata = bag / "metadata.yaml";
  if (!std::filesystem::is_regular_file(metadata)) fail(bag, "holds no metadata.yaml: no ROS 2 bag");
  Storage out;
  try {
    const YAML::Node root = YAML::LoadFile(metadata.string())["rosbag2_bagfile_information"];
    out.kind = root["storage_identifier"].as<std::string>();
    if (out.kind != "sqlite3" && out.kind != "mcap")
      fail(metadata, "the storage is '" + out.kind + "', must be sqlite3 or mcap");
    if (root["compression_format"] && !root["compression_format"].as<std::string>("").empty())
      fail(metadata, "the bag is compressed ('ros2 bag convert' makes a plain one)");
    for (const YAML::Node& each : root["relative_file_paths"]) {
      const path name = path(each.as<std::string>()).filename();  // nothing leads out of the folder
      out.files.push_back(bag / name);
    }
  } catch (const YAML::Exception& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    fail(metadata, "no metadata of a ROS 2 bag: " + what);
  }
  if (out.files.empty()) fail(metadata, "relative_file_paths names no file");
  return out;
}

class Ros2BagReader : public BagReader {
 public:
  explicit Ros2BagReader(std::vector<path> files) : files_(std::move(files)) {
    for (const path& file : files_) {
      if (!std::filesystem::is_regular_file(file)) fail(file, "no such file");
    }
  }

  std::vector<BagTopic> topics() override {
    std::vector<BagTopic> topics;
    for_files([&](const path& file, SQLite::Database& database) {
      SQLite::Statement query(database, "SELECT name, type, serialization_format FROM topics ORDER BY id");
      while (query.executeStep()) {
        const std::string format = query.getColumn(2).getString();
        const BagTopic topic = {query.getColumn(0).getString(), ros1_type(query.getColumn(1).getString())};
        if (format != "cdr") fail(file, "topic " + topic.name + " is serialized as '" + format + "', must be cdr");
        const auto same = [&](const BagTopic& each) { return each.name == topic.name; };
        if (std::none_of(topics.begin(), topics.end(), same)) topics.push_back(topic);
      }
    });
    return topics;
  }

  void read(const std::string& topic, const std::function<void(ros::Bytes&)>& take) override {
    for_files([&](const path&, SQLite::Database& database) {
      SQLite::Statement query(
          database,
          "SELECT data FROM messages WHERE topic_id IN (SELECT id FROM topics WHERE name = ?) ORDER "
          "BY timestamp, id");
      query.bind(1, topic);
      ros::Bytes bytes;
      while (query.executeStep()) {
        const SQLite::Column blob = query.getColumn(0);
        const auto* first = static_cast<const std::uint8_t*>(blob.getBlob());
        bytes.assign(first, first + blob.getBytes());
        take(bytes);
      }
    });
  }

  bool cdr(const std::string&) const override { return true; }

 private:
  template <class Call>
  void for_files(Call&& call) {
    for (const path& file : files_) {
      try {
        SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
        call(file, database);
      } catch (const SQLite::Exception& error) {
        fail(file, std::string("cannot be read as a ROS 2 bag: ") + error.what());
      }
    }
  }
  std::vector<path> files_;
};

}  // namespace

std::unique_ptr<BagWriter> make_ros2_writer(const path& folder) {
  return std::make_unique<Ros2BagWriter>(folder);
}

std::unique_ptr<BagReader> open_ros2_bag(const path& bag) {
  Storage storage = storage_of(bag);
  if (storage.kind == "mcap") return open_mcap(storage.files);
  return std::make_unique<Ros2BagReader>(std::move(storage.files));
}

}  // namespace tumble::scenarios
