// SPDX-License-Identifier: BSD-3-Clause
// The test checks that MCAP files of every variant are read alike, and that a false value at any position of one is
// rejected. tests/peers/bags_test.py gives files of this project to other people's readers.
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/mcap_file.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {
namespace {

using fixture::McapShape;

class Mcap : public test::TemporaryFolder {
 protected:
  Mcap() { shape_.chunks = {{messages_.begin(), messages_.begin() + 20}, {messages_.begin() + 20, messages_.end()}}; }
  fs::path file() const { return folder_ / "a.mcap"; }
  Imported read(const std::string& bytes) {
    fixture::put(file(), bytes);
    return import_mcap(file(), {});
  }
  std::string complaint_of(const std::string& bytes) {
    return test::complaint([&] { read(bytes); });
  }
  std::string complaint_of(const McapShape& shape) { return complaint_of(fixture::mcap_bytes(shape)); }
  /// Returns the rates of the messages in the order in which the reader gives them.
  std::vector<double> rates(const std::string& bytes) {
    fixture::put(file(), bytes);
    std::vector<double> out;
    open_mcap({file()})->read("/imu", [&](ros::Bytes& message, std::int64_t) {
      out.push_back(ros::from_cdr<ros::Imu>(message).angular_velocity[0]);
    });
    return out;
  }
  std::vector<fixture::Logged> messages_ = fixture::imu_messages(50);
  McapShape shape_;
};

TEST_F(Mcap, EveryShapeIsReadAlike) {
  const std::string expected = digest(read(fixture::mcap_bytes(shape_)).sensors, nullptr);
  EXPECT_EQ(read(fixture::mcap_bytes(shape_)).sensors.imus.at(0).time_ns.size(), 50u);
  int shapes = 0;
  for (const char* compression : {"", "lz4", "zstd"}) {
    for (int bits = 0; bits < 64; ++bits) {
      shape_.compression = compression;
      shape_.chunked = (bits & 1) == 0, shape_.message_index = (bits & 2) == 0, shape_.summary = (bits & 4) == 0;
      shape_.statistics = (bits & 8) == 0, shape_.repeat_channels = (bits & 16) == 0, shape_.crcs = (bits & 32) == 0;
      ASSERT_EQ(digest(read(fixture::mcap_bytes(shape_)).sensors, nullptr), expected) << compression << " " << bits;
      ++shapes;
    }
  }
  EXPECT_EQ(shapes, 192);
}

TEST_F(Mcap, MessagesComeInOrderOfTimeAlsoWhereChunksOverlap) {
  std::vector<std::vector<fixture::Logged>> mixed(4);
  for (std::size_t k = 0; k < messages_.size(); ++k) mixed[(k * 7) % 4].push_back(messages_[messages_.size() - 1 - k]);
  shape_.chunks = mixed;
  std::vector<double> rising;
  for (int k = 0; k < 50; ++k) rising.push_back(0.001 * k);
  for (const bool summary : {true, false}) {
    for (const bool chunked : {true, false}) {
      shape_.summary = summary, shape_.chunked = chunked;
      EXPECT_EQ(rates(fixture::mcap_bytes(shape_)), rising) << summary << chunked;
    }
  }
}

TEST_F(Mcap, MessagesOfRos1AreReadToo) {
  shape_.schema = {1, "sensor_msgs/Imu", "ros1msg", "Header header\n"};
  shape_.channel = {1, 1, "/imu", "ros1", {}};
  for (auto& chunk : shape_.chunks) {
    for (fixture::Logged& each : chunk) {
      ros::Bytes cdr(each.bytes.begin(), each.bytes.end());
      const ros::Bytes plain = ros::to_ros1(ros::from_cdr<ros::Imu>(cdr));
      each.bytes.assign(plain.begin(), plain.end());
    }
  }
  EXPECT_EQ(read(fixture::mcap_bytes(shape_)).sensors.imus.at(0).gyro_rad_s.at(7).x(), 0.007);
}

TEST_F(Mcap, OtherEncodingsAreNamed) {
  shape_.channel.message_encoding = "json";
  EXPECT_THAT(complaint_of(shape_), HasSubstr("the bag contains no messages of type sensor_msgs/Imu"));
  fixture::put(file(), fixture::mcap_bytes(shape_));
  BagReading reading;
  reading.imu_topics = {"/imu"};
  EXPECT_THAT(test::complaint([&] { import_mcap(file(), reading); }),
              HasSubstr("is of type sensor_msgs/msg/Imu as json (ros2msg); it must be sensor_msgs/Imu"));
}

TEST_F(Mcap, AFolderOfRos2MayHoldIt) {
  const std::vector<fixture::Logged> all = messages_;
  fs::create_directories(folder_ / "bag");
  for (const int part : {0, 1}) {
    shape_.chunks = {{all.begin() + 25 * part, all.begin() + 25 * part + 25}};
    fixture::put(folder_ / "bag" / ("b_" + std::to_string(part) + ".mcap"), fixture::mcap_bytes(shape_));
  }
  fixture::put(
      folder_ / "bag" / "metadata.yaml",
      "rosbag2_bagfile_information:\n  storage_identifier: mcap\n  relative_file_paths: [b_0.mcap, b_1.mcap]\n");
  EXPECT_EQ(import_ros2_bag(folder_ / "bag", {}).sensors.imus.at(0).time_ns.size(), 50u);
  fs::remove(folder_ / "bag" / "b_1.mcap");
  EXPECT_THAT(test::complaint([&] { import_ros2_bag(folder_ / "bag", {}); }),
              HasSubstr("b_1.mcap: the file does not exist"));
}

/// A Lie contains a false value and the expected message.
struct Lie {
  const char* name;
  std::function<void(McapShape&)> tell;
  const char* complaint;
};

class McapLie : public Mcap, public testing::WithParamInterface<Lie> {};

TEST_P(McapLie, IsRefusedWithItsPlace) {
  ASSERT_EQ(complaint_of(shape_), "");
  GetParam().tell(shape_);
  const std::string complaint = complaint_of(shape_);
  EXPECT_THAT(complaint, HasSubstr(GetParam().complaint));
  EXPECT_THAT(complaint, HasSubstr("a.mcap: at byte "));
  EXPECT_THAT(complaint, Not(HasSubstr("\n")));
}

const Lie kLies[] = {
    {"ChecksumOfAChunk", [](McapShape& s) { s.chunk = [](mcap::Chunk& c) { ++c.uncompressed_crc; }; },
     "the checksum of the chunk is "},
    {"ChecksumOfAPackedChunk",
     [](McapShape& s) {
       s.compression = "zstd";
       s.chunk = [](mcap::Chunk& c) { ++c.uncompressed_crc; };
     },
     "the checksum of the chunk is "},
    {"ChecksumOfTheData", [](McapShape& s) { s.data_end = [](mcap::DataEnd& d) { ++d.data_section_crc; }; },
     "the checksum of the data is "},
    {"ChecksumOfTheSummary", [](McapShape& s) { s.footer = [](mcap::Footer& f) { ++f.summary_crc; }; },
     "the checksum of the summary is "},
    {"PlaceOfTheSummary", [](McapShape& s) { s.footer = [](mcap::Footer& f) { f.summary_start = 1ull << 60; }; },
     "the summary starts at byte 1152921504606846976"},
    {"PlaceOfTheOffsets",
     [](McapShape& s) {
       s.crcs = false;
       s.footer = [](mcap::Footer& f) { f.summary_offset_start = 9; };
     },
     "the summary offsets start at byte 9"},
    {"GroupOfTheSummary",
     [](McapShape& s) {
       s.crcs = false;
       s.footer = [](mcap::Footer& f) { f.summary_offset_start = f.summary_start; };
     },
     "is not allowed in the summary offset section"},
    {"PlaceOfAMessage", [](McapShape& s) { s.index = [](mcap::MessageIndex& i) { i.entries[3].second += 1; }; },
     "the message index of a chunk lists 20 messages of channel 1, and the chunk contains 20. Number, times and "
     "positions of the messages must be equal: the file is damaged"},
    {"TimeOfAMessage", [](McapShape& s) { s.index = [](mcap::MessageIndex& i) { i.entries[3].first += 1; }; },
     "the message index of a chunk lists"},
    {"MessageLeftOutOfTheIndex", [](McapShape& s) { s.index = [](mcap::MessageIndex& i) { i.entries.pop_back(); }; },
     "the message index of a chunk lists 19 messages of channel 1, and the chunk contains 20"},
    {"ChannelOfAnIndex", [](McapShape& s) { s.index = [](mcap::MessageIndex& i) { i.channel_id = 9; }; },
     "this message index belongs to channel 9, but must belong to channel 1"},
    {"ChunkLeftOutOfTheIndex", [](McapShape& s) { s.chunk_index = [](auto& all) { all.pop_back(); }; },
     "states 2 chunks but contains 1 chunk indexes"},
    {"ChunkTwiceInTheIndex", [](McapShape& s) { s.chunk_index = [](auto& all) { all[1] = all[0]; }; },
     "the chunk index names a chunk of "},
    {"ChunkBeyondTheEnd",
     [](McapShape& s) { s.chunk_index = [](auto& all) { all[1].chunk_start_offset = 1ull << 62; }; },
     "the chunk index names a chunk of "},
    {"LengthOfAChunk", [](McapShape& s) { s.chunk_index = [](auto& all) { all[1].chunk_length = ~0ull; }; },
     "the chunk index names a chunk of 18446744073709551615 bytes"},
    {"PlaceOfAChunk",
     [](McapShape& s) { s.chunk_index = [](auto& all) { --all[0].chunk_length, ++all[0].chunk_start_offset; }; },
     "refers to a record that is not a chunk"},
    {"TimesOfAChunk", [](McapShape& s) { s.chunk_index = [](auto& all) { --all[0].message_end_time; }; },
     "differs from its entry in the chunk index"},
    {"PlaceOfAnIndex", [](McapShape& s) { s.chunk_index = [](auto& all) { all[0].message_index_offsets[1] = 8; }; },
     "must be followed by its message indexes"},
    {"PlaceWithinAnIndex",
     [](McapShape& s) { s.chunk_index = [](auto& all) { all[0].message_index_offsets[1] += 1; }; }, "damaged"},
    {"MessageOutsideOfItsChunk", [](McapShape& s) { s.chunk = [](mcap::Chunk& c) { ++c.message_start_time; }; },
     "a message has the time 1000000000 ns, but its chunk states times from 1000000001"},
    {"NumberOfMessages", [](McapShape& s) { s.counts = [](mcap::Statistics& c) { ++c.channel_message_counts[1]; }; },
     "channel 1 contains 50 messages, but the summary states 51"},
    {"NameOfAPacking", [](McapShape& s) { s.compression = "brotli"; },
     "the compression 'brotli' of a chunk is not supported; supported: none, lz4 and zstd"},
    {"SizeOfAPlainChunk", [](McapShape& s) { s.chunk = [](mcap::Chunk& c) { ++c.uncompressed_size; }; },
     "an uncompressed chunk has "},
    {"SizeOfAnLz4Chunk",
     [](McapShape& s) {
       s.compression = "lz4";
       s.chunk = [](mcap::Chunk& c) { ++c.uncompressed_size; };
     },
     "bytes, but its stated size is"},
    {"BombOfLz4",
     [](McapShape& s) {
       s.compression = "lz4";
       s.chunk = [](mcap::Chunk& c) { c.uncompressed_size = 1u << 28; };
     },
     "cannot hold the 268435456 bytes that the chunk states"},
    {"BombOfZstd",
     [](McapShape& s) {
       s.compression = "zstd";
       s.chunk_records = [](std::string& records) { records.append(50'000'000, '\0'); };
       s.chunk = [](mcap::Chunk& c) { c.uncompressed_size = 1000; };
     },
     "has too many bytes: its stated size is 1000 bytes"},
    {"ChunkBeyondTheBound", [](McapShape& s) { s.chunk = [](mcap::Chunk& c) { c.uncompressed_size = 1ull << 40; }; },
     "a chunk has a size of 1099511627776 bytes; at most 256 MiB can be read"},
    {"LengthOfTheRecords", [](McapShape& s) { s.chunk = [](mcap::Chunk& c) { c.records_size = ~0ull; }; },
     "a chunk states 18446744073709551615 bytes"},
    {"LengthOfARecord", [](McapShape& s) { s.chunk_records = [](std::string& records) { records[8] = '\x7f'; }; },
     "damaged or truncated"},
    {"KindZero", [](McapShape& s) { s.chunk_records = [](std::string& r) { r += std::string(20, '\0'); }; },
     "a record has the kind 0"},
    {"SchemaOfAChannel", [](McapShape& s) { s.channel.schema_id = 7; },
     "channel 1 refers to schema 7, which does not exist"},
    {"NumberOfASchema", [](McapShape& s) { s.schema.id = 0; }, "a schema has the number 0"},
    {"ChannelStatedTwice",
     [](McapShape& s) {
       mcap::Channel other = s.channel;
       other.topic = "/other";
       s.chunk_records = [other](std::string& records) { records += mcap::to_bytes(other); };
     },
     "channel 1 is defined twice with different content"},
    {"MessageWithoutItsFields",
     [](McapShape& s) {
       s.chunk_records = [](std::string& r) { r += std::string("\x05\x02\0\0\0\0\0\0\0\x01\0", 11); };
     },
     "a record of kind 5 needs 4 bytes, but only 0 are left"},
};

INSTANTIATE_TEST_SUITE_P(, McapLie, testing::ValuesIn(kLies),
                         [](const auto& of) { return std::string(of.param.name); });

// without a summary the reader finds the same error while it goes through the file
TEST_F(Mcap, LiesAreFoundWithoutASummaryToo) {
  shape_.summary = false;
  ASSERT_EQ(complaint_of(shape_), "");
  McapShape lie = shape_;
  lie.chunk = [](mcap::Chunk& c) { ++c.uncompressed_crc; };
  EXPECT_THAT(complaint_of(lie), HasSubstr("the checksum of the chunk is "));
  lie = shape_;
  lie.crcs = false;
  lie.chunk_records = [](std::string& records) { records[8] = '\x7f'; };
  EXPECT_THAT(complaint_of(lie), HasSubstr("damaged or truncated"));
  std::string loose = [&] {
    McapShape shape = shape_;
    shape.chunked = shape.crcs = false;
    return fixture::mcap_bytes(shape);
  }();
  ASSERT_EQ(complaint_of(loose), "");
  loose[8 + 1] = '\x7f';  // the length of the header, which is the first record
  EXPECT_NE(complaint_of(loose), "");
}

// every byte of the written file is covered by some checksum
TEST_F(Mcap, AnyChangedByteOfOursIsRefused) {
  export_mcap(fixture::small_sensors(), {}, file());
  const std::string whole = test::read_file(file());
  ASSERT_EQ(complaint_of(whole), "");
  ASSERT_GT(whole.size(), 5000u);
  const std::size_t far = whole.size() - 300;  // the last chunk's index, the offsets and the footer
  for (std::size_t at = 0; at < whole.size(); at += at < 200 || at > far ? 1 : 13) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ (1 << (at % 8)));
    const std::string complaint = complaint_of(bytes);
    ASSERT_THAT(complaint, HasSubstr("a.mcap: at byte ")) << at;
    ASSERT_THAT(complaint, Not(HasSubstr("\n"))) << at;
  }
}

TEST_F(Mcap, AnyCutOfOursIsRefused) {
  export_mcap(fixture::small_sensors(), {}, file());
  const std::string whole = test::read_file(file());
  for (std::size_t size = 0; size < whole.size(); size += size < 100 || size + 100 > whole.size() ? 1 : 97)
    ASSERT_THAT(complaint_of(whole.substr(0, size)), HasSubstr("a.mcap: at byte ")) << size;
  EXPECT_THAT(complaint_of(whole.substr(0, whole.size() / 2)), HasSubstr("repair the file with 'mcap recover'"));
  EXPECT_THAT(complaint_of("hello"),
              HasSubstr("the file does not begin with the magic bytes of MCAP 0, so it is not an MCAP file"));
  EXPECT_THAT(test::complaint([&] { import_mcap(folder_ / "none.mcap", {}); }), HasSubstr("no such file"));
}

TEST_F(Mcap, TheSameRecordingGivesTheSameBytes) {
  export_mcap(fixture::small_sensors(), {}, file());
  export_mcap(fixture::small_sensors(), {}, folder_ / "b.mcap");
  EXPECT_TRUE(test::read_file(file()) == test::read_file(folder_ / "b.mcap"));
  EXPECT_THAT(test::complaint([&] { export_mcap(fixture::small_sensors(), {}, folder_ / "none" / "a.mcap"); }),
              HasSubstr("cannot be written"));
  EXPECT_EQ(files(), 2u) << "nothing is left of it";
}

}  // namespace
}  // namespace tumble::scenarios
