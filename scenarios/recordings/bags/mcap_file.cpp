// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/mcap_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/packed.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios::mcap {

namespace {

constexpr std::uint64_t kBytesMax = 1u << 28;
constexpr std::uint64_t kLooseBytes = 1u << 22;
constexpr std::uint64_t kFooterBytes = kHeadBytes + 20, kDataEndBytes = kHeadBytes + 4;

std::string in_bytes(std::uint64_t bytes) {
  return std::to_string(bytes) + " bytes";
}

bool agree(const ChunkIndex& a, const ChunkIndex& b) {
  return a.message_start_time == b.message_start_time && a.message_end_time == b.message_end_time &&
         a.chunk_start_offset == b.chunk_start_offset && a.chunk_length == b.chunk_length &&
         a.compression == b.compression && a.compressed_size == b.compressed_size &&
         a.uncompressed_size == b.uncompressed_size;
}

}  // namespace

File::File(const std::filesystem::path& path) : path_(path), stream_(open_regular_file(path)) {
  bytes_ = std::filesystem::file_size(path);
  open_ends();
  check_data();
  read_summary();
  if (segments_.empty()) scan();
  for (const auto& [id, channel] : channels_) {
    if (channel.schema_id != 0 && !schemas_.contains(channel.schema_id))
      fail(0, fmt::format("channel {} refers to schema {}, which does not exist: the file is damaged", id,
                          channel.schema_id));
  }
  std::stable_sort(segments_.begin(), segments_.end(),
                   [](const Segment& a, const Segment& b) { return a.first_ns < b.first_ns; });
}

void File::fail(std::uint64_t at, const std::string& what) const {
  throw BadInput(path_.string() + ": at byte " + std::to_string(at) + ": " + what);
}

std::string File::text(std::uint64_t at, std::uint64_t size) {
  if (at > bytes_ || size > bytes_ - at)
    fail(at, fmt::format("the next {} would extend beyond the end of the file; the file is damaged or truncated",
                         in_bytes(size)));
  std::string out(size, '\0');
  stream_.clear();
  stream_.seekg(static_cast<std::streamoff>(at));
  if (!stream_.read(out.data(), static_cast<std::streamsize>(size))) fail(at, "cannot be read");
  return out;
}

Record File::record_in(std::string_view records, std::uint64_t place, std::uint64_t at) const {
  Take take(records.substr(place));
  Record out;
  out.at = place;
  if (take.left.size() < kHeadBytes)
    fail(at + place, "the file ends within the header of a record: it is damaged or truncated");
  std::uint64_t size = 0;
  take(out.op), take(size);
  if (size > take.left.size()) {
    fail(at + place,
         fmt::format("a record states a length of {}, but at most {} bytes follow: the file is damaged or truncated",
                     in_bytes(size), take.left.size()));
  }
  if (out.op == 0) fail(at + place, "a record has the kind 0, which is not allowed: the file is damaged");
  out.content = take.cut(size);
  return out;
}

void File::open_ends() {
  if (bytes_ < kMagic.size() || text(0, kMagic.size()) != kMagic)
    fail(0, "the file does not begin with the magic bytes of MCAP 0, so it is not an MCAP file");
  if (bytes_ < 2 * kMagic.size() + kFooterBytes + kDataEndBytes ||
      text(bytes_ - kMagic.size(), kMagic.size()) != kMagic)
    fail(bytes_,
         "the file does not end with the magic bytes of MCAP: it is truncated or was not closed (repair the file with "
         "'mcap recover')");
  footer_at_ = bytes_ - kMagic.size() - kFooterBytes;
  const std::string footer = text(footer_at_, kFooterBytes);
  const Record record = record_in(footer, 0, footer_at_);
  if (record.op != kFooter || record.content.size() != kFooterBytes - kHeadBytes)
    fail(footer_at_, "the file has no footer: it is damaged");
  footer_ = as<Footer>(record, footer_at_);
  const std::uint64_t data_end = footer_.summary_start == 0 ? footer_at_ : footer_.summary_start;
  if (data_end > footer_at_ || data_end < kMagic.size() + kDataEndBytes)
    fail(footer_at_,
         fmt::format("the summary starts at byte {}, which is an impossible position: the file is damaged", data_end));
  data_end_ = data_end - kDataEndBytes;
}

void File::check_data() {
  const std::string bytes = text(data_end_, kDataEndBytes);
  const Record end = record_in(bytes, 0, data_end_);
  if (end.op != kDataEnd || end.content.size() != kDataEndBytes - kHeadBytes)
    fail(data_end_, "the record that ends the data section is missing before the summary: the file is damaged");
  const std::uint32_t stated = as<DataEnd>(end, data_end_).data_section_crc;
  if (stated == 0) return;
  std::uint32_t crc = 0;
  for (std::uint64_t at = 0; at < data_end_;) {
    const std::uint64_t size = std::min(kLooseBytes, data_end_ - at);
    crc = crc32_of(text(at, size), crc);
    at += size;
  }
  if (crc != stated) {
    fail(data_end_,
         fmt::format("the checksum of the data is {}, but the file states {}: the file is damaged", crc, stated));
  }
}

void File::read_summary() {
  if (footer_.summary_start == 0) return;
  const std::uint64_t size = footer_at_ - footer_.summary_start;
  if (size > kBytesMax)
    fail(footer_.summary_start, fmt::format("the summary section has {}; at most 256 MiB can be read", in_bytes(size)));
  const std::string all = text(footer_.summary_start, size + kFooterBytes);
  const std::uint32_t crc = crc32_of(std::string_view(all).substr(0, all.size() - sizeof(footer_.summary_crc)));
  if (footer_.summary_crc != 0 && crc != footer_.summary_crc) {
    fail(footer_.summary_start,
         fmt::format("the checksum of the summary is {}, but the file states {}: the file is damaged", crc,
                     footer_.summary_crc));
  }
  std::string_view summary = std::string_view(all).substr(0, size);
  if (footer_.summary_offset_start != 0) {
    if (footer_.summary_offset_start < footer_.summary_start || footer_.summary_offset_start > footer_at_)
      fail(footer_at_,
           fmt::format("the summary offsets start at byte {}, which is an impossible position: the file is damaged",
                       footer_.summary_offset_start));
    const std::uint64_t records = footer_.summary_offset_start - footer_.summary_start;
    check_groups(summary.substr(0, records), summary.substr(records));
    summary = summary.substr(0, records);
  }
  std::vector<ChunkIndex> chunks;
  walk(summary, footer_.summary_start, [&](const Record& record) {
    const std::uint64_t at = footer_.summary_start + record.at;
    if (record.op == kSchema) add(as<Schema>(record, at), at);
    if (record.op == kChannel) add(as<Channel>(record, at), at);
    if (record.op == kStatistics) statistics_ = as<Statistics>(record, at);
    if (record.op == kChunkIndex) chunks.push_back(as<ChunkIndex>(record, at));
  });
  take_indexed(std::move(chunks));
}

void File::check_groups(std::string_view summary, std::string_view groups) const {
  const std::uint64_t groups_at = footer_.summary_offset_start;
  walk(groups, groups_at, [&](const Record& record) {
    const std::uint64_t at = groups_at + record.at;
    if (record.op != kSummaryOffset)
      fail(at, fmt::format("a record of kind {} is not allowed in the summary offset section: the file is damaged",
                           record.op));
    const auto group = as<SummaryOffset>(record, at);
    const std::uint64_t start = group.group_start - footer_.summary_start;
    if (group.group_start < footer_.summary_start || start > summary.size() ||
        group.group_length > summary.size() - start)
      fail(at, fmt::format("the summary names a group at byte {}, which is outside the summary: the file is damaged",
                           group.group_start));
    walk(summary.substr(start, group.group_length), group.group_start, [&](const Record& each) {
      if (each.op != group.group_opcode)
        fail(at,
             fmt::format(
                 "the summary names a group of kind {}, but the group contains records of kind {}: the file is damaged",
                 group.group_opcode, each.op));
    });
  });
}

void File::take_indexed(std::vector<ChunkIndex> chunks) {
  if (chunks.empty()) return;
  std::sort(chunks.begin(), chunks.end(),
            [](const ChunkIndex& a, const ChunkIndex& b) { return a.chunk_start_offset < b.chunk_start_offset; });
  if (statistics_ && statistics_->chunk_count != chunks.size()) {
    fail(footer_.summary_start,
         fmt::format("the summary states {} chunks but contains {} chunk indexes: the file is damaged",
                     statistics_->chunk_count, chunks.size()));
  }
  std::uint64_t free = kMagic.size();
  for (const ChunkIndex& each : chunks) {
    const std::uint64_t at = each.chunk_start_offset;
    if (at < free || at > data_end_ || each.chunk_length > data_end_ - at ||
        each.message_index_length > data_end_ - at - each.chunk_length) {
      fail(footer_.summary_start, fmt::format("the chunk index names a chunk of {} at byte {}; the chunk must be "
                                              "between bytes {} and {}: the file is damaged",
                                              in_bytes(each.chunk_length), at, free, data_end_));
    }
    free = at + each.chunk_length + each.message_index_length;
    for (const auto& [channel, place] : each.message_index_offsets) {
      if (!channels_.contains(channel)) return segments_.clear();  // scan the file if channels are missing
      if (place < at + each.chunk_length || place >= free)
        fail(place,
             fmt::format(
                 "the chunk at byte {} must be followed by its message indexes, but is not: the file is damaged", at));
    }
    segments_.push_back({at, each.chunk_length, each.message_start_time, each.message_end_time, each});
  }
  // An MCAP file without statistics is scanned completely, because the chunk index does not contain messages outside
  // chunks.
  if (!statistics_ || channels_.empty()) segments_.clear();
}

std::optional<std::uint64_t> File::stated_messages(std::uint16_t channel) const {
  if (!statistics_) return std::nullopt;
  const auto found = statistics_->channel_message_counts.find(channel);
  if (found == statistics_->channel_message_counts.end()) return std::nullopt;
  return found->second;
}

std::string File::records(const Segment& segment) {
  if (!segment.chunk) return text(segment.at, segment.bytes);
  std::uint32_t crc = 0;
  const ChunkIndex own = head_of_chunk(segment.at, segment.bytes, &crc);
  if (!agree(own, *segment.chunk))
    fail(segment.at, "the header of a chunk differs from its entry in the chunk index: the file is damaged");
  std::string packed = text(segment.at + segment.bytes - own.compressed_size, own.compressed_size), out;
  try {
    if (own.compression == "lz4")
      out = unpacked_lz4(packed, own.uncompressed_size);
    else if (own.compression == "zstd")
      out = unpacked_zstd(packed, own.uncompressed_size);
    else
      out = std::move(packed);
  } catch (const BadInput& error) {
    fail(segment.at, error.what());
  }
  if (crc != 0 && crc32_of(out) != crc) {
    fail(segment.at, fmt::format("the checksum of the chunk is {}, but the file states {}: the file is damaged",
                                 crc32_of(out), crc));
  }
  return out;
}

std::optional<MessageIndex> File::index_of(const Segment& segment, std::uint16_t channel) {
  if (!segment.chunk || !segment.chunk->message_index_offsets.contains(channel)) return std::nullopt;
  const std::uint64_t at = segment.chunk->message_index_offsets.at(channel);
  const std::uint64_t end = segment.at + segment.bytes + segment.chunk->message_index_length;
  if (end - at < kHeadBytes)
    fail(at, "the message index of a chunk ends within the header of a record: the file is damaged");
  const std::string bytes = text(at, std::min(end - at, kBytesMax));
  const Record record = record_in(bytes, 0, at);
  if (record.op != kMessageIndex)
    fail(at, "the record after a chunk must be a message index, but is not: the file is damaged");
  auto index = as<MessageIndex>(record, at);
  if (index.channel_id != channel) {
    fail(at, fmt::format("this message index belongs to channel {}, but must belong to channel {}: the file is damaged",
                         index.channel_id, channel));
  }
  return index;
}

ChunkIndex File::head_of_chunk(std::uint64_t at, std::uint64_t bytes, std::uint32_t* crc) {
  constexpr std::uint64_t kMost = kHeadBytes + 8 + 8 + 8 + 4 + 4 + 64 + 8;
  std::string head = text(at, std::min(bytes, kMost));
  if (head.size() < kHeadBytes || static_cast<std::uint8_t>(head[0]) != kChunk)
    fail(at, "the chunk index refers to a record that is not a chunk: the file is damaged");
  std::uint64_t content = 0;
  std::memcpy(&content, head.data() + 1, sizeof(content));
  if (content != bytes - kHeadBytes)
    fail(at, fmt::format("a chunk has {}, but its entry in the chunk index states {}: the file is damaged",
                         in_bytes(content), in_bytes(bytes - kHeadBytes)));
  Take take(std::string_view(head).substr(kHeadBytes));
  Chunk chunk;
  try {
    fields(take, chunk);
  } catch (const BadRecord& error) {
    fail(at, std::string("the chunk ") + error.what());
  }
  const std::uint64_t taken = head.size() - take.left.size();
  if (chunk.records_size != bytes - taken)
    fail(at, fmt::format("the header of a chunk states {} of records, but the chunk contains {}: the file is damaged",
                         in_bytes(chunk.records_size), in_bytes(bytes - taken)));
  if (chunk.records_size > kBytesMax || chunk.uncompressed_size > kBytesMax) {
    fail(at, fmt::format("a chunk has a size of {}; at most 256 MiB can be read",
                         in_bytes(std::max(chunk.records_size, chunk.uncompressed_size))));
  }
  if (!chunk.compression.empty() && chunk.compression != "lz4" && chunk.compression != "zstd") {
    fail(at, fmt::format("the compression '{}' of a chunk is not supported; supported: none, lz4 and zstd",
                         chunk.compression.substr(0, 40)));
  }
  if (chunk.compression.empty() && chunk.uncompressed_size != chunk.records_size) {
    fail(at, fmt::format("an uncompressed chunk has {}, but states a size of {} bytes: the file is damaged",
                         in_bytes(chunk.records_size), chunk.uncompressed_size));
  }
  if (crc != nullptr) *crc = chunk.uncompressed_crc;
  return {chunk.message_start_time, chunk.message_end_time, at, bytes, {}, 0, chunk.compression,
          chunk.records_size,       chunk.uncompressed_size};
}

void File::add(Schema schema, std::uint64_t at) {
  if (schema.id == 0) fail(at, "a schema has the number 0, which means 'no schema': the file is damaged");
  const auto [place, fresh] = schemas_.try_emplace(schema.id, schema);
  if (!fresh && place->second != schema)
    fail(at, fmt::format("schema {} is defined twice with different content", schema.id));
}

void File::add(Channel channel, std::uint64_t at) {
  const auto [place, fresh] = channels_.try_emplace(channel.id, channel);
  if (!fresh && place->second != channel)
    fail(at, fmt::format("channel {} is defined twice with different content", channel.id));
}

}  // namespace tumble::scenarios::mcap
