// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/recordings/bags/mcap_records.hpp"

namespace tumble::scenarios::mcap {

struct Segment {
  std::uint64_t at = 0, bytes = 0;  ///< in the file, with record heads
  std::uint64_t first_ns = 0, last_ns = 0;
  std::optional<ChunkIndex> chunk;  ///< indexed if the file has a summary
  bool may_hold(std::uint16_t channel) const {
    return !chunk || chunk->message_index_offsets.empty() || chunk->message_index_offsets.contains(channel);
  }
};

struct Record {
  std::uint8_t op = 0;
  std::uint64_t at = 0;
  std::string_view content;
};

class File {
 public:
  /// Reads the summary of the MCAP file. A file without a summary is scanned completely, in O(file size) time. Every
  /// length, position, time and checksum is checked. Throws BadInput with the offset if the file is damaged, or has a
  /// compression other than none, lz4 or zstd. Also throws BadInput if a chunk or record is larger than 256 MiB.
  explicit File(const std::filesystem::path& path);

  const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  const std::vector<Segment>& segments() const { return segments_; }
  std::optional<std::uint64_t> stated_messages(std::uint16_t channel) const;

  std::string records(const Segment& segment);
  std::optional<MessageIndex> index_of(const Segment& segment, std::uint16_t channel);

  template <class Call>
  void walk(std::string_view records, std::uint64_t at, Call&& take) const {
    for (std::uint64_t place = 0; place < records.size();) {
      const Record record = record_in(records, place, at);
      take(record);
      place += kHeadBytes + record.content.size();
    }
  }
  template <class Content>
  Content as(const Record& record, std::uint64_t at) const {
    try {
      return from_bytes<Content>(record.content);
    } catch (const BadRecord& error) {
      fail(at, "a record of kind " + std::to_string(record.op) + " " + error.what());
    }
  }
  void add(Schema schema, std::uint64_t at);
  void add(Channel channel, std::uint64_t at);
  [[noreturn]] void fail(std::uint64_t at, const std::string& what) const;

 private:
  std::string text(std::uint64_t at, std::uint64_t size);
  Record record_in(std::string_view records, std::uint64_t place, std::uint64_t at) const;
  void open_ends();
  void check_data();
  void read_summary();
  void check_groups(std::string_view summary, std::string_view groups) const;
  void take_indexed(std::vector<ChunkIndex> chunks);
  void scan();
  void scan_chunk(const ChunkIndex& index);
  ChunkIndex head_of_chunk(std::uint64_t at, std::uint64_t bytes, std::uint32_t* crc);

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t bytes_ = 0, data_end_ = 0, footer_at_ = 0;
  Footer footer_;
  std::optional<Statistics> statistics_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<Segment> segments_;
};

}  // namespace tumble::scenarios::mcap
