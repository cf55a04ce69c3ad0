// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <map>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/mcap_records.hpp"
#include "scenarios/recordings/bags/packed.hpp"
#include "scenarios/recordings/bags/ros2_metadata.hpp"
#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

namespace mcap {

namespace {

constexpr std::size_t kChunkBytes = 1u << 20;

class Output {
 public:
  explicit Output(const std::filesystem::path& path) : file_(path) { put(kMagic); }
  std::uint64_t put(std::string_view bytes) {
    file_.write(std::as_bytes(std::span(bytes.data(), bytes.size())));
    crc_ = crc32_of(bytes, crc_);
    return std::exchange(at_, at_ + bytes.size());
  }
  std::uint64_t at() const { return at_; }
  std::uint32_t crc() const { return crc_; }
  void move_into_place() { file_.move_into_place(); }

 private:
  OutputFile file_;
  std::uint64_t at_ = 0;
  std::uint32_t crc_ = 0;
};

struct OpenChunk {
  std::string records;
  std::map<std::uint16_t, MessageIndex> index;
  std::uint64_t first_ns = std::numeric_limits<std::uint64_t>::max(), last_ns = 0;
};

class McapWriter : public BagWriter {
 public:
  explicit McapWriter(const std::filesystem::path& file) : out_(file) { out_.put(to_bytes(Header{"ros2", "tumble"})); }

  bool begin_with(const std::vector<BagTopic>& topics) override {
    for (const BagTopic& topic : topics) channel_of(topic.name, topic.type);
    return true;
  }

  void write(const std::string& topic, std::int64_t stamp_ns, const ros::Message& message) override {
    const std::uint16_t channel = channel_of(topic, ros::type_of(message));
    const auto time_ns = static_cast<std::uint64_t>(stamp_ns);
    const ros::Bytes bytes = ros::to_cdr(message);
    std::uint64_t& count = statistics_.channel_message_counts[channel];
    MessageIndex& index = chunk_.index[channel];
    index.channel_id = channel;
    index.entries.emplace_back(time_ns, chunk_.records.size());
    chunk_.records += to_bytes(Message{channel, static_cast<std::uint32_t>(count), time_ns, time_ns},
                               {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    chunk_.first_ns = std::min(chunk_.first_ns, time_ns);
    chunk_.last_ns = std::max(chunk_.last_ns, time_ns);
    ++count;
    if (chunk_.records.size() >= kChunkBytes) close_chunk();
  }

  void finish() override {
    close_chunk();
    out_.put(to_bytes(DataEnd{out_.crc()}));
    put_summary();
    out_.put(kMagic);
    out_.move_into_place();
  }

 private:
  std::uint16_t channel_of(const std::string& topic, const std::string& type) {
    for (const Channel& each : channels_) {
      if (each.topic == topic) return each.id;
    }
    const auto same = [&](const Schema& each) { return each.name == ros2_type(type); };
    auto schema = std::find_if(schemas_.begin(), schemas_.end(), same);
    if (schema == schemas_.end()) {
      schemas_.push_back(
          {static_cast<std::uint16_t>(schemas_.size() + 1), ros2_type(type), "ros2msg", ros2_definition(type)});
      schema = std::prev(schemas_.end());
      chunk_.records += to_bytes(*schema);
    }
    channels_.push_back({static_cast<std::uint16_t>(channels_.size() + 1),
                         schema->id,
                         topic,
                         "cdr",
                         {{"offered_qos_profiles", ros2_qos(topic)}}});
    chunk_.records += to_bytes(channels_.back());
    return channels_.back().id;
  }

  void close_chunk() {
    if (chunk_.records.empty()) return;
    const OpenChunk chunk = std::exchange(chunk_, {});
    std::string packed = packed_lz4(chunk.records);
    const Chunk head{chunk.first_ns,          chunk.last_ns, chunk.records.size(),
                     crc32_of(chunk.records), "lz4",         packed.size()};
    const std::string record = to_bytes(head, packed);
    ChunkIndex index{chunk.first_ns, chunk.last_ns, out_.put(record),    record.size(), {}, 0,
                     "lz4",          packed.size(), chunk.records.size()};
    for (const auto& [channel, entries] : chunk.index) {
      index.message_index_offsets[channel] = out_.put(to_bytes(entries));
    }
    index.message_index_length = out_.at() - index.chunk_start_offset - index.chunk_length;
    const bool first = statistics_.chunk_count++ == 0;
    statistics_.message_start_time = first ? chunk.first_ns : std::min(statistics_.message_start_time, chunk.first_ns);
    statistics_.message_end_time = std::max(statistics_.message_end_time, chunk.last_ns);
    chunks_.push_back(std::move(index));
  }

  template <class Records>
  void append_group(const Records& records, std::uint64_t begin, std::string& summary,
                    std::vector<SummaryOffset>& groups) {
    const std::uint64_t start = summary.size();
    for (const auto& each : records) summary += to_bytes(each);
    if (summary.size() > start)
      groups.push_back({std::decay_t<decltype(*records.begin())>::op, begin + start, summary.size() - start});
  }

  void put_summary() {
    for (const auto& [channel, count] : statistics_.channel_message_counts) statistics_.message_count += count;
    statistics_.schema_count = static_cast<std::uint16_t>(schemas_.size());
    statistics_.channel_count = static_cast<std::uint32_t>(channels_.size());
    const std::uint64_t begin = out_.at();
    std::string summary;
    std::vector<SummaryOffset> groups;
    append_group(schemas_, begin, summary, groups);
    append_group(channels_, begin, summary, groups);
    append_group(std::vector<Statistics>{statistics_}, begin, summary, groups);
    append_group(chunks_, begin, summary, groups);
    Footer footer{begin, begin + summary.size(), 0};
    for (const SummaryOffset& group : groups) summary += to_bytes(group);
    const std::string head = to_bytes(footer);
    footer.summary_crc =
        crc32_of(std::string_view(head).substr(0, head.size() - sizeof(footer.summary_crc)), crc32_of(summary));
    out_.put(summary + to_bytes(footer));
  }

  Output out_;
  OpenChunk chunk_;
  std::vector<Schema> schemas_;
  std::vector<Channel> channels_;
  std::vector<ChunkIndex> chunks_;
  Statistics statistics_;
};

}  // namespace

}  // namespace mcap

std::unique_ptr<BagWriter> make_mcap_writer(const std::filesystem::path& file) {
  return std::make_unique<mcap::McapWriter>(file);
}

}  // namespace tumble::scenarios
