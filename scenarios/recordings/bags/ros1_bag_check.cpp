// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/ros1_chunks.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::string_view kMagic = "#ROSBAG V2.0\n";
constexpr std::uint32_t kRecordHeaderMax = 1u << 20, kChunkMax = 1u << 30;

struct CheckedRecord {
  std::uint64_t at = 0, data_at = 0;
  std::uint32_t data_bytes = 0;
  std::map<std::string, std::string> fields;
  std::uint64_t end() const { return data_at + data_bytes; }
};

class Walk {
 public:
  explicit Walk(const std::filesystem::path& path) : path_(path), stream_(open_regular_file(path)) {
    bytes_ = std::filesystem::file_size(path);
  }

  void all() {
    if (bytes_ < kMagic.size() || text(0, kMagic.size()) != kMagic)
      fail(0, "the file does not begin with '#ROSBAG V2.0', so it is not a ROS 1 bag of version 2.0");
    std::uint64_t at = kMagic.size();
    const CheckedRecord file = record(at, bytes_);
    if (op(file) != ros1::kFile) fail(at, "the first record of the bag is not a bag header: the file is damaged");
    if (number<std::uint64_t>(file, "index_pos") == 0)
      fail(at, "the bag was not closed and has no index (create the index with 'rosbag reindex')");
    const std::uint64_t index_at = number<std::uint64_t>(file, "index_pos");
    if (index_at >= bytes_)
      fail(at,
           "the index is beyond the end of the file; the bag may be truncated (repair the bag with 'rosbag reindex')");
    bool indexed = false;
    for (at = file.end(); at < bytes_;) {
      const CheckedRecord next = record(at, bytes_);
      indexed = indexed || at == index_at;
      step(next);
      at = next.end();
    }
    if (!indexed) fail(index_at, "the bag header refers to an index, but no record starts there: the file is damaged");
    for (const auto& [info_at, chunk_at] : infos_) {
      if (!chunks_.contains(chunk_at))
        fail(info_at, fmt::format("the index refers to a chunk at byte {}, which does not exist: the file is damaged",
                                  chunk_at));
    }
  }

 private:
  [[noreturn]] void fail(std::uint64_t at, const std::string& what) const {
    throw BadInput(path_.string() + ": at byte " + std::to_string(at) + ": " + what);
  }

  std::string text(std::uint64_t at, std::uint64_t size) {
    std::string out(size, '\0');
    stream_.seekg(static_cast<std::streamoff>(at));
    stream_.read(out.data(), static_cast<std::streamsize>(size));
    if (static_cast<std::uint64_t>(stream_.gcount()) != size) fail(at, "cannot be read");
    return out;
  }

  std::uint32_t length(std::uint64_t at, std::uint64_t end, const char* what, std::uint32_t most) {
    if (end - at < sizeof(std::uint32_t))
      fail(at, fmt::format("the file ends within the length field of {}; the bag may be truncated", what));
    std::uint32_t value = 0;
    std::memcpy(&value, text(at, sizeof(value)).data(), sizeof(value));
    const std::uint64_t left = end - at - sizeof(value);
    if (value > left || value > most) {
      fail(at,
           fmt::format(
               "{} states a length of {} bytes; its length must be at most {} bytes: the file is damaged or truncated",
               what, value, std::min<std::uint64_t>(left, most)));
    }
    return value;
  }

  std::map<std::string, std::string> fields(std::uint64_t at, const std::string& bytes) const {
    std::map<std::string, std::string> out;
    for (std::size_t place = 0; place < bytes.size();) {
      std::uint32_t size = 0;
      if (bytes.size() - place < 4) fail(at, "a field in the header of a record is truncated: the file is damaged");
      std::memcpy(&size, bytes.data() + place, 4);
      if (size > bytes.size() - place - 4)
        fail(at, "a field in the header of a record is truncated: the file is damaged");
      const std::string field = bytes.substr(place + 4, size);
      const std::size_t equals = field.find('=');
      if (equals == std::string::npos) fail(at, "a field in the header of a record has no '=': the file is damaged");
      out[field.substr(0, equals)] = field.substr(equals + 1);
      place += 4 + size;
    }
    return out;
  }

  CheckedRecord record(std::uint64_t at, std::uint64_t end) {
    CheckedRecord out;
    out.at = at;
    const std::uint32_t header = length(at, end, "a record's header", kRecordHeaderMax);
    out.fields = fields(at, text(at + 4, header));
    out.data_at = at + 4 + header + 4;
    out.data_bytes = length(at + 4 + header, end, "a record's data", ~0u);
    return out;
  }

  template <class Number>
  Number number(const CheckedRecord& record, const char* name) const {
    const auto found = record.fields.find(name);
    if (found == record.fields.end() || found->second.size() != sizeof(Number)) {
      fail(record.at, fmt::format("the header of a record lacks the field '{}' of {} bytes: the file is damaged", name,
                                  sizeof(Number)));
    }
    Number value;
    std::memcpy(&value, found->second.data(), sizeof(value));
    return value;
  }

  std::uint8_t op(const CheckedRecord& record) const { return number<std::uint8_t>(record, "op"); }

  void step(const CheckedRecord& record) {
    switch (op(record)) {
      case ros1::kChunk:
        chunk(record);
        break;
      case ros1::kIndex:
        index(record);
        break;
      case ros1::kConnection:
        connection(record);
        break;
      case ros1::kChunkInfo:
        infos_[record.at] = number<std::uint64_t>(record, "chunk_pos");
        entries(record, 8);
        break;
      default:
        fail(record.at,
             fmt::format("a record of kind {} is not allowed outside chunks: the file is damaged", op(record)));
    }
  }

  void connection(const CheckedRecord& record) {
    connections_.insert(number<std::uint32_t>(record, "conn"));
    if (!record.fields.contains("topic")) fail(record.at, "a connection record names no topic: the file is damaged");
    if (record.data_bytes > kRecordHeaderMax)
      fail(record.at, "a connection record is larger than 1 MiB, which is the maximum");
    fields(record.at, text(record.data_at, record.data_bytes));  // has the form of a header
  }

  void chunk(const CheckedRecord& record) {
    const std::uint32_t size = number<std::uint32_t>(record, "size");
    const auto found = record.fields.find("compression");
    const std::string compression = found == record.fields.end() ? "" : found->second;
    chunks_.insert(record.at);
    messages_.reset();
    chunk_bytes_ = size;
    if (size > kChunkMax) fail(record.at, fmt::format("a chunk has {} bytes; at most 1 GiB can be read", size));
    if (compression == "bz2" || compression == "lz4") return;
    if (compression != "none")
      fail(record.at,
           fmt::format("the compression '{}' of a chunk is not supported; supported: none, bz2 and lz4", compression));
    if (size != record.data_bytes) {
      fail(record.at,
           fmt::format("an uncompressed chunk has {} bytes, but states a size of {} bytes: the file is damaged",
                       record.data_bytes, size));
    }
    messages_.emplace();
    for (std::uint64_t at = record.data_at; at < record.end();) {
      const CheckedRecord inner = this->record(at, record.end());
      if (op(inner) == ros1::kConnection)
        connection(inner);
      else if (op(inner) == ros1::kMessage)
        message(inner, at - record.data_at);
      else
        fail(at, fmt::format("a record of kind {} is not allowed in a chunk: the file is damaged", op(inner)));
      at = inner.end();
    }
  }

  void message(const CheckedRecord& record, std::uint64_t offset) {
    if (!connections_.contains(number<std::uint32_t>(record, "conn")))
      fail(record.at, "a message refers to a connection that does not exist: the file is damaged");
    number<std::uint64_t>(record, "time");
    messages_->insert(offset);
  }

  std::uint32_t entries(const CheckedRecord& record, std::uint32_t each) const {
    const std::uint32_t count = number<std::uint32_t>(record, "count");
    if (std::uint64_t{count} * each != record.data_bytes) {
      fail(record.at,
           fmt::format("an index record states {} entries of {} bytes each, but has {} bytes: the file is damaged",
                       count, each, record.data_bytes));
    }
    return count;
  }

  void index(const CheckedRecord& record) {
    constexpr std::uint32_t kEntry = 12, kPlace = 8;
    if (chunks_.empty()) fail(record.at, "an index record precedes the first chunk: the file is damaged");
    const std::uint32_t count = entries(record, kEntry);
    const std::string bytes = text(record.data_at, record.data_bytes);
    for (std::uint32_t i = 0; i < count; ++i) {
      std::uint32_t offset = 0;
      std::memcpy(&offset, bytes.data() + i * kEntry + kPlace, sizeof(offset));
      if (messages_ ? messages_->contains(offset) : offset < chunk_bytes_) continue;
      fail(record.at, fmt::format("entry {} of an index record points to byte {} of its chunk, where no message "
                                  "starts: the file is damaged",
                                  i, offset));
    }
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t bytes_ = 0;
  std::set<std::uint64_t> chunks_;
  std::map<std::uint64_t, std::uint64_t> infos_;  ///< position of record, position of chunk
  std::set<std::uint32_t> connections_;
  std::optional<std::set<std::uint64_t>> messages_;  ///< message offsets; empty: compressed chunk
  std::uint32_t chunk_bytes_ = 0;
};

}  // namespace

void check_ros1_bag(const std::filesystem::path& file) {
  Walk(file).all();
}

}  // namespace tumble::scenarios
