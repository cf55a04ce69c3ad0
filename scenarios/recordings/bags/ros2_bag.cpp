// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <SQLiteCpp/SQLiteCpp.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <set>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/packed.hpp"
#include "scenarios/recordings/bags/ros2_metadata.hpp"
#include "scenarios/recordings/clouds/import_sweeps.hpp"
#include "scenarios/recordings/lower_extension.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

[[noreturn]] void fail_at(const path& place, const std::string& what) {
  throw BadInput(place.string() + ": " + what);
}

class Ros2BagWriter : public BagWriter {
 public:
  explicit Ros2BagWriter(const path& folder) : folder_(folder) {
    output_.emplace(folder);
    const std::string name = std::filesystem::weakly_canonical(folder).filename().string();
    file_ = folder / ((name.empty() ? "recording" : name) + "_0.db3");
    summary_ = {"sqlite3", file_.filename().string()};
    part_.emplace(file_);
    guarded([&] {
      database_ = std::make_unique<SQLite::Database>(part_->unfinished().string(), SQLite::OPEN_READWRITE);
      database_->exec("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF");
      database_->exec(
          "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
          "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);"
          "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, serialization_format "
          "TEXT "
          "NOT NULL, offered_qos_profiles TEXT NOT NULL, type_description_hash TEXT NOT NULL);"
          "CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL, encoding TEXT NOT NULL, "
          "encoded_message_definition TEXT NOT NULL, type_description_hash TEXT NOT NULL);"
          "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, data "
          "BLOB NOT NULL);"
          "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
          "INSERT INTO schema VALUES (4, 'iron')");
      database_->exec("BEGIN");
    });
  }
  ~Ros2BagWriter() override {
    insert_.reset();
    database_.reset();
  }
  bool begin_with(const std::vector<BagTopic>& topics) override {
    guarded([&] {
      for (const BagTopic& topic : topics) number_of(topic);
    });
    return true;
  }
  void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) override {
    insert({topic, ros::type_of(message)}, stamp_ns, ros::to_cdr(message));
  }
  void finish() override {
    guarded([&] {
      insert_.reset();
      database_->exec("COMMIT");
      database_.reset();
    });
    part_->move_into_place();
    replace_file(folder_ / "metadata.yaml", ros2_metadata(summary_));
    output_->keep();
  }

 private:
  template <class Call>
  void guarded(Call&& call) {
    try {
      call();
    } catch (const std::exception& error) {
      fail_at(file_, std::string("cannot be written: ") + error.what());
    }
  }

  std::int64_t number_of(const BagTopic& topic) {
    const std::size_t known = summary_.topics.size();
    const std::size_t place = summary_.place_of(topic);
    if (place == known) {
      if (defined_.insert(topic.type).second) define(topic.type);
      SQLite::Statement statement(*database_, "INSERT INTO topics VALUES (?, ?, ?, 'cdr', ?, '')");
      statement.bind(1, static_cast<std::int64_t>(place) + 1);
      statement.bind(2, topic.name);
      statement.bind(3, ros2_type(topic.type));
      statement.bind(4, ros2_qos(topic.name));
      statement.exec();
    }
    return static_cast<std::int64_t>(place) + 1;
  }

  void define(const std::string& type) {
    SQLite::Statement statement(
        *database_,
        "INSERT INTO message_definitions (topic_type, encoding, encoded_message_definition, type_description_hash) "
        "VALUES (?, 'ros2msg', ?, '')");
    statement.bind(1, ros2_type(type));
    statement.bind(2, ros2_definition(type));
    statement.exec();
  }

  void insert(const BagTopic& topic, std::int64_t stamp_ns, const ros::Bytes& bytes) {
    guarded([&] {
      const std::int64_t number = number_of(topic);
      summary_.count(topic, stamp_ns);
      if (!insert_) {
        insert_ = std::make_unique<SQLite::Statement>(
            *database_, "INSERT INTO messages (topic_id, timestamp, data) VALUES (?, ?, ?)");
      }
      insert_->bind(1, number);
      insert_->bind(2, stamp_ns);
      insert_->bindNoCopy(3, bytes.data(), static_cast<int>(bytes.size()));
      insert_->exec();
      insert_->reset();
    });
  }

  path folder_, file_;
  std::optional<OutputFolder> output_;
  std::optional<OutputFile> part_;  ///< destroyed before the folder
  std::unique_ptr<SQLite::Database> database_;
  std::unique_ptr<SQLite::Statement> insert_;
  Ros2Summary summary_;
  std::set<std::string> defined_;
};

/// `kind` is the storage format, "sqlite3" or "mcap". `packed` is "file" or "message" for a bag that is compressed per
/// file or per message, and "" without compression.
struct StoredBag {
  std::string kind = "sqlite3";
  std::vector<path> files;
  std::string packed = {};
  std::string note = {};
};

std::string packed_by(const YAML::Node& root, const path& metadata) {
  const auto text = [&](const char* key) {
    std::string out = root[key] ? root[key].as<std::string>("") : "";
    std::transform(out.begin(), out.end(), out.begin(), [](unsigned char c) { return std::tolower(c); });
    return out;
  };
  const std::string format = text("compression_format"), mode = text("compression_mode");
  if (format.empty() || mode == "none") return "";
  if (format != "zstd" || (mode != "file" && mode != "message"))
    fail_at(metadata, fmt::format("the bag has the compression format '{}' and mode '{}'; supported: zstd with mode "
                                  "file or message (convert the bag with 'ros2 bag convert')",
                                  format, mode));
  return mode;
}

void add_unlisted(const path& folder, StoredBag& bag) {
  const auto stem = [](const path& file) { return stem_of(file.extension() == ".zstd" ? file.stem() : file); };
  const path& listed = bag.files.front();
  std::set<path> found;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const path& file = entry.path();
    if (file.extension() == listed.extension() && stem(file) == stem(listed) &&
        std::ranges::find(bag.files, file) == bag.files.end())
      found.insert(file);
  }
  if (found.empty()) return;
  bag.note =
      "caution: the folder contains bag files that metadata.yaml does not list; the import reads these files as parts "
      "of the bag:";
  for (const path& file : found) bag.note += " " + file.filename().string();
  bag.files.insert(bag.files.end(), found.begin(), found.end());
}

StoredBag parts_in(const path& folder) {
  std::set<path> parts;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string ending = lower_extension(entry.path());
    if (ending == ".mcap" || ending == ".db3") parts.insert(entry.path());
  }
  if (parts.empty()) fail_at(folder, "the folder has no metadata.yaml, so it is not a ROS 2 bag");
  StoredBag out{.kind = lower_extension(*parts.begin()) == ".mcap" ? "mcap" : "sqlite3", .files = {*parts.begin()}};
  add_unlisted(folder, out);
  if (out.files.size() < parts.size())
    fail_at(folder,
            "the folder has no metadata.yaml, and the names of its bag files differ in more than a number; create "
            "metadata.yaml with 'ros2 bag reindex', or import one bag at a time");
  out.note =
      "caution: the folder of the bag has no metadata.yaml; the import reads all its bag files as parts of one "
      "recording";
  return out;
}

StoredBag storage_of(const path& bag) {
  if (!std::filesystem::is_directory(bag)) {
    const bool packed = lower_extension(bag) == ".zstd";
    const path name = packed ? bag.stem() : bag;
    return {
        .kind = lower_extension(name) == ".mcap" ? "mcap" : "sqlite3", .files = {bag}, .packed = packed ? "file" : ""};
  }
  const path metadata = bag / "metadata.yaml";
  if (!std::filesystem::is_regular_file(metadata)) return parts_in(bag);
  StoredBag out;
  try {
    const YAML::Node root = YAML::LoadFile(metadata.string())["rosbag2_bagfile_information"];
    out.kind = root["storage_identifier"].as<std::string>();
    if (out.kind != "sqlite3" && out.kind != "mcap")
      fail_at(metadata,
              fmt::format("the storage_identifier in metadata.yaml is '{}'; it must be sqlite3 or mcap", out.kind));
    out.packed = packed_by(root, metadata);
    for (const YAML::Node& each : root["relative_file_paths"]) {
      const path name = path(each.as<std::string>()).filename();  // only files within the folder
      out.files.push_back(bag / name);
      if (!std::filesystem::exists(out.files.back()))
        fail_at(out.files.back(),
                "the file does not exist, although metadata.yaml lists it; copy the file into the "
                "folder, or remove its line from metadata.yaml");
    }
  } catch (const YAML::Exception& error) {
    std::string what = error.what();
    std::replace(what.begin(), what.end(), '\n', ' ');
    fail_at(metadata, fmt::format("this file is not the metadata of a ROS 2 bag: {}", what));
  }
  if (out.files.empty()) fail_at(metadata, "relative_file_paths lists no file");
  add_unlisted(bag, out);
  return out;
}

class Ros2BagReader : public BagReader {
 public:
  explicit Ros2BagReader(std::vector<path> files) : files_(std::move(files)) {
    for (const path& file : files_) require_regular_file(file);
    if (files_.size() > 1) sort_files();
  }

  std::vector<BagTopic> topics() override {
    std::vector<BagTopic> topics;
    for_files([&](const path& file, SQLite::Database& database) {
      SQLite::Statement query(database, "SELECT name, type, serialization_format FROM topics ORDER BY id");
      while (query.executeStep()) {
        const std::string format = query.getColumn(2).getString();
        const BagTopic topic = {query.getColumn(0).getString(), ros1_type(query.getColumn(1).getString())};
        if (format != "cdr")
          fail_at(file, fmt::format("topic {} has the serialization format '{}'; it must be cdr", topic.name, format));
        const auto same = [&](const BagTopic& each) { return each.name == topic.name; };
        if (std::none_of(topics.begin(), topics.end(), same)) topics.push_back(topic);
      }
    });
    return topics;
  }

  void read(const std::string& topic, const Take& take) override {
    for_files([&](const path&, SQLite::Database& database) {
      SQLite::Statement query(
          database,
          "SELECT data, timestamp FROM messages WHERE topic_id IN (SELECT id FROM topics WHERE name = ?) ORDER "
          "BY timestamp, id");
      query.bind(1, topic);
      ros::Bytes bytes;
      while (query.executeStep()) {
        const SQLite::Column blob = query.getColumn(0);
        const auto* first = static_cast<const std::uint8_t*>(blob.getBlob());
        bytes.assign(first, first + blob.getBytes());
        take(bytes, query.getColumn(1).getInt64());
      }
    });
  }

  bool cdr(const std::string&) const override { return true; }

 private:
  void sort_files() {
    std::map<path, std::int64_t> first_ns;
    for_files([&](const path& file, SQLite::Database& database) {
      SQLite::Statement query(database, "SELECT MIN(timestamp) FROM messages");
      first_ns[file] = query.executeStep() && !query.getColumn(0).isNull() ? query.getColumn(0).getInt64() : INT64_MAX;
    });
    const auto earlier = [&](const path& a, const path& b) { return first_ns[a] < first_ns[b]; };
    if (std::is_sorted(files_.begin(), files_.end(), earlier)) return;
    std::stable_sort(files_.begin(), files_.end(), earlier);
    notes.emplace_back(kFilesSorted);
  }

  template <class Call>
  void for_files(Call&& call) {
    for (const path& file : files_) {
      try {
        SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
        call(file, database);
      } catch (const SQLite::Exception& error) {
        fail_at(file, fmt::format("the file cannot be read as a ROS 2 bag: {}", error.what()));
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
  const StoredBag storage = storage_of(bag);
  const auto open = [&](const std::vector<path>& files) -> std::unique_ptr<BagReader> {
    if (storage.kind == "mcap") return open_mcap(files);
    return std::make_unique<Ros2BagReader>(files);
  };
  const auto reader = [&]() -> std::unique_ptr<BagReader> {
    if (storage.packed == "file") return open_packed_files(storage.files, open);
    if (storage.packed == "message") return with_packed_messages(open(storage.files), bag.string());
    return open(storage.files);
  };
  std::unique_ptr<BagReader> out = reader();
  if (!storage.note.empty()) out->notes.push_back(storage.note);
  return out;
}

}  // namespace tumble::scenarios
