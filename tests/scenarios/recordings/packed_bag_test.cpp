// SPDX-License-Identifier: BSD-3-Clause
// The test checks ROS 2 bags that were compressed by Zstandard during recording.
#include <SQLiteCpp/SQLiteCpp.h>
#include <zstd.h>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

std::string packed_by_zstd(std::string_view plain) {
  std::string out(ZSTD_compressBound(plain.size()), '\0');
  out.resize(ZSTD_compress(out.data(), out.size(), plain.data(), plain.size(), 1));
  return out;
}

/// PackedBag is a ROS 2 bag as `ros2 bag record --compression-format zstd` writes it.
class PackedBag : public test::TemporaryFolder {
 protected:
  PackedBag() {
    sim::Sensors sensors = fixture::recording().sensors;
    for (std::uint32_t& offset : sensors.lidars[0].offset_ns) offset *= 600;  // points cover most of a sweep
    sensors.imus.resize(1);
    for (Vector3d& force : sensors.imus[0].accel_m_s2) force = Vector3d(0.0, 0.0, 9.8);
    export_ros2_bag(sensors, {}, bag_);
    plain_ = import_ros2_bag(bag_, {});
  }
  void state(const std::string& mode, const std::string& file) {
    std::string text = test::read_file(bag_ / "metadata.yaml");
    const auto put = [&](const std::string& from, const std::string& to) {
      const std::size_t at = text.find(from);
      ASSERT_NE(at, std::string::npos) << from;
      text.replace(at, from.size(), to);
    };
    put("compression_format: \"\"", "compression_format: zstd");
    put("compression_mode: \"\"", "compression_mode: " + mode);
    put("- bag_0.db3", "- " + file);
    fixture::put(bag_ / "metadata.yaml", text);
  }
  void pack_file() {
    packed_ = packed_by_zstd(test::read_file(bag_ / "bag_0.db3"));
    fs::remove(bag_ / "bag_0.db3");
    fixture::put(bag_ / "bag_0.db3.zstd", packed_);
    state("FILE", "bag_0.db3.zstd");
  }
  /// Replaces each message by the result of `make`.
  void pack_messages(const std::function<std::string(std::string_view)>& make) {
    SQLite::Database database((bag_ / "bag_0.db3").string(), SQLite::OPEN_READWRITE);
    SQLite::Statement query(database, "SELECT id, data FROM messages");
    std::vector<std::pair<int, std::string>> packed;
    while (query.executeStep())
      packed.emplace_back(query.getColumn(0).getInt(), make({static_cast<const char*>(query.getColumn(1).getBlob()),
                                                             static_cast<std::size_t>(query.getColumn(1).getBytes())}));
    SQLite::Statement update(database, "UPDATE messages SET data = ? WHERE id = ?");
    for (const auto& [id, bytes] : packed) {
      update.bind(1, bytes.data(), static_cast<int>(bytes.size()));
      update.bind(2, id);
      update.exec();
      update.reset();
    }
  }
  std::string complaint() {
    return test::complaint([&] { import_ros2_bag(bag_, {}); });
  }
  void expect_all_is_there(const Imported& read) {
    EXPECT_EQ(read.sensors.imus.at(0).gyro_rad_s, plain_.sensors.imus.at(0).gyro_rad_s);
    EXPECT_EQ(read.sensors.imus.at(0).time_ns, plain_.sensors.imus.at(0).time_ns);
    EXPECT_EQ(read.sensors.lidars.at(0).position_L_m, plain_.sensors.lidars.at(0).position_L_m);
  }
  static std::size_t left_behind() {
    std::size_t count = 0;
    for (const auto& entry : fs::directory_iterator(fs::temp_directory_path()))
      count += entry.path().filename().string().starts_with("tumble-bag-");
    return count;
  }
  fs::path bag_ = folder_ / "bag";

  Imported plain_;
  std::string packed_;
};

TEST_F(PackedBag, FilesAreUnpackedAndNothingIsLeft) {
  pack_file();
  const std::size_t before = left_behind();
  expect_all_is_there(import_ros2_bag(bag_, {}));
  expect_all_is_there(import_ros2_bag(bag_ / "bag_0.db3.zstd", {}));
  for (const std::size_t size : {std::size_t{0}, std::size_t{3}, packed_.size() / 2, packed_.size() - 1}) {
    fixture::put(bag_ / "bag_0.db3.zstd", packed_.substr(0, size));
    EXPECT_THAT(complaint(), HasSubstr("bag_0.db3.zstd: the Zstandard frame is")) << size;
  }
  fixture::put(bag_ / "bag_0.db3.zstd", "none" + packed_);
  EXPECT_THAT(complaint(), HasSubstr("bag_0.db3.zstd: the Zstandard frame is damaged"));
  EXPECT_LE(left_behind(), before);
}

// zeros are compressed to a part in thirty thousand, which no real bag reaches: such data are rejected during
// decompression
TEST_F(PackedBag, ABombIsRefused) {
  const std::string frame = packed_by_zstd(std::string(1u << 26, '\0'));
  pack_file();
  fixture::put(bag_ / "bag_0.db3.zstd", frame + frame);
  EXPECT_THAT(complaint(), HasSubstr("the unpacked bag has more than"));
}

TEST_F(PackedBag, MessagesAreUnpacked) {
  pack_messages(packed_by_zstd);
  state("message", "bag_0.db3");
  expect_all_is_there(import_ros2_bag(bag_, {}));
  pack_messages([](std::string_view packed) { return std::string(packed.substr(0, packed.size() / 2)); });
  EXPECT_THAT(complaint(),
              HasSubstr("bag: message 0 of /tf_static: the decompressed Zstandard frame has too few bytes"));
  const std::string bomb = packed_by_zstd(std::string(72u << 20, '\0'));
  pack_messages([&](std::string_view) { return bomb; });
  EXPECT_THAT(complaint(), HasSubstr("message 0 of /tf_static: the content of the message is not a valid Zstandard "
                                     "frame, or the stated size exceeds 64 MiB"));
  pack_messages([](std::string_view) { return std::string("plain"); });
  EXPECT_THAT(complaint(), HasSubstr("message 0 of /tf_static: the content of the message is not a valid Zstandard "
                                     "frame, or the stated size exceeds 64 MiB"));
}

TEST_F(PackedBag, OtherWaysOfPackingAreNamed) {
  state("storage", "bag_0.db3");
  EXPECT_THAT(complaint(), HasSubstr("'zstd' and mode 'storage'; supported: zstd with mode file or message"));
}

}  // namespace
}  // namespace tumble::scenarios
