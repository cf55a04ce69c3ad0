// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <zlib.h>
#include <zstd.h>

#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/bags/mcap_records.hpp"
#include "scenarios/recordings/bags/packed.hpp"
#include "scenarios/recordings/bags/ros2_metadata.hpp"
#include "scenarios/recordings/bags/ros_bytes.hpp"
#include "tests/testing.hpp"

/// The functions here write MCAP files as other programs do, and malformed ones: the same messages of one IMU in every
/// variant of the format, with a false value at any position.
namespace tumble::scenarios::fixture {

/// A Logged is one message as the file contains it.
struct Logged {
  std::uint64_t time_ns;
  std::string bytes;
};

/// Returns the messages of a sphere at rest, one reading every 10 ms, as CDR.
inline std::vector<Logged> imu_messages(std::size_t count) {
  sim::ImuRecord imu;
  imu.period_ns = 10'000'000;
  std::vector<Logged> out;
  for (std::size_t k = 0; k < count; ++k) {
    imu.gyro_rad_s.emplace_back(0.001 * static_cast<double>(k), 0.0, 0.0);
    imu.accel_m_s2.emplace_back(0.0, 0.1, 9.8);
    const std::int64_t stamp = 1'000'000'000 + 10'000'000 * static_cast<std::int64_t>(k);
    const ros::Bytes bytes = ros::to_cdr(imu_message(imu, k, header_of(stamp, "imu")));
    out.push_back({static_cast<std::uint64_t>(stamp), {bytes.begin(), bytes.end()}});
  }
  return out;
}

/// McapShape describes how a file is assembled. Each `change` may damage a record before it is written; the following
/// records are consistent with the damaged one.
struct McapShape {
  std::vector<std::vector<Logged>> chunks;
  std::string compression;  ///< "", "lz4", "zstd", or an unknown name
  bool chunked = true, message_index = true, summary = true, statistics = true, repeat_channels = true, crcs = true;
  mcap::Schema schema{1, "sensor_msgs/msg/Imu", "ros2msg", ros2_definition("sensor_msgs/Imu")};
  mcap::Channel channel{1, 1, "/imu", "cdr", {}};
  std::function<void(mcap::Chunk&)> chunk = [](mcap::Chunk&) {};
  std::function<void(std::string&)> chunk_records = [](std::string&) {};
  std::function<void(mcap::MessageIndex&)> index = [](mcap::MessageIndex&) {};
  std::function<void(std::vector<mcap::ChunkIndex>&)> chunk_index = [](std::vector<mcap::ChunkIndex>&) {};
  std::function<void(mcap::Statistics&)> counts = [](mcap::Statistics&) {};
  std::function<void(mcap::DataEnd&)> data_end = [](mcap::DataEnd&) {};
  std::function<void(mcap::Footer&)> footer = [](mcap::Footer&) {};
};

inline std::uint32_t crc_by_zlib(const std::string& bytes) {
  return static_cast<std::uint32_t>(
      ::crc32(0, reinterpret_cast<const Bytef*>(bytes.data()), static_cast<uInt>(bytes.size())));
}

inline std::string packed_zstd(const std::string& plain) {
  std::string out(ZSTD_compressBound(plain.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1));
  return out;
}

inline std::string mcap_bytes(const McapShape& shape) {
  using namespace mcap;
  std::string file = std::string(kMagic) + to_bytes(Header{"ros2", "a test"});
  Statistics counts;
  counts.schema_count = 1, counts.channel_count = 1;
  std::vector<ChunkIndex> chunk_index;
  const std::string description = to_bytes(shape.schema) + to_bytes(shape.channel);
  for (const std::vector<Logged>& messages : shape.chunks) {
    std::string records = description;
    MessageIndex index{shape.channel.id, {}};
    std::uint64_t first = ~std::uint64_t{0}, last = 0;
    for (const Logged& each : messages) {
      index.entries.emplace_back(each.time_ns, records.size());
      records += to_bytes(Message{shape.channel.id, 0, each.time_ns, each.time_ns}, each.bytes);
      first = std::min(first, each.time_ns), last = std::max(last, each.time_ns);
      ++counts.message_count, ++counts.channel_message_counts[shape.channel.id];
    }
    if (!shape.chunked) {
      file += records;
      continue;
    }
    shape.chunk_records(records);
    const std::string packed = shape.compression == "lz4"    ? packed_lz4(records)
                               : shape.compression == "zstd" ? packed_zstd(records)
                                                             : records;
    Chunk chunk{first, last, records.size(), shape.crcs ? crc_by_zlib(records) : 0, shape.compression, packed.size()};
    shape.chunk(chunk);
    ++counts.chunk_count;
    const std::uint64_t at = file.size();
    const std::string record = to_bytes(chunk, packed);
    file += record;
    ChunkIndex entry{
        chunk.message_start_time, chunk.message_end_time, at, record.size(), {}, 0, chunk.compression, packed.size(),
        chunk.uncompressed_size};
    if (shape.message_index) {
      shape.index(index);
      entry.message_index_offsets[shape.channel.id] = file.size();
      file += to_bytes(index);
      entry.message_index_length = file.size() - at - record.size();
    }
    chunk_index.push_back(entry);
  }
  DataEnd end{shape.crcs ? crc_by_zlib(file) : 0};
  shape.data_end(end);
  file += to_bytes(end);
  Footer footer;
  std::string summary;
  if (shape.summary) {
    footer.summary_start = file.size();
    if (shape.repeat_channels) summary += description;
    shape.counts(counts);
    if (shape.statistics) summary += to_bytes(counts);
    shape.chunk_index(chunk_index);
    const std::uint64_t start = file.size() + summary.size();
    std::uint64_t length = summary.size();
    for (const ChunkIndex& each : chunk_index) summary += to_bytes(each);
    length = summary.size() - length;
    footer.summary_offset_start = file.size() + summary.size();
    if (length > 0) summary += to_bytes(SummaryOffset{kChunkIndex, start, length});
    const std::string head = to_bytes(footer);
    if (shape.crcs) footer.summary_crc = crc_by_zlib(summary + head.substr(0, head.size() - 4));
  }
  shape.footer(footer);
  return file + summary + to_bytes(footer) + std::string(kMagic);
}

}  // namespace tumble::scenarios::fixture
