// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstdint>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

/// The fields of MCAP records have the order of the specification (mcap.dev/spec, version 0), and numbers are
/// little-endian.
namespace tumble::scenarios::mcap {

enum Op : std::uint8_t {
  kHeader = 1,
  kFooter,
  kSchema,
  kChannel,
  kMessage,
  kChunk,
  kMessageIndex,
  kChunkIndex,
  kAttachment,
  kAttachmentIndex,
  kStatistics,
  kMetadata,
  kMetadataIndex,
  kSummaryOffset,
  kDataEnd
};

struct Header {
  static constexpr Op op = kHeader;
  std::string profile, library;
};
struct Footer {
  static constexpr Op op = kFooter;
  std::uint64_t summary_start = 0, summary_offset_start = 0;  ///< 0: the section is missing
  std::uint32_t summary_crc = 0;                              ///< CRC up to this field; 0: none
};
struct Schema {
  static constexpr Op op = kSchema;
  std::uint16_t id = 0;
  std::string name, encoding, data;
  bool operator==(const Schema&) const = default;
};
struct Channel {
  static constexpr Op op = kChannel;
  std::uint16_t id = 0, schema_id = 0;  ///< schema_id 0: no schema
  std::string topic, message_encoding;
  std::map<std::string, std::string> metadata;
  bool operator==(const Channel&) const = default;
};
struct Message {
  static constexpr Op op = kMessage;
  std::uint16_t channel_id = 0;
  std::uint32_t sequence = 0;
  std::uint64_t log_time = 0, publish_time = 0;
};
struct Chunk {
  static constexpr Op op = kChunk;
  std::uint64_t message_start_time = 0, message_end_time = 0, uncompressed_size = 0;
  std::uint32_t uncompressed_crc = 0;
  std::string compression;
  std::uint64_t records_size = 0;
};
struct MessageIndex {
  static constexpr Op op = kMessageIndex;
  std::uint16_t channel_id = 0;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> entries;  ///< log time, offset in uncompressed chunk
};
struct ChunkIndex {
  static constexpr Op op = kChunkIndex;
  std::uint64_t message_start_time = 0, message_end_time = 0, chunk_start_offset = 0, chunk_length = 0;
  std::map<std::uint16_t, std::uint64_t> message_index_offsets;  ///< offset in the file, by channel
  std::uint64_t message_index_length = 0;
  std::string compression;
  std::uint64_t compressed_size = 0, uncompressed_size = 0;
};
struct Statistics {
  static constexpr Op op = kStatistics;
  std::uint64_t message_count = 0;
  std::uint16_t schema_count = 0;
  std::uint32_t channel_count = 0, attachment_count = 0, metadata_count = 0, chunk_count = 0;
  std::uint64_t message_start_time = 0, message_end_time = 0;
  std::map<std::uint16_t, std::uint64_t> channel_message_counts;
};
struct SummaryOffset {
  static constexpr Op op = kSummaryOffset;
  std::uint8_t group_opcode = 0;
  std::uint64_t group_start = 0, group_length = 0;
};
struct DataEnd {
  static constexpr Op op = kDataEnd;
  std::uint32_t data_section_crc = 0;  ///< CRC of all earlier bytes; 0: none
};

template <class Archive>
void fields(Archive& a, Header& r) {
  a(r.profile), a(r.library);
}
template <class Archive>
void fields(Archive& a, Footer& r) {
  a(r.summary_start), a(r.summary_offset_start), a(r.summary_crc);
}
template <class Archive>
void fields(Archive& a, Schema& r) {
  a(r.id), a(r.name), a(r.encoding), a(r.data);
}
template <class Archive>
void fields(Archive& a, Channel& r) {
  a(r.id), a(r.schema_id), a(r.topic), a(r.message_encoding), a(r.metadata);
}
template <class Archive>
void fields(Archive& a, Message& r) {
  a(r.channel_id), a(r.sequence), a(r.log_time), a(r.publish_time);
}
template <class Archive>
void fields(Archive& a, Chunk& r) {
  a(r.message_start_time), a(r.message_end_time), a(r.uncompressed_size), a(r.uncompressed_crc), a(r.compression);
  a(r.records_size);
}
template <class Archive>
void fields(Archive& a, MessageIndex& r) {
  a(r.channel_id), a(r.entries);
}
template <class Archive>
void fields(Archive& a, ChunkIndex& r) {
  a(r.message_start_time), a(r.message_end_time), a(r.chunk_start_offset), a(r.chunk_length);
  a(r.message_index_offsets), a(r.message_index_length), a(r.compression), a(r.compressed_size);
  a(r.uncompressed_size);
}
template <class Archive>
void fields(Archive& a, Statistics& r) {
  a(r.message_count), a(r.schema_count), a(r.channel_count), a(r.attachment_count), a(r.metadata_count);
  a(r.chunk_count), a(r.message_start_time), a(r.message_end_time), a(r.channel_message_counts);
}
template <class Archive>
void fields(Archive& a, SummaryOffset& r) {
  a(r.group_opcode), a(r.group_start), a(r.group_length);
}
template <class Archive>
void fields(Archive& a, DataEnd& r) {
  a(r.data_section_crc);
}

inline constexpr std::string_view kMagic("\x89MCAP0\r\n", 8);
inline constexpr std::uint64_t kHeadBytes = 9;

struct BadRecord : std::runtime_error {
  using std::runtime_error::runtime_error;
};

class Put {
 public:
  template <std::unsigned_integral Number>
  void operator()(Number number) {
    bytes.append(reinterpret_cast<const char*>(&number), sizeof(number));
  }
  void operator()(const std::string& text) { (*this)(static_cast<std::uint32_t>(text.size())), bytes += text; }
  template <class Entries>
  requires requires(Entries entries) { entries.begin()->second; }
  void operator()(const Entries& entries) {
    Put inner;
    for (const auto& [key, value] : entries) inner(key), inner(value);
    (*this)(inner.bytes);
  }
  std::string bytes;
};

class Take {
 public:
  explicit Take(std::string_view bytes) : left(bytes) {}
  template <std::unsigned_integral Number>
  void operator()(Number& number) {
    std::memcpy(&number, cut(sizeof(number)).data(), sizeof(number));
  }
  void operator()(std::string& text) { text = block(); }
  template <class Key, class Value>
  void operator()(std::map<Key, Value>& entries) {
    for (Take inner(block()); !inner.left.empty();) {
      Key key{};
      inner(key);
      inner(entries[key]);
    }
  }
  template <class First, class Second>
  void operator()(std::vector<std::pair<First, Second>>& entries) {
    for (Take inner(block()); !inner.left.empty();) {
      auto& [first, second] = entries.emplace_back();
      inner(first), inner(second);
    }
  }
  std::string_view cut(std::uint64_t size) {
    if (size > left.size()) {
      throw BadRecord("needs " + std::to_string(size) + " bytes, but only " + std::to_string(left.size()) +
                      " are left");
    }
    const std::string_view out = left.substr(0, size);
    left.remove_prefix(size);
    return out;
  }
  std::string_view left;

 private:
  std::string_view block() {
    std::uint32_t size = 0;
    (*this)(size);
    return cut(size);
  }
};

template <class Record>
std::string to_bytes(Record record, std::string_view tail = {}) {
  Put content, out;
  fields(content, record);
  out(static_cast<std::uint8_t>(Record::op));
  out(static_cast<std::uint64_t>(content.bytes.size() + tail.size()));
  return std::move(out.bytes.append(content.bytes).append(tail));
}

template <class Record>
Record from_bytes(std::string_view content) {
  Record record;
  Take take(content);
  fields(take, record);
  return record;
}

}  // namespace tumble::scenarios::mcap
