// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/ros1_chunks.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <map>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/bags/packed.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::uint64_t kMagicBytes = 13;  // "#ROSBAG V2.0\n"

struct RawRecord {
  std::uint64_t at = 0;
  std::string header;
  std::uint32_t data_bytes = 0;

  std::optional<std::pair<std::size_t, std::size_t>> find(const std::string& name) const {
    for (std::size_t place = 0; place + 4 <= header.size();) {
      std::uint32_t size = 0;
      std::memcpy(&size, header.data() + place, 4);
      const std::size_t begin = place + 4;
      if (header.compare(begin, name.size() + 1, name + "=") == 0)
        return std::pair{begin + name.size() + 1, size - name.size() - 1};
      place = begin + size;
    }
    return std::nullopt;
  }
  std::string text(const std::string& name) const {
    const auto found = find(name);
    return found ? header.substr(found->first, found->second) : "";
  }
  template <class Number>
  Number number(const std::string& name) const {
    Number value{};
    const std::string bytes = text(name);
    if (bytes.size() == sizeof(value)) std::memcpy(&value, bytes.data(), sizeof(value));
    return value;
  }
  template <class Number>
  void set(const std::string& name, Number value) {
    const auto found = find(name);
    if (found && found->second == sizeof(value)) std::memcpy(header.data() + found->first, &value, sizeof(value));
  }
  std::uint8_t op() const { return number<std::uint8_t>("op"); }
};

void append_field(std::string& header, const std::string& field) {
  const auto size = static_cast<std::uint32_t>(field.size());
  header.append(reinterpret_cast<const char*>(&size), sizeof(size)).append(field);
}

template <class Number>
std::string bytes_of(Number value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

class Records {
 public:
  explicit Records(const std::filesystem::path& path) : path_(path), stream_(path, std::ios::binary) {
    bytes_ = std::filesystem::file_size(path);
    magic_ = text(kMagicBytes);
  }
  const std::string& magic() const { return magic_; }
  bool next(RawRecord& record) {
    if (at_ >= bytes_) return false;
    record.at = at_;
    record.header = text(length());
    record.data_bytes = length();
    data_left_ = record.data_bytes;
    return true;
  }
  std::string data() {
    const std::uint32_t size = data_left_;
    data_left_ = 0;
    return text(size);
  }
  void skip() {
    stream_.seekg(data_left_, std::ios::cur);
    at_ += data_left_;
  }
  [[noreturn]] void fail(std::uint64_t at, const std::string& what) const {
    throw BadInput(path_.string() + ": at byte " + std::to_string(at) + ": " + what);
  }

 private:
  std::uint32_t length() {
    std::uint32_t value = 0;
    std::memcpy(&value, text(sizeof(value)).data(), sizeof(value));
    return value;
  }
  std::string text(std::uint64_t size) {
    std::string out(size, '\0');
    if (!stream_.read(out.data(), static_cast<std::streamsize>(size))) fail(at_, "cannot be read");
    at_ += size;
    return out;
  }

  std::filesystem::path path_;
  std::ifstream stream_;
  std::uint64_t bytes_ = 0, at_ = 0;
  std::uint32_t data_left_ = 0;
  std::string magic_;
};

class Copy {
 public:
  explicit Copy(const std::filesystem::path& path) : path_(path), stream_(path, std::ios::binary) {}
  std::uint64_t write(const RawRecord& record, const std::string& data) {
    const std::uint64_t at = at_;
    put(bytes_of(static_cast<std::uint32_t>(record.header.size())));
    put(record.header);
    put(bytes_of(static_cast<std::uint32_t>(data.size())));
    put(data);
    return at;
  }
  void put(const std::string& text) {
    stream_.write(text.data(), static_cast<std::streamsize>(text.size()));
    at_ += text.size();
  }
  void overwrite(std::uint64_t at, const std::string& text) {
    stream_.seekp(static_cast<std::streamoff>(at));
    stream_.write(text.data(), static_cast<std::streamsize>(text.size()));
  }
  void finish() {
    if (!stream_.flush())
      throw BadInput(fmt::format(
          "{}: the file cannot be written; the disk may have too little space for the unpacked bag", path_.string()));
  }

 private:
  std::filesystem::path path_;
  std::ofstream stream_;
  std::uint64_t at_ = 0;
};

std::string changed_chunk(RawRecord& record, std::string data, const std::function<void(Ros1Chunk&)>& change) {
  Ros1Chunk chunk{record.text("compression"), record.number<std::uint32_t>("size"), std::move(data)};
  change(chunk);
  record.header.clear();
  append_field(record.header, "compression=" + chunk.compression);
  append_field(record.header, "op=" + std::string(1, static_cast<char>(ros1::kChunk)));
  append_field(record.header, "size=" + bytes_of(chunk.unpacked_bytes));
  return std::move(chunk.data);
}

}  // namespace

bool has_lz4_chunks(const std::filesystem::path& file) {
  Records records(file);
  for (RawRecord record; records.next(record); records.skip()) {
    if (record.op() == ros1::kChunk && record.text("compression") == "lz4") return true;
  }
  return false;
}

std::uint64_t bytes_unpacked(const std::filesystem::path& file) {
  Records records(file);
  std::uint64_t bytes = std::filesystem::file_size(file);
  for (RawRecord record; records.next(record); records.skip()) {
    if (record.op() != ros1::kChunk || record.text("compression") != "lz4") continue;
    bytes = bytes - record.data_bytes + record.number<std::uint32_t>("size");
  }
  return bytes;
}

void copy_ros1_bag(const std::filesystem::path& from, const std::filesystem::path& to,
                   const std::function<void(Ros1Chunk&)>& change) {
  Records records(from);
  Copy copy(to);
  copy.put(records.magic());
  std::map<std::uint64_t, std::uint64_t> places;  // old and new positions of records
  std::optional<RawRecord> first;
  std::uint64_t first_at = 0;
  for (RawRecord record; records.next(record);) {
    const std::uint64_t before = record.at;
    std::string data = records.data();
    if (record.op() == ros1::kChunk) {
      try {
        data = changed_chunk(record, std::move(data), change);
      } catch (const BadInput& error) {
        records.fail(before, error.what());
      }
    }
    if (record.op() == ros1::kChunkInfo) {
      const auto chunk = places.find(record.number<std::uint64_t>("chunk_pos"));
      if (chunk == places.end())
        records.fail(before,
                     "the index of the bag refers to a chunk that does not precede the index: the file is damaged");
      record.set("chunk_pos", chunk->second);
    }
    places[before] = copy.write(record, data);
    if (record.op() == ros1::kFile && !first) first = record, first_at = places[before];
  }
  const auto index = first ? places.find(first->number<std::uint64_t>("index_pos")) : places.end();
  if (index == places.end())
    records.fail(kMagicBytes,
                 "the bag header states the position of the index, but no record starts there: the file is damaged");
  copy.overwrite(first_at + 4 + first->find("index_pos")->first, bytes_of(index->second));
  copy.finish();
}

void unpack_lz4(Ros1Chunk& chunk) {
  chunk.data = unpacked_lz4(chunk.data, chunk.unpacked_bytes);
  chunk.compression = "none";
}

}  // namespace tumble::scenarios
