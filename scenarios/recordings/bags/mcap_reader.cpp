// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/mcap_file.hpp"
#include "scenarios/recordings/bags/ros2_metadata.hpp"

namespace tumble::scenarios {

namespace mcap {

namespace {

/// Largest memory [bytes] for waiting messages. A message waits until no later chunk can contain an earlier message.
constexpr std::uint64_t kWaitingMax = 1u << 30;

bool is_cdr(const Channel& channel, const Schema& schema) {
  return channel.message_encoding == "cdr" && (schema.encoding == "ros2msg" || schema.encoding == "ros2idl");
}
bool is_ros1(const Channel& channel, const Schema& schema) {
  return channel.message_encoding == "ros1" && schema.encoding == "ros1msg";
}

class TopicWalk {
 public:
  TopicWalk(File& file, std::set<std::uint16_t> channels, const BagReader::Take& take)
      : file_(file), channels_(std::move(channels)), take_(take) {}

  void all() {
    for (const Segment& segment : file_.segments()) {
      const auto held = [&](std::uint16_t channel) { return segment.may_hold(channel); };
      if (std::none_of(channels_.begin(), channels_.end(), held)) continue;
      give_before(segment.first_ns);
      read(segment);
    }
    while (!waiting_.empty()) give_first();
    for (const std::uint16_t channel : channels_) {
      const std::optional<std::uint64_t> stated = file_.stated_messages(channel);
      if (stated && *stated != counts_[channel]) {
        file_.fail(0, fmt::format("channel {} contains {} messages, but the summary states {}: the file is damaged",
                                  channel, counts_[channel], *stated));
      }
    }
  }

 private:
  void read(const Segment& segment) {
    const std::string records = file_.records(segment);
    std::map<std::uint16_t, std::vector<std::pair<std::uint64_t, std::uint64_t>>> found;
    file_.walk(records, segment.at, [&](const Record& record) {
      if (record.op == kSchema) file_.add(file_.as<Schema>(record, segment.at), segment.at);
      if (record.op == kChannel) file_.add(file_.as<Channel>(record, segment.at), segment.at);
      if (record.op != kMessage) return;
      const auto message = file_.as<Message>(record, segment.at);
      if (!channels_.contains(message.channel_id)) return;
      require_time(segment, message.log_time);
      found[message.channel_id].emplace_back(message.log_time, record.at);
      ++counts_[message.channel_id];
      constexpr std::size_t kFields = 2 + 4 + 8 + 8;
      hold(segment, message.log_time, record.content.substr(kFields));
    });
    for (const std::uint16_t channel : channels_) require_indexed(segment, channel, found[channel]);
  }

  void require_time(const Segment& segment, std::uint64_t time_ns) const {
    if (time_ns >= segment.first_ns && time_ns <= segment.last_ns) return;
    file_.fail(
        segment.at,
        fmt::format("a message has the time {} ns, but its chunk states times from {} to {} ns: the file is damaged",
                    time_ns, segment.first_ns, segment.last_ns));
  }

  void require_indexed(const Segment& segment, std::uint16_t channel,
                       std::vector<std::pair<std::uint64_t, std::uint64_t>>& found) {
    std::optional<MessageIndex> index = file_.index_of(segment, channel);
    const bool complete = segment.chunk && !segment.chunk->message_index_offsets.empty();
    if (!index && (!complete || found.empty())) return;
    if (!index) index.emplace();
    std::sort(index->entries.begin(), index->entries.end());
    std::sort(found.begin(), found.end());
    if (index->entries == found) return;
    file_.fail(segment.at,
               fmt::format("the message index of a chunk lists {} messages of channel {}, and the chunk contains {}. "
                           "Number, times and positions of the messages must be equal: the file is damaged",
                           index->entries.size(), channel, found.size()));
  }

  void hold(const Segment& segment, std::uint64_t time_ns, std::string_view bytes) {
    waiting_bytes_ += bytes.size();
    if (waiting_bytes_ > kWaitingMax) {
      file_.fail(segment.at, "the chunks overlap in time; more than 1 GiB of messages would have to be buffered");
    }
    const auto* first = reinterpret_cast<const std::uint8_t*>(bytes.data());
    waiting_.emplace(time_ns, ros::Bytes(first, first + bytes.size()));
  }

  void give_before(std::uint64_t time_ns) {
    while (!waiting_.empty() && waiting_.begin()->first < time_ns) give_first();
  }
  void give_first() {
    const std::uint64_t time_ns = std::min<std::uint64_t>(waiting_.begin()->first, INT64_MAX);
    ros::Bytes bytes = std::move(waiting_.begin()->second);
    waiting_bytes_ -= bytes.size();
    waiting_.erase(waiting_.begin());
    take_(bytes, static_cast<std::int64_t>(time_ns));
  }

  File& file_;
  std::set<std::uint16_t> channels_;
  const BagReader::Take& take_;
  std::multimap<std::uint64_t, ros::Bytes> waiting_;  ///< equal times keep file order
  std::uint64_t waiting_bytes_ = 0;
  std::map<std::uint16_t, std::uint64_t> counts_;
};

class McapReader : public BagReader {
 public:
  explicit McapReader(const std::vector<std::filesystem::path>& files) {
    for (const std::filesystem::path& file : files) files_.push_back(std::make_unique<File>(file));
    const auto first_ns = [](const auto& file) {
      return file->segments().empty() ? ~std::uint64_t{0} : file->segments().front().first_ns;
    };
    const auto earlier = [&](const auto& a, const auto& b) { return first_ns(a) < first_ns(b); };
    if (std::is_sorted(files_.begin(), files_.end(), earlier)) return;
    std::stable_sort(files_.begin(), files_.end(), earlier);
    notes.emplace_back(kFilesSorted);
  }

  std::vector<BagTopic> topics() override {
    std::vector<BagTopic> topics;
    for (const auto& file : files_) {
      for (const auto& [id, channel] : file->channels()) {
        const BagTopic topic = {channel.topic, type_of(*file, channel)};
        const auto same = [&](const BagTopic& each) { return each.name == topic.name; };
        const auto found = std::find_if(topics.begin(), topics.end(), same);
        if (found == topics.end()) {
          topics.push_back(topic);
        } else if (found->type != topic.type) {
          file->fail(0, fmt::format("topic {} has two types, {} and {}; a topic must have one type", topic.name,
                                    found->type, topic.type));
        }
      }
    }
    return topics;
  }

  void read(const std::string& topic, const Take& take) override {
    for (const auto& file : files_) {
      std::set<std::uint16_t> channels;
      for (const auto& [id, channel] : file->channels()) {
        if (channel.topic == topic) channels.insert(id);
      }
      if (!channels.empty()) TopicWalk(*file, channels, take).all();
    }
  }

  bool cdr(const std::string& topic) const override {
    for (const auto& file : files_) {
      for (const auto& [id, channel] : file->channels()) {
        if (channel.topic == topic) return is_cdr(channel, schema_of(*file, channel));
      }
    }
    return true;
  }

 private:
  static const Schema& schema_of(const File& file, const Channel& channel) {
    static const Schema none;
    return channel.schema_id == 0 ? none : file.schemas().at(channel.schema_id);
  }

  static std::string type_of(const File& file, const Channel& channel) {
    const Schema& schema = schema_of(file, channel);
    if (is_cdr(channel, schema)) return ros1_type(schema.name);
    if (is_ros1(channel, schema)) return schema.name;
    return schema.name + " as " + channel.message_encoding + " (" + schema.encoding + ")";
  }

  std::vector<std::unique_ptr<File>> files_;
};

}  // namespace

}  // namespace mcap

std::unique_ptr<BagReader> open_mcap(const std::vector<std::filesystem::path>& files) {
  return std::make_unique<mcap::McapReader>(files);
}

}  // namespace tumble::scenarios

namespace tumble::scenarios::mcap {

namespace {

constexpr std::uint64_t kRecordMax = 1u << 28;
constexpr std::uint64_t kSegmentBytes = 1u << 22;

void cover(Segment& segment, bool& empty, std::uint64_t time_ns) {
  segment.first_ns = empty ? time_ns : std::min(segment.first_ns, time_ns);
  segment.last_ns = empty ? time_ns : std::max(segment.last_ns, time_ns);
  empty = false;
}

}  // namespace

void File::scan() {
  std::optional<Segment> loose;
  bool empty = true;
  const auto close = [&] {
    if (loose && !empty) segments_.push_back(*loose);
    loose.reset();
    empty = true;
  };
  bool first = true;
  for (std::uint64_t at = kMagic.size(); at < data_end_;) {
    const std::string head = text(at, std::min(kHeadBytes, data_end_ - at));
    std::uint8_t op = 0;
    std::uint64_t size = 0;
    if (head.size() < kHeadBytes) fail(at, "the file ends within the header of a record: it is damaged or truncated");
    Take take(head);
    take(op), take(size);
    const std::uint64_t left = data_end_ - at - kHeadBytes;
    if (size > left) {
      fail(at,
           fmt::format(
               "a record states a length of {} bytes, but at most {} bytes follow: the file is damaged or truncated",
               size, left));
    }
    if (first && op != kHeader) fail(at, "the first record is not a header: the file is damaged");
    if (op == 0 || op == kFooter || op == kDataEnd || (op == kHeader && !first))
      fail(at, fmt::format("a record of kind {} is not allowed in the data section: the file is damaged", op));
    first = false;
    const std::uint64_t bytes = kHeadBytes + size;
    if (op == kChunk) {
      close();
      scan_chunk(head_of_chunk(at, bytes, nullptr));
    } else if (op == kSchema || op == kChannel || op == kMessage) {
      if (bytes > kRecordMax)
        fail(at, fmt::format("a record outside chunks has {} bytes; at most 256 MiB can be read", bytes));
      const std::string whole = text(at, bytes);
      const Record record = record_in(whole, 0, at);
      if (op == kSchema) add(as<Schema>(record, at), at);
      if (op == kChannel) add(as<Channel>(record, at), at);
      if (loose && loose->bytes + bytes > kSegmentBytes) close();
      if (!loose) loose = Segment{at, 0, 0, 0, std::nullopt};
      loose->bytes = at + bytes - loose->at;
      if (op == kMessage) cover(*loose, empty, as<Message>(record, at).log_time);
    } else {
      close();  // record without messages
    }
    at += bytes;
  }
  close();
}

void File::scan_chunk(const ChunkIndex& index) {
  Segment segment{index.chunk_start_offset, index.chunk_length, 0, 0, index};
  bool empty = true;
  walk(records(segment), index.chunk_start_offset, [&](const Record& record) {
    const std::uint64_t at = index.chunk_start_offset;
    if (record.op == kSchema) add(as<Schema>(record, at), at);
    if (record.op == kChannel) add(as<Channel>(record, at), at);
    if (record.op == kMessage) cover(segment, empty, as<Message>(record, at).log_time);
  });
  if (!empty) segments_.push_back(segment);
}

}  // namespace tumble::scenarios::mcap
