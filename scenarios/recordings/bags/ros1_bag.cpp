// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <console_bridge/console.h>
#include <geometry_msgs/TransformStamped.h>
#include <nav_msgs/Odometry.h>
#include <rosbag/bag.h>
#include <rosbag/view.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_msgs/Header.h>

#include <algorithm>
#include <boost/make_shared.hpp>
#include <exception>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/ros1_chunks.hpp"
#include "scenarios/recordings/lower_extension.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace {

struct TypedBytes {
  std::string type, md5sum, definition;
  ros::Bytes bytes;
};

}  // namespace

}  // namespace tumble::scenarios

namespace ros {
using tumble::scenarios::TypedBytes;
namespace message_traits {
template <>
struct MD5Sum<TypedBytes> {
  static const char* value(const TypedBytes& message) { return message.md5sum.c_str(); }
};
template <>
struct DataType<TypedBytes> {
  static const char* value(const TypedBytes& message) { return message.type.c_str(); }
};
template <>
struct Definition<TypedBytes> {
  static const char* value(const TypedBytes& message) { return message.definition.c_str(); }
};
}  // namespace message_traits
namespace serialization {
template <>
struct Serializer<TypedBytes> {
  template <class Stream>
  static void write(Stream& stream, const TypedBytes& message) {
    std::copy(message.bytes.begin(), message.bytes.end(), stream.advance(serializedLength(message)));
  }
  static std::uint32_t serializedLength(const TypedBytes& message) {
    return static_cast<std::uint32_t>(message.bytes.size());
  }
};
}  // namespace serialization
}  // namespace ros

namespace tumble::scenarios {

namespace {

class QuietBag {
 public:
  QuietBag() { console_bridge::noOutputHandler(); }
  ~QuietBag() { console_bridge::restorePreviousOutputHandler(); }
  QuietBag(const QuietBag&) = delete;
  QuietBag& operator=(const QuietBag&) = delete;
};

std::string without_line_ends(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

template <class Call>
auto guarded(const std::filesystem::path& path, const char* what, Call&& call) {
  const QuietBag quiet;
  try {
    return call();
  } catch (const BadInput&) {
    throw;
  } catch (const std::exception& error) {
    throw BadInput(path.string() + ": " + what + ": " + without_line_ends(error.what()));
  }
}

template <class RosMessage, class Message>
TypedBytes typed_as(const Message& message) {
  namespace traits = ::ros::message_traits;
  return {traits::DataType<RosMessage>::value(), traits::MD5Sum<RosMessage>::value(),
          traits::Definition<RosMessage>::value(), ros::to_ros1(message)};
}

TypedBytes typed(const ros::Imu& message) {
  return typed_as<sensor_msgs::Imu>(message);
}
TypedBytes typed(const ros::PointCloud2& message) {
  return typed_as<sensor_msgs::PointCloud2>(message);
}
TypedBytes typed(const ros::Odometry& message) {
  return typed_as<nav_msgs::Odometry>(message);
}
TypedBytes typed(const ros::TransformStamped& message) {
  return typed_as<geometry_msgs::TransformStamped>(message);
}
// The build lacks the headers of three message types, so the MD5 checksums of these types are constants.
TypedBytes typed(const ros::TFMessage& message) {
  const std::string inner = ::ros::message_traits::Definition<geometry_msgs::TransformStamped>::value();
  return {ros::type_of(message), "94810edda583a504dfda3829e70d7eec",
          "geometry_msgs/TransformStamped[] transforms\n" + std::string(80, '=') +
              "\nMSG: geometry_msgs/TransformStamped\n" + inner,
          ros::to_ros1(message)};
}
TypedBytes typed(const ros::LivoxCustomMsg& message) {
  const std::string header = ::ros::message_traits::Definition<std_msgs::Header>::value();
  const std::string bar = std::string(80, '=') + "\nMSG: ";
  return {ros::kLivoxRos1, "e4d6829bdfe657cb6c21a746c86b21a6",
          "Header header\nuint64 timebase\nuint32 point_num\nuint8 lidar_id\nuint8[3] rsvd\nCustomPoint[] points\n" +
              bar + "std_msgs/Header\n" + header + bar +
              "livox_ros_driver/CustomPoint\nuint32 offset_time\nfloat32 x\nfloat32 y\nfloat32 z\n"
              "uint8 reflectivity\nuint8 tag\nuint8 line\n",
          ros::to_ros1(message)};
}
TypedBytes typed(const ros::Clock& message) {
  return {ros::type_of(message), "a9c97c1d230cfc112e270351a944ee47", "time clock\n", ros::to_ros1(message)};
}

class Ros1BagWriter : public BagWriter {
 public:
  explicit Ros1BagWriter(const std::filesystem::path& file)
      : file_(file), output_(file), bag_(std::make_unique<rosbag::Bag>()) {
    guarded_write([&] { bag_->open(output_.unfinished().string(), rosbag::bagmode::Write); });
  }
  ~Ros1BagWriter() override { give_up(); }
  bool begin_with(const std::vector<BagTopic>&) override { return false; }
  void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) override {
    ::ros::Time time;
    time.fromNSec(static_cast<std::uint64_t>(stamp_ns));
    const TypedBytes bytes = std::visit([](const auto& each) { return typed(each); }, message);
    guarded_write([&] { bag_->write(topic, time, bytes, connection_of(topic, bytes)); });
  }
  void finish() override {
    guarded_write([&] { bag_->close(); });
    output_.move_into_place();
  }

 private:
  boost::shared_ptr<::ros::M_string> connection_of(const std::string& topic, const TypedBytes& message) {
    if (topic != "/tf_static") return nullptr;
    return boost::make_shared<::ros::M_string>(::ros::M_string{{"topic", topic},
                                                               {"type", message.type},
                                                               {"md5sum", message.md5sum},
                                                               {"message_definition", message.definition},
                                                               {"latching", "1"}});
  }

  template <class Call>
  void guarded_write(Call&& call) {
    try {
      guarded(file_, "cannot be written", call);
    } catch (const BadInput&) {
      give_up();
      throw;
    }
  }

  /// If closing the bag fails (full disk), the destructor of librosbag's bag object would end the program, so give_up()
  /// does not destroy the bag object.
  void give_up() {
    if (!bag_) return;
    const QuietBag quiet;
    try {
      bag_->close();
      bag_.reset();
    } catch (const std::exception&) {
      static_cast<void>(bag_.release());
    }
  }

  std::filesystem::path file_;
  OutputFile output_;
  std::unique_ptr<rosbag::Bag> bag_;
};

constexpr double kPartsApart_s = 60.0;

class Ros1BagReader : public BagReader {
 public:
  explicit Ros1BagReader(const std::filesystem::path& path) : path_(path) {
    if (!std::filesystem::is_directory(path)) {
      add(path);
      return;
    }
    std::set<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(path)) {
      if (lower_extension(entry.path()) == ".bag") files.insert(entry.path());
    }
    if (files.empty())
      throw BadInput(
          fmt::format("{}: the folder contains no ROS 1 bag, which is a file that ends in .bag", path.string()));
    std::string names;
    for (const std::filesystem::path& file : files) {
      add(file);
      names += " " + file.filename().string();
    }
    if (files.size() < 2) return;
    require_one_recording();
    notes.push_back(fmt::format("the import reads these bag files as parts of one recording:{}", names));
  }

  std::vector<BagTopic> topics() override {
    return guarded(path_, kUnreadable, [&] {
      std::vector<BagTopic> topics;
      for (const auto& bag : bags_) {
        rosbag::View view(*bag);
        std::vector<const rosbag::ConnectionInfo*> connections = view.getConnections();
        std::sort(connections.begin(), connections.end(), [](const auto* a, const auto* b) { return a->id < b->id; });
        for (const rosbag::ConnectionInfo* each : connections) {
          const auto same = [&](const BagTopic& topic) { return topic.name == each->topic; };
          if (std::none_of(topics.begin(), topics.end(), same)) topics.push_back({each->topic, each->datatype});
        }
      }
      return topics;
    });
  }

  void read(const std::string& topic, const Take& take) override {
    guarded(path_, kUnreadable, [&] {
      rosbag::View view;  // merges the bags by time
      for (const auto& bag : bags_) view.addQuery(*bag, rosbag::TopicQuery(topic));
      ros::Bytes bytes;
      for (const rosbag::MessageInstance& message : view) {
        bytes.resize(message.size());
        ::ros::serialization::OStream stream(bytes.data(), message.size());
        message.write(stream);
        take(bytes, static_cast<std::int64_t>(message.getTime().toNSec()));
      }
    });
  }

  bool cdr(const std::string&) const override { return false; }

 private:
  void add(const std::filesystem::path& file) {
    check_ros1_bag(file);
    if (has_lz4_chunks(file))
      open_unpacked(file);
    else
      open(file);
  }

  void require_one_recording() const {
    guarded(path_, kUnreadable, [&] {
      std::set<std::pair<double, double>> spans;
      for (const auto& bag : bags_) {
        rosbag::View view(*bag);
        if (view.size() > 0) spans.emplace(view.getBeginTime().toSec(), view.getEndTime().toSec());
      }
      double end = spans.empty() ? 0.0 : spans.begin()->second;
      for (const auto& [from, to] : spans) {
        if (from - end > kPartsApart_s)
          throw BadInput(fmt::format(
              "{}: two bags of this folder are {:.0f} s apart, so they are not parts of one recording; import "
              "one bag at a time",
              path_.string(), from - end));
        end = std::max(end, to);
      }
    });
  }

  void open_unpacked(const std::filesystem::path& file) {
    const std::filesystem::path folder = std::filesystem::temp_directory_path();
    require_room(file, folder);
    // The decompressed file is unlinked directly after opening, so the operating system frees the disk space when the
    // reader closes the file or the process ends.
    const OutputFile unpacked(folder / "tumble_unpacked.bag");
    copy_ros1_bag(file, unpacked.unfinished(), [](Ros1Chunk& chunk) {
      if (chunk.compression == "lz4") unpack_lz4(chunk);
    });
    try {
      check_ros1_bag(unpacked.unfinished());
    } catch (const BadInput& error) {
      throw BadInput(file.string() +
                     ": unpacked: " + std::string(error.what()).substr(unpacked.unfinished().string().size() + 2));
    }
    open(unpacked.unfinished());
  }

  static void require_room(const std::filesystem::path& file, const std::filesystem::path& folder) {
    const std::uint64_t needed = bytes_unpacked(file), free = std::filesystem::space(folder).available;
    if (needed <= free) return;
    throw BadInput(fmt::format(
        "{}: the unpacked LZ4 chunks need {} bytes, but {} has only {} bytes free; set TMPDIR to another folder",
        file.string(), needed, folder.string(), free));
  }

  void open(const std::filesystem::path& file) {
    guarded(path_, kUnreadable, [&] {
      bags_.push_back(std::make_unique<rosbag::Bag>());
      bags_.back()->open(file.string(), rosbag::bagmode::Read);
    });
  }

  static constexpr const char* kUnreadable = "the file cannot be read as a ROS 1 bag";
  std::filesystem::path path_;
  std::vector<std::unique_ptr<rosbag::Bag>> bags_;
};

}  // namespace

std::unique_ptr<BagWriter> make_ros1_writer(const std::filesystem::path& file) {
  return std::make_unique<Ros1BagWriter>(file);
}

std::unique_ptr<BagReader> open_ros1_bag(const std::filesystem::path& path) {
  return std::make_unique<Ros1BagReader>(path);
}

}  // namespace tumble::scenarios
