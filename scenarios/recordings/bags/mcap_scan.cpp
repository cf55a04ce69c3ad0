// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>

#include "scenarios/recordings/bags/mcap_file.hpp"

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
    if (head.size() < kHeadBytes) fail(at, "the file ends within the head of a record: it is damaged or truncated");
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
