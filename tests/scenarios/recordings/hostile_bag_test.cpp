// SPDX-License-Identifier: BSD-3-Clause
// The test checks bags as other programs compress them, damaged bags, and files that are no bags.
#include <SQLiteCpp/SQLiteCpp.h>
#include <lz4frame.h>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/ros1_chunks.hpp"
#include "scenarios/recordings/bags/ros2_metadata.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

using HostileBag = test::TemporaryFolder;

/// Compresses a chunk as other programs do: blocks that depend on the earlier ones, checksums, and the size of the
/// content.
void pack_lz4(Ros1Chunk& chunk) {
  LZ4F_preferences_t how{};
  how.frameInfo.blockMode = LZ4F_blockLinked;
  how.frameInfo.blockSizeID = LZ4F_max64KB;
  how.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
  how.frameInfo.contentSize = chunk.data.size();
  std::string packed(LZ4F_compressFrameBound(chunk.data.size(), &how), '\0');
  packed.resize(LZ4F_compressFrame(packed.data(), packed.size(), chunk.data.data(), chunk.data.size(), &how));
  chunk.data = packed;
  chunk.compression = "lz4";
}

class Lz4Bag : public test::TemporaryFolder {
 protected:
  Lz4Bag() {
    // a chunk needs several blocks, because the first one depends on no other
    sim::ImuRecord& imu = sensors_.imus[0];
    imu.time_ns.clear(), imu.gyro_rad_s.clear(), imu.accel_m_s2.clear();
    for (int k = 0; k < 600; ++k) {
      imu.time_ns.push_back(2'500'000LL * k);
      imu.gyro_rad_s.emplace_back(std::sin(0.37 * k), std::cos(1.1 * k), 0.2);
      imu.accel_m_s2.emplace_back(0.3 * std::sin(k), 0.1, 9.8);
    }
    imu.clip_flags.assign(imu.time_ns.size(), 0);
    export_ros1_bag(sensors_, {}, folder_ / "plain.bag");
    copy_ros1_bag(folder_ / "plain.bag", folder_ / "lz4.bag", pack_lz4);
  }
  std::string complaint_of(const std::string& bytes) {
    fixture::put(folder_ / "b.bag", bytes);
    return test::complaint([&] { import_ros1_bag(folder_ / "b.bag", {}); });
  }
  sim::Sensors sensors_ = fixture::small_sensors();
};

TEST_F(Lz4Bag, IsReadLikeAPlainOne) {
  EXPECT_TRUE(has_lz4_chunks(folder_ / "lz4.bag"));
  EXPECT_FALSE(has_lz4_chunks(folder_ / "plain.bag"));
  // the memory that decompression requests: the chunks' own lengths differ only by the headers
  EXPECT_NEAR(static_cast<double>(bytes_unpacked(folder_ / "lz4.bag")),
              static_cast<double>(fs::file_size(folder_ / "plain.bag")), 16.0);
  EXPECT_GT(bytes_unpacked(folder_ / "lz4.bag"), fs::file_size(folder_ / "lz4.bag"));
  const Imported plain = import_ros1_bag(folder_ / "plain.bag", {}), lz4 = import_ros1_bag(folder_ / "lz4.bag", {});
  EXPECT_EQ(digest(lz4.sensors, nullptr), digest(plain.sensors, nullptr));
  ASSERT_EQ(lz4.sensors.imus.size(), 1u);
  EXPECT_EQ(lz4.sensors.imus[0].gyro_rad_s, sensors_.imus[0].gyro_rad_s);
  // decompression must give the original bytes
  copy_ros1_bag(folder_ / "lz4.bag", folder_ / "back.bag", unpack_lz4);
  EXPECT_EQ(test::read_file(folder_ / "back.bag"), test::read_file(folder_ / "plain.bag"));
}

TEST_F(Lz4Bag, DamageIsOneLine) {
  const std::string whole = test::read_file(folder_ / "lz4.bag");
  int refused = 0;
  for (std::size_t at = 0; at < whole.size(); at += 397) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0xff);
    const std::string complaint = complaint_of(bytes);
    EXPECT_THAT(complaint, Not(HasSubstr("\n")));
    refused += complaint.empty() ? 0 : 1;
  }
  EXPECT_GT(refused, 10);
  const auto states = [](std::int64_t change) {
    return [change](Ros1Chunk& chunk) {
      pack_lz4(chunk);
      chunk.unpacked_bytes = static_cast<std::uint32_t>(chunk.unpacked_bytes + change);
    };
  };
  copy_ros1_bag(folder_ / "plain.bag", folder_ / "more.bag", states(-1));
  EXPECT_THAT(test::complaint([&] { import_ros1_bag(folder_ / "more.bag", {}); }),
              HasSubstr("the decompressed LZ4 frame has too many bytes"));
  copy_ros1_bag(folder_ / "plain.bag", folder_ / "fewer.bag", states(1));
  EXPECT_THAT(test::complaint([&] { import_ros1_bag(folder_ / "fewer.bag", {}); }),
              HasSubstr("bytes, but its stated size is"));
}

// a bag is rejected or read: it never ends the program, whichever byte of it is missing or changed
TEST_F(HostileBag, EveryCutOfARos1BagIsOneLine) {
  export_ros1_bag(fixture::small_sensors(), {}, folder_ / "a.bag");
  const std::string whole = test::read_file(folder_ / "a.bag");
  ASSERT_GT(whole.size(), 5000u);
  for (std::size_t size = 0; size < whole.size(); size += size < 100 ? 7 : 499) {
    fixture::put(folder_ / "cut.bag", whole.substr(0, size));
    EXPECT_THAT(test::complaint([&] { import_ros1_bag(folder_ / "cut.bag", {}); }), HasSubstr("cut.bag: at byte "))
        << size;
  }
}

TEST_F(HostileBag, ChangedBytesOfARos1BagNeverCrash) {
  export_ros1_bag(fixture::small_sensors(), {}, folder_ / "a.bag");
  const std::string whole = test::read_file(folder_ / "a.bag");
  int refused = 0, read = 0;
  for (std::size_t at = 0; at < whole.size(); at += 61) {
    std::string bytes = whole;
    bytes[at] = static_cast<char>(bytes[at] ^ 0xff);
    fixture::put(folder_ / "b.bag", bytes);
    const std::string complaint = test::complaint([&] { import_ros1_bag(folder_ / "b.bag", {}); });
    EXPECT_THAT(complaint, Not(HasSubstr("\n")));
    complaint.empty() ? ++read : ++refused;
  }
  EXPECT_GT(refused, 10);
  EXPECT_GT(read, 20) << "a reading or a text may change without harm";
}

TEST_F(HostileBag, DamagedRos2BagsAreOneLine) {
  const fs::path bag = folder_ / "bag";
  export_ros2_bag(fixture::small_sensors(), {}, bag);
  const auto complaint = [&] { return test::complaint([&] { import_ros2_bag(bag, {}); }); };
  ASSERT_EQ(complaint(), "");
  const std::string database = test::read_file(bag / "bag_0.db3"), metadata = test::read_file(bag / "metadata.yaml");
  EXPECT_EQ(test::complaint([&] { import_ros2_bag(bag / "bag_0.db3", {}); }), "") << "the file alone is read too";
  for (const std::size_t size : {std::size_t{0}, std::size_t{100}, std::size_t{5000}, database.size() / 2}) {
    fixture::put(bag / "bag_0.db3", database.substr(0, size));
    EXPECT_THAT(complaint(), HasSubstr("bag_0.db3: the file cannot be read as a ROS 2 bag")) << size;
  }
  fs::remove(bag / "bag_0.db3");
  EXPECT_THAT(complaint(), HasSubstr("bag_0.db3: the file does not exist"));
  fixture::put(bag / "bag_0.db3", database);
  fixture::put(bag / "metadata.yaml", metadata.substr(0, metadata.size() / 2));
  EXPECT_THAT(complaint(), HasSubstr("metadata.yaml"));
  std::string mcap = metadata;
  mcap.replace(mcap.find("sqlite3"), 7, "mcbp");
  fixture::put(bag / "metadata.yaml", mcap);
  EXPECT_THAT(complaint(), HasSubstr("the storage_identifier in metadata.yaml is 'mcbp'; it must be sqlite3 or mcap"));
  fs::remove(bag / "metadata.yaml");
  EXPECT_EQ(complaint(), "");
  fixture::put(bag / "other_0.db3", database);
  EXPECT_THAT(complaint(), HasSubstr("no metadata.yaml, and the names of its bag files differ in more than a number"));
  fs::remove(bag / "other_0.db3"), fs::remove(bag / "bag_0.db3");
  EXPECT_THAT(complaint(), HasSubstr("no metadata.yaml, so it is not a ROS 2 bag"));
}

// without the definitions a reader that knows no ROS cannot interpret a message
TEST_F(HostileBag, ARos2BagBringsTheDefinitionsOfItsMessages) {
  export_ros2_bag(fixture::small_sensors(), {}, folder_ / "bag");
  SQLite::Database database((folder_ / "bag/bag_0.db3").string(), SQLite::OPEN_READONLY);
  EXPECT_EQ(database.execAndGet("SELECT schema_version FROM schema").getInt(), 4);
  SQLite::Statement query(database,
                          "SELECT type, encoding, encoded_message_definition FROM topics LEFT JOIN message_definitions "
                          "ON type = topic_type");
  int topics = 0;
  for (; query.executeStep(); ++topics) {
    EXPECT_EQ(query.getColumn(1).getString(), "ros2msg");
    EXPECT_EQ(query.getColumn(2).getString(), ros2_definition(ros1_type(query.getColumn(0).getString())));
  }
  EXPECT_EQ(topics, 4) << "/tf_static, /clock, /imu, /lidar/points";
}

// a topic that was recorded without any message is no reason to reject the rest
TEST_F(HostileBag, TopicsWithoutMessagesAreLeftOutUnlessNamed) {
  const fs::path bag = folder_ / "bag";
  for (const char* topic : {"/imu", "/lidar/points"}) {
    fs::remove_all(bag);
    export_ros2_bag(fixture::small_sensors(), {}, bag);
    SQLite::Database database((bag / "bag_0.db3").string(), SQLite::OPEN_READWRITE);
    database.exec(std::string("DELETE FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name = '") + topic +
                  "')");
    const Imported imported = import_ros2_bag(bag, {});
    EXPECT_THAT(imported.notes, Contains(topic + std::string(": the topic has no messages and is left out")));
    EXPECT_EQ(imported.sensors.lidars.size(), topic == std::string("/imu") ? 1u : 0u);
    BagReading named;
    (topic == std::string("/imu") ? named.imu_topics : named.lidar_topics) = {topic};
    EXPECT_THAT(test::complaint([&] { import_ros2_bag(bag, named); }), HasSubstr(topic));
  }
}

TEST_F(HostileBag, CloudsOfATypeThatIsNotReadAreACaution) {
  const fs::path bag = folder_ / "bag";
  export_ros2_bag(fixture::small_sensors(), {}, bag);
  SQLite::Database database((bag / "bag_0.db3").string(), SQLite::OPEN_READWRITE);
  for (const std::string type : {"point_cloud_interfaces/msg/CompressedPointCloud2", "sensor_msgs/msg/PointCloud",
                                 "velodyne_msgs/msg/VelodyneScan"}) {
    database.exec("UPDATE topics SET type = '" + type + "' WHERE name = '/lidar/points'");
    const Imported imported = import_ros2_bag(bag, {});
    EXPECT_TRUE(imported.sensors.lidars.empty());
    EXPECT_THAT(imported.notes, Contains(AllOf(HasSubstr("/lidar/points: caution: "), HasSubstr("the import skips"))))
        << type;
  }
}

TEST_F(HostileBag, AMessageThatPromisesTooMuchAllocatesNothing) {
  const fs::path bag = folder_ / "bag";
  for (const bool field_count : {false, true}) {
    fs::remove_all(bag);
    export_ros2_bag(fixture::small_sensors(), {}, bag);
    SQLite::Database database((bag / "bag_0.db3").string(), SQLite::OPEN_READWRITE);
    SQLite::Statement query(database,
                            "SELECT id, data FROM messages WHERE topic_id = (SELECT id FROM topics WHERE name = "
                            "'/lidar/points') ORDER BY timestamp");
    ASSERT_TRUE(query.executeStep());
    const SQLite::Column blob = query.getColumn(1);
    std::string bytes(static_cast<const char*>(blob.getBlob()), static_cast<std::size_t>(blob.getBytes()));
    // the header has 4 bytes of encapsulation, 8 of stamp and 4 + 6 of frame; height and width follow at 24, and the
    // number of fields at 32
    const std::uint32_t absurd = 0xfffffff0u;
    const std::size_t at = field_count ? 32 : 28;
    std::copy_n(reinterpret_cast<const char*>(&absurd), 4, bytes.begin() + static_cast<std::ptrdiff_t>(at));
    SQLite::Statement update(database, "UPDATE messages SET data = ? WHERE id = ?");
    update.bind(1, bytes.data(), static_cast<int>(bytes.size()));
    update.bind(2, query.getColumn(0).getInt());
    query.reset();
    update.exec();
    EXPECT_THAT(test::complaint([&] { import_ros2_bag(bag, {}); }),
                field_count
                    ? HasSubstr("message 0 of /lidar/points: the message states 4294967280 entries of 13 bytes")
                    : HasSubstr("message 0 of /lidar/points: the cloud has 1 x 4294967280 points of 26 bytes each"));
  }
}

TEST_F(HostileBag, WhatIsNoBagIsSaid) {
  fixture::put(folder_ / "a.bag", "hello");
  EXPECT_THAT(test::complaint([&] { import_ros1_bag(folder_ / "a.bag", {}); }), HasSubstr("not a ROS 1 bag"));
  EXPECT_THAT(test::complaint([&] { import_ros1_bag(folder_ / "none.bag", {}); }), HasSubstr("no such file"));
  EXPECT_THAT(test::complaint([&] { export_ros1_bag(fixture::small_sensors(), {}, folder_ / "none" / "a.bag"); }),
              HasSubstr("cannot be written"));
  EXPECT_EQ(files(), 1u) << "nothing is left of it";
}
}  // namespace
}  // namespace tumble::scenarios
