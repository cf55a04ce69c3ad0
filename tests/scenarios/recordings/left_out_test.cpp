// SPDX-License-Identifier: BSD-3-Clause
// The test checks bags and tables with single faulty readings or clouds.
#include "scenarios/recordings/left_out.hpp"

#include <variant>

#include "scenarios/recordings/bag_kinds.hpp"
#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/bags/sweep_messages.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::int64_t kFirstStamp_ns = 1'700'000'000'000'000'000, kMilli_ns = 1'000'000;
constexpr int kReadings = 150, kClouds = 15, kPoints = 128;

TEST(StampsInOrder, AsFewStampsAsPossibleAreDropped) {
  const auto kept = [](std::vector<std::int64_t> stamps) { return stamps_in_order(stamps); };
  EXPECT_THAT(kept({}), ElementsAre());
  EXPECT_THAT(kept({1, 2, 3}), ElementsAre(true, true, true));
  EXPECT_THAT(kept({1, 2, 2, 3}), ElementsAre(true, true, false, true)) << "of equal stamps, the first is kept";
  EXPECT_THAT(kept({10, 20, 5, 30}), ElementsAre(true, true, false, true)) << "back";
  EXPECT_THAT(kept({10, 90, 20, 30}), ElementsAre(true, false, true, true)) << "ahead";
  std::vector<std::int64_t> unset = {0, 100, 101, 102, 103, 104, 105, 106, 107, 108};
  EXPECT_FALSE(kept(unset).front()) << "the clock was set after the first stamp";
  EXPECT_THAT(kept({10, 30, 20, 40}), ElementsAre(true, true, false, true)) << "early stamps are kept";
  unset.front() = 99, unset.back() = std::numeric_limits<std::int64_t>::max();
  EXPECT_FALSE(kept(unset).back());
}

TEST(LeftOut, FewFaultsAreNotedAndManyAreRefused) {
  LeftOut left_out("readings");
  EXPECT_EQ(left_out.note(10), "");
  left_out.add("a wrong time stamp", "a.csv:3: does not increase");
  left_out.guard([] { throw BadInput("a.csv:9: is not finite"); });
  EXPECT_EQ(left_out.note(38),
            "caution: the import leaves out 2 of 40 readings: 1 because of a wrong time stamp (first error: a.csv:3: "
            "does not increase); 1 because of faulty data (first error: a.csv:9: is not finite)");
  EXPECT_NO_THROW(left_out.require_few(38));
  EXPECT_EQ(
      test::complaint([&] { left_out.require_few(37); }),
      "a.csv:3: does not increase (2 of 39 readings are faulty; the import leaves out at most 5 % of a sensor's data)");
  LeftOut one("clouds");
  one.add("faulty data", "cut");
  EXPECT_NO_THROW(one.require_few(4));
  EXPECT_THROW(one.require_few(3), BadInput);
}

/// OddBag is a bag of an IMU and a lidar in which each test changes single messages.
class OddBag : public test::TemporaryFolder, public testing::WithParamInterface<fixture::BagKind> {
 protected:
  OddBag() {
    recording_.sensors.imus[0] = {};
    sim::LidarRecord& lidar = recording_.sensors.lidars[0];
    lidar = {};
    for (int k = 0; k < kClouds; ++k) {
      lidar.sweep_start_ns.push_back(100 * kMilli_ns * k);
      lidar.sweep_first.push_back(lidar.position_L_m.size());
      for (int p = 0; p < kPoints; ++p) {
        lidar.position_L_m.emplace_back(5.0f, 0.1f * static_cast<float>(p), 1.0f);
        lidar.range_m.push_back(lidar.position_L_m.back().norm());
        lidar.intensity.push_back(0.5f);
        lidar.offset_ns.push_back(static_cast<std::uint32_t>(p) * 780'000u);
        lidar.ring.push_back(0);
      }
    }
    lidar.sweep_first.push_back(lidar.position_L_m.size());
    lidar.sweep_period_ns = 100 * kMilli_ns;
  }

  void write(const fs::path& path, int first_reading = 0, int end_reading = kReadings) {
    const auto bag = GetParam().writer(path);
    for (int k = first_reading; k < end_reading; ++k) {
      const std::int64_t record_ns = kFirstStamp_ns + 10 * kMilli_ns * k;
      ros::Imu imu;
      imu.header = header_of(record_ns, "imu");
      imu.angular_velocity = {0.01, 0.02, 0.001 * k};
      imu.linear_acceleration = {0.1, 0.0, 9.8};
      if (change_imu_) change_imu_(k, imu);
      bag->write("/imu", record_ns, imu);
      if (k % 10 != 9) continue;
      const std::int64_t start_ns = kFirstStamp_ns + clock_ns_ + 100 * kMilli_ns * (k / 10);
      ros::PointCloud2 cloud = std::get<ros::PointCloud2>(
          sweep_message(recording_.sensors.lidars[0], static_cast<std::size_t>(k / 10), layout_, start_ns, {}));
      cloud.header = header_of(start_ns - clock_ns_, "lidar");
      if (change_cloud_) change_cloud_(k / 10, cloud);
      if (camera_) {
        ros::PointCloud2 plain = cloud_message({{{1.0f, 2.0f, 3.0f}, {1.0f, 2.0f, 3.5f}}, {}}, cloud.header);
        bag->write("/camera", record_ns, plain);
      }
      bag->write("/points", record_ns, cloud);
    }
    bag->finish();
  }
  Imported read(const BagReading& reading = {}) {
    const fs::path path = folder_ / ("bag" + std::to_string(count_++));
    write(path);
    return GetParam().read(path, reading);
  }
  std::string complaint() {
    return test::complaint([&] { read(); });
  }
  /// Expects that one reading or one cloud is left out, with this note.
  void expect_one_left_out(std::size_t readings, std::size_t clouds, const std::string& note) {
    const Imported imported = read();
    EXPECT_EQ(imported.sensors.imus.at(0).time_ns.size(), readings) << note;
    EXPECT_EQ(imported.sensors.imus.at(0).period_ns, 10 * kMilli_ns) << note;
    EXPECT_EQ(imported.sensors.lidars.at(0).sweep_start_ns.size(), clouds) << note;
    EXPECT_EQ(imported.sensors.lidars.at(0).sweep_period_ns, 100 * kMilli_ns) << note;
    EXPECT_THAT(imported.notes, Contains(HasSubstr(note)));
    EXPECT_THAT(imported.notes, Not(Contains(HasSubstr("the clocks of sensor and recorder may differ")))) << note;
  }

  sim::Recording recording_ = fixture::recording();
  SweepLayout layout_ = own_sweep_layout();
  std::function<void(int, ros::Imu&)> change_imu_;
  std::function<void(int, ros::PointCloud2&)> change_cloud_;
  std::int64_t clock_ns_ = 0;  ///< clock of the points minus clock of the headers
  bool camera_ = false;        ///< the first topic is a cloud without point times

 private:
  int count_ = 0;
};

TEST_P(OddBag, OneWrongStampCostsOneReading) {
  for (const std::int64_t shift_ms : {-10, -500, 4000}) {
    change_imu_ = [shift_ms](int k, ros::Imu& imu) {
      if (k == 60) imu.header = header_of(kFirstStamp_ns + (600 + shift_ms) * kMilli_ns, "imu");
    };
    expect_one_left_out(
        149, 15,
        "/imu: caution: the import leaves out 1 of 150 readings: 1 because of a wrong time stamp (first error: ");
  }
  EXPECT_THAT(read().notes, Contains(HasSubstr("message 60 of /imu: the time stamp is out of order: the header "
                                               "stamp increases by 4.01 s")));
  change_imu_ = [](int k, ros::Imu& imu) {
    if (k == 0) imu.header = header_of(0, "imu");
  };
  expect_one_left_out(
      149, 15, "message 0 of /imu: the time stamp of this message is far from the time stamps of all other messages");
}

TEST_P(OddBag, OneUnusableReadingCostsOneReading) {
  for (const double value : {std::nan(""), 1e9, -std::numeric_limits<double>::infinity()}) {
    change_imu_ = [&](int k, ros::Imu& imu) {
      if (k == 60) imu.angular_velocity[1] = value;
    };
    expect_one_left_out(
        149, 15, "/imu: caution: the import leaves out 1 of 150 readings: 1 because of faulty data (first error: ");
  }
}

TEST_P(OddBag, ManyFaultyReadingsAreRefused) {
  change_imu_ = [&](int k, ros::Imu& imu) {
    if (k % 10 == 5) imu.angular_velocity[1] = std::nan("");
  };
  EXPECT_THAT(
      complaint(),
      HasSubstr(
          "message 5 of /imu: an IMU reading has a value that is not finite (15 of 150 readings are faulty; the import "
          "leaves out at most 5 % of a sensor's data)"));
}

TEST_P(OddBag, ReadingsOfExactlyZeroAreMissing) {
  for (const int every : {2, 3}) {
    change_imu_ = [&](int k, ros::Imu& imu) {
      if (k % every == 1) imu.angular_velocity = imu.linear_acceleration = {0.0, 0.0, 0.0};
    };
    const int lost = (kReadings + every - 2) / every;
    expect_one_left_out(static_cast<std::size_t>(kReadings - lost), 15,
                        "/imu: caution: the import leaves out " + std::to_string(lost) + " of 150 readings:");
  }
  change_imu_ = [](int, ros::Imu& imu) { imu.angular_velocity = imu.linear_acceleration = {0.0, 0.0, 0.0}; };
  EXPECT_THAT(complaint(), HasSubstr("all values of all readings are exactly 0"));
}

TEST_P(OddBag, ReadingsInBurstsAreDistributedOverTime) {
  for (const std::int64_t step_ns : {std::int64_t{0}, std::int64_t{100'000}}) {
    change_imu_ = [&](int k, ros::Imu& imu) {
      imu.header = header_of(kFirstStamp_ns + 10 * kMilli_ns * (k / 10 * 10 + 9) - step_ns * (9 - k % 10), "imu");
    };
    const Imported imported = read();
    const sim::ImuRecord& imu = imported.sensors.imus.at(0);
    ASSERT_EQ(imu.time_ns.size(), 150u);
    EXPECT_EQ(imu.period_ns, 10 * kMilli_ns);
    for (std::size_t k = 10; k < imu.time_ns.size(); ++k) {
      EXPECT_NEAR(static_cast<double>(imu.time_ns[k] + imported.info.origin_ns - kFirstStamp_ns),
                  1e7 * static_cast<double>(k), 1e3);
    }
    EXPECT_THAT(
        imported.notes,
        Contains(HasSubstr("/imu: caution: the readings have nearly equal time stamps in 15 bursts of about 10")));
  }
}

TEST_P(OddBag, OneFaultyCloudCostsOneCloud) {
  const auto at_5 = [](auto&& change) {
    return [change](int k, ros::PointCloud2& cloud) {
      if (k == 5) change(cloud);
    };
  };
  const std::string note = "/points: caution: the import leaves out 1 of 15 clouds: 1 because of ";
  change_cloud_ = at_5([](ros::PointCloud2& cloud) { cloud.data.resize(cloud.data.size() / 2); });
  expect_one_left_out(150, 14, note + "faulty data (first error: ");
  change_cloud_ = at_5([](ros::PointCloud2& cloud) { cloud.header = header_of(kFirstStamp_ns, "lidar"); });
  expect_one_left_out(150, 14, note + "a wrong time stamp (first error: ");
  change_cloud_ =
      at_5([](ros::PointCloud2& cloud) { cloud.header = header_of(kFirstStamp_ns + 9000 * kMilli_ns, "lidar"); });
  expect_one_left_out(150, 14, note + "a wrong time stamp (first error: ");
  change_cloud_ = at_5([](ros::PointCloud2& cloud) { cloud.fields.pop_back(), cloud.fields[0].name = "u"; });
  expect_one_left_out(150, 14, note + "faulty data (first error: ");
  change_cloud_ = nullptr;
  for (std::size_t p = 5 * kPoints; p < 6 * kPoints; ++p) recording_.sensors.lidars[0].position_L_m[p] *= 1e4f;
  expect_one_left_out(150, 14, note + "points beyond the lidar's range (first error: ");
}

TEST_P(OddBag, ManyFaultyCloudsAreRefused) {
  change_cloud_ = [](int k, ros::PointCloud2& cloud) {
    if (k % 3 == 0) cloud.data.resize(cloud.data.size() / 2);
  };
  EXPECT_THAT(complaint(), AllOf(HasSubstr("message 0 of /points: "), HasSubstr("5 of 15 clouds are faulty")));
}

TEST_P(OddBag, OneWildPointTimeCostsOnePoint) {
  std::vector<std::uint32_t>& offsets = recording_.sensors.lidars[0].offset_ns;
  offsets[5 * kPoints + 3] = 4'200'000'000u;
  const Imported imported = read();
  EXPECT_EQ(imported.sensors.lidars.at(0).sweep_start_ns.size(), 15u);
  EXPECT_EQ(imported.sensors.lidars.at(0).offset_ns.size(), static_cast<std::size_t>(15 * kPoints - 1));
  EXPECT_THAT(
      imported.notes,
      Contains(AllOf(HasSubstr("/points: caution: the import leaves out 1 point with times outside their sweep"),
                     HasSubstr("message 5 of /points: the time of point 3 is"))));
  for (std::size_t p = 5 * kPoints; p < 5 * kPoints + 20; ++p) offsets[p] = 4'200'000'000u;
  expect_one_left_out(150, 14, "1 because of faulty data (first error: ");
}

TEST_P(OddBag, EqualPointTimesMeanSweepsThatAreNotSkewed) {
  std::vector<std::uint32_t>& offsets = recording_.sensors.lidars[0].offset_ns;
  offsets.assign(offsets.size(), 0);
  const Imported imported = read();
  EXPECT_EQ(imported.sensors.lidars.at(0).point_times, sim::PointTimes::not_skewed);
  EXPECT_THAT(imported.notes, Contains(HasSubstr("/points: caution: all points of a sweep have the same time")));
}

TEST_P(OddBag, PointTimesThatRunBackwardsAreACaution) {
  EXPECT_THAT(read().notes, Not(Contains(HasSubstr("points that are stored later have earlier times"))));
  for (std::uint32_t& offset : recording_.sensors.lidars[0].offset_ns) offset = 780'000u * (kPoints - 1) - offset;
  EXPECT_THAT(read().notes, Contains(HasSubstr("/points: caution: points that are stored later have earlier times")));
}

TEST_P(OddBag, PointTimesOfAnotherClockCountFromTheFirstPoint) {
  layout_.columns.resize(5);
  layout_.columns.push_back({"timestamp", PointQuantity::time, NumberType::float64, 1e-9, true});
  clock_ns_ = -1'000'000'000'000'000;
  const Imported imported = read();
  const sim::LidarRecord& lidar = imported.sensors.lidars.at(0);
  EXPECT_EQ(lidar.point_times, sim::PointTimes::measured);
  for (std::size_t k = 0; k < 15; ++k)
    EXPECT_EQ(lidar.sweep_start_ns[k] + imported.info.origin_ns,
              kFirstStamp_ns + 100 * kMilli_ns * static_cast<int>(k));
  EXPECT_NEAR(lidar.offset_ns[kPoints - 1], 780'000.0 * (kPoints - 1), 1e3);
  EXPECT_THAT(imported.notes,
              Contains(HasSubstr(
                  "/points: caution: the point times and the time stamps of the sweeps come from different clocks")));
}

TEST_P(OddBag, CloudsWithPointTimesAreThePrimaryLidar) {
  camera_ = true;
  const Imported imported = read();
  ASSERT_EQ(imported.sensors.lidars.size(), 2u);
  EXPECT_EQ(imported.sensors.lidars[0].name, "points");
  EXPECT_EQ(imported.sensors.lidars[1].name, "camera");
  EXPECT_THAT(imported.notes, Contains("/points: mapping methods use the lidar of this topic, because its points have "
                                       "times (set --lidar-topic to choose another topic)"));
  BagReading chosen;
  chosen.lidar_topics = {"/camera", "/points"};
  EXPECT_EQ(read(chosen).sensors.lidars.at(0).name, "camera");
}

TEST_P(OddBag, PartsAreReadTogetherByTime) {
  const fs::path bag = folder_ / "parts";
  if (std::string(GetParam().name) == "Ros1") {
    fs::create_directory(bag);
    write(bag / "z.bag", 0, 80), write(bag / "a.bag", 80, 150);
  } else if (std::string(GetParam().name) == "Ros2") {
    write(folder_ / "other", 0, 80), write(bag, 80, 150);
    fs::rename(folder_ / "other/other_0.db3", bag / "parts_1.db3");
  } else {
    return;  // an MCAP file has only one part
  }
  const Imported imported = GetParam().read(bag, {});
  EXPECT_EQ(imported.sensors.imus.at(0).time_ns.size(), 150u);
  EXPECT_EQ(imported.sensors.lidars.at(0).sweep_start_ns.size(), 15u);
  EXPECT_EQ(imported.info.origin_ns, kFirstStamp_ns);
  EXPECT_THAT(imported.notes, Contains(AnyOf(HasSubstr("as parts of one recording: a.bag z.bag"),
                                             HasSubstr("metadata.yaml does not list"))));
  if (std::string(GetParam().name) == "Ros2") {
    EXPECT_THAT(imported.notes, Contains(HasSubstr("parts_1.db3")));
    EXPECT_THAT(imported.notes, Contains(HasSubstr("the import reads the files in the order of time")));
  }
}

TEST_P(OddBag, ErrorsListTheTopics) {
  BagReading named;
  named.imu_topics = {"/gyro"};
  EXPECT_THAT(test::complaint([&] { read(named); }),
              AllOf(HasSubstr("there is no topic '/gyro'"), HasSubstr("/imu sensor_msgs/Imu")));
}

INSTANTIATE_TEST_SUITE_P(Kinds, OddBag, testing::Values(fixture::kRos1, fixture::kRos2, fixture::kMcap),
                         fixture::name_of);

class OddTable : public test::TemporaryFolder {};

TEST_F(OddTable, OneFaultyLineCostsOneReading) {
  for (const char* odd : {"0.6,nan,0,0,0,0,9.8\n", "0.6,x,0,0,0,0,9.8\n", "0.59,0.1,0,0,0,0,9.8\n", "0.6,0.1\n",
                          "9.6,0.1,0,0,0,0,9.8\n", "0.6,1e8,0,0,0,0,9.8\n", "0.6,0,0,0,0,0,0\n"}) {
    std::string text = "time_s,gyro_x,gyro_y,gyro_z,accel_x,accel_y,accel_z\n";
    for (int k = 0; k < 100; ++k) {
      char line[64];
      std::snprintf(line, sizeof line, "%.2f,0.1,0,%.3f,0,0,9.8\n", 0.01 * k, 0.001 * k);
      text += k == 60 ? odd : line;
    }
    fixture::put(folder_ / "a.csv", text);
    const Imported imported = import_imu_csv(folder_ / "a.csv", {});
    EXPECT_EQ(imported.sensors.imus.at(0).time_ns.size(), 99u) << odd;
    EXPECT_EQ(imported.sensors.imus.at(0).period_ns, 10 * kMilli_ns) << odd;
    EXPECT_THAT(imported.notes,
                Contains(AllOf(HasSubstr("caution: the import leaves out 1 of 100 readings: 1 because of"),
                               HasSubstr("a.csv:62"))))
        << odd;
  }
}

TEST_F(OddTable, OneFaultyFileCostsOneSweep) {
  const std::string head =
      "ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  std::string times;
  for (int k = 0; k < 10; ++k) {
    fixture::put(folder_ / (std::to_string(k) + ".PLY"), k == 4 ? head + "1 2\n" : head + "1 2 3\n1 2 4\n");
    times += k == 7 ? "0.1\n" : std::to_string(0.1 * k) + "\n";
  }
  SweepSource source;
  source.folder = folder_;
  source.format = "ply";
  fixture::put(folder_ / "times.txt", times);
  EXPECT_THAT(test::complaint([&] { import_sweeps(source); }), HasSubstr("2 of 10 clouds are faulty"));
  fixture::put(folder_ / "4.PLY", head + "1 2 3\n1 2 4\n");
  const Imported imported = import_sweeps(source);
  EXPECT_EQ(imported.sensors.lidars.at(0).sweep_start_ns.size(), 9u);
  EXPECT_THAT(imported.notes, Contains(AllOf(HasSubstr("the import leaves out 1 of 10 clouds"),
                                             HasSubstr("times.txt:8: the time stamp 100000000 ns must be larger"))));
}

}  // namespace
}  // namespace tumble::scenarios
