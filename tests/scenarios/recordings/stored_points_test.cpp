// SPDX-License-Identifier: BSD-3-Clause
#include <sys/resource.h>

#include <csignal>
#include <iostream>

#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {
namespace {

/// StoredPoints keeps the points on the disk instead of in the record; the written files must be the same.
class StoredPoints : public test::TemporaryFolder {
 protected:
  /// The recording has columns of several chunks and is written as a bag.
  StoredPoints() {
    fixture::Numbers numbers;
    sim::Recording recording;
    recording.sensors.imus.push_back(fixture::imu_record(numbers, "imu", 400));
    sim::ImuRecord& imu = recording.sensors.imus[0];
    imu.accel_m_s2.assign(imu.accel_m_s2.size(), Vector3d(0.0, 0.0, 9.8));
    fixture::add_lidar(numbers, recording, "lidar", 12, 20000);
    fixture::add_lidar(numbers, recording, "second", 12, 500);
    for (std::uint32_t& offset : recording.sensors.lidars[1].offset_ns) offset *= 50;  // points cover most of a sweep
    for (float& intensity : recording.sensors.lidars[0].intensity)
      intensity *= 200.0f;  // the reader scales the intensity at the end
    export_mcap(recording.sensors, {}, folder_ / "a.mcap");
  }
  Imported read(const fs::path& scratch) {
    BagReading reading;
    reading.sweeps.scratch = scratch;
    return import_mcap(folder_ / "a.mcap", reading);
  }
};

TEST_F(StoredPoints, GiveTheSameFile) {
  const Imported held = read(""), stored = read(folder_);
  ASSERT_EQ(stored.points.size(), 2u);
  EXPECT_EQ(stored.sensors.lidars[0].position_L_m.size(), 0u);
  EXPECT_EQ(stored.points[0].size(), held.sensors.lidars[0].position_L_m.size());
  EXPECT_EQ(stored.notes, held.notes);
  write_recording(folder_ / "held.h5", held.info, held.sensors, nullptr);
  write_recording(folder_ / "stored.h5", stored.info, stored.sensors, stored.points, nullptr);
  EXPECT_EQ(read_info(folder_ / "stored.h5").digest, read_info(folder_ / "held.h5").digest);
  EXPECT_TRUE(test::read_file(folder_ / "stored.h5") == test::read_file(folder_ / "held.h5"));
  EXPECT_EQ(files(), 3u) << "nothing else stays";
  // a file with one different number must be a different file
  Imported changed = read(folder_);
  changed.points[1].ring.change([](std::uint16_t& ring) { ring ^= 1; });
  write_recording(folder_ / "stored.h5", changed.info, changed.sensors, changed.points, nullptr);
  EXPECT_NE(read_info(folder_ / "stored.h5").digest, read_info(folder_ / "held.h5").digest);
}

TEST_F(StoredPoints, AreReadFromARecordingAndGiveTheSameBag) {
  const Imported held = read("");
  write_recording(folder_ / "a.h5", held.info, held.sensors, nullptr);
  std::vector<PointStore> points;
  const sim::Sensors sensors = read_sensors(folder_ / "a.h5", folder_, points);
  EXPECT_EQ(sensors.lidars.at(0).range_m.size(), 0u);
  EXPECT_EQ(points.at(0).range_m.rows(0, points[0].size()), held.sensors.lidars[0].range_m);
  EXPECT_EQ(digest(sensors, points, nullptr), digest(held.sensors, nullptr));
  export_mcap(held.sensors, {held.info.origin_ns}, folder_ / "held.mcap");
  export_recording(folder_ / "a.h5", "mcap", folder_ / "stored.mcap");
  EXPECT_TRUE(test::read_file(folder_ / "stored.mcap") == test::read_file(folder_ / "held.mcap"));
  export_recording(folder_ / "a.h5", "rosbag2", folder_ / "new/folders/bag");
  EXPECT_TRUE(fs::exists(folder_ / "new/folders/bag/metadata.yaml"));
  // damage is found when the points are on the disk too
  std::string bytes = test::read_file(folder_ / "a.h5");
  const float first = held.sensors.lidars[0].range_m[1000];
  const std::size_t at = bytes.find(std::string(reinterpret_cast<const char*>(&first), sizeof(first)));
  ASSERT_NE(at, std::string::npos);
  bytes[at] = static_cast<char>(bytes[at] ^ 1);
  fixture::put(folder_ / "a.h5", bytes);
  EXPECT_THAT(test::complaint([&] { read_sensors(folder_ / "a.h5", folder_, points); }),
              HasSubstr("damaged or was changed"));
}

TEST_F(StoredPoints, AreComparedWithTheirSweeps) {
  Imported stored = read(folder_);
  const auto write = [&] { write_recording(folder_ / "a.h5", stored.info, stored.sensors, stored.points, nullptr); };
  stored.sensors.lidars[0].sweep_first.back() -= 1;
  EXPECT_THROW(write(), std::invalid_argument);
  stored.sensors.lidars[0].sweep_first.back() += 1;
  stored.sensors.lidars[0].point_times = sim::PointTimes::unknown;
  EXPECT_THROW(write(), std::invalid_argument) << "offsets where points have no times";
  stored.sensors.lidars[0].point_times = sim::PointTimes::measured;
  EXPECT_NO_THROW(write());
}

TEST_F(StoredPoints, NeedAFolder) {
  EXPECT_THAT(test::complaint([&] { read(folder_ / "none"); }),
              HasSubstr("none: cannot create a file in the folder for temporary files: No such file"));
}

/// Ends the process with 0 when BadInput reports the full disk, and only the earlier files are left.
[[noreturn]] void write_with_little_room(const Imported& stored, const fs::path& folder, rlim_t bytes) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit limit{bytes, bytes};
  setrlimit(RLIMIT_FSIZE, &limit);
  const std::string message =
      test::complaint([&] { write_recording(folder / "a.h5", stored.info, stored.sensors, stored.points, nullptr); });
  const auto left = std::distance(fs::directory_iterator(folder), fs::directory_iterator());
  std::cerr << message;
  std::_Exit(message.empty() || left != 1 ? 1 : 0);
}

TEST_F(StoredPoints, AFullDiskIsNoticedBeforeTheLibraryMeetsIt) {
  const Imported stored = read(folder_);
  for (const rlim_t bytes : {rlim_t{4096}, rlim_t{1} << 20}) {
    EXPECT_EXIT(write_with_little_room(stored, folder_, bytes), testing::ExitedWithCode(0),
                "a.h5: cannot be written: File too large");
  }
}

}  // namespace
}  // namespace tumble::scenarios
