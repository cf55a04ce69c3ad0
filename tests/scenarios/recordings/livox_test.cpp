// SPDX-License-Identifier: BSD-3-Clause
// The test writes and reads the CustomMsg of Livox' drivers, and reads malformed ones.
#include "scenarios/recordings/bag_kinds.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/bag_sweeps.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

class Livox : public test::TemporaryFolder, public testing::WithParamInterface<fixture::BagKind> {
 protected:
  Livox() {
    recording_.sensors.imus.clear();
    sim::LidarRecord& lidar = recording_.sensors.lidars[0];
    for (std::uint32_t& offset : lidar.offset_ns) offset *= 600;
    path_ = folder_ / "a.bag";
  }
  ros::LivoxCustomMsg message(std::int64_t stamp_ns) const {
    ros::LivoxCustomMsg out;
    out.header = {0, static_cast<std::uint32_t>(stamp_ns / 1000000000),
                  static_cast<std::uint32_t>(stamp_ns % 1000000000), "livox_frame"};
    out.timebase = static_cast<std::uint64_t>(stamp_ns);
    for (std::uint32_t k = 0; k < 10; ++k) {
      out.points.push_back(
          {k * 9000000, 1.0f + static_cast<float>(k), 2.0f, 3.0f, 51, 0x10, static_cast<std::uint8_t>(k % 4)});
    }
    out.point_num = 10;
    return out;
  }
  Imported written(const std::vector<ros::LivoxCustomMsg>& messages) {
    const auto bag = GetParam().writer(path_);
    for (const ros::LivoxCustomMsg& each : messages) {
      bag->write("/livox/lidar", std::int64_t{each.header.sec} * 1000000000 + each.header.nanosec, each);
    }
    bag->finish();
    return GetParam().read(path_, {});
  }
  sim::Recording recording_ = fixture::recording();
  fs::path path_;
};

TEST_P(Livox, SweepsComeBackToTheMessagesPrecision) {
  BagWriting writing;
  writing.sweeps = livox_sweep_layout();
  GetParam().write(recording_.sensors, writing, path_);
  const Imported imported = GetParam().read(path_, {});
  const sim::LidarRecord &lidar = imported.sensors.lidars.at(0), &given = recording_.sensors.lidars[0];
  EXPECT_EQ(lidar.sweep_start_ns, given.sweep_start_ns);
  EXPECT_EQ(lidar.position_L_m, given.position_L_m);
  EXPECT_EQ(lidar.offset_ns, given.offset_ns);
  EXPECT_EQ(lidar.ring, given.ring);
  for (std::size_t k = 0; k < given.intensity.size(); ++k)
    EXPECT_NEAR(lidar.intensity[k], given.intensity[k], 0.5 / 255.0);
  EXPECT_TRUE(lidar.T_BL.isApprox(given.T_BL, 1e-12));
}

TEST_P(Livox, IsKnownByItsType) {
  BagWriting writing;
  writing.sweeps = livox_sweep_layout();
  GetParam().write(recording_.sensors, writing, path_);
  const auto reader = std::string(GetParam().name) == "Ros1"   ? open_ros1_bag(path_)
                      : std::string(GetParam().name) == "Mcap" ? open_mcap({path_})
                                                               : open_ros2_bag(path_);
  std::string type;
  for (const BagTopic& topic : reader->topics()) {
    if (topic.name == "/lidar/points") type = topic.type;
  }
  EXPECT_EQ(type, GetParam().livox_type);
}

TEST_P(Livox, ReadsWhatADriverWrites) {
  const Imported imported = written({message(1690000000'000000000), message(1690000000'100000000)});
  const sim::LidarRecord& lidar = imported.sensors.lidars.at(0);
  EXPECT_EQ(lidar.sweep_period_ns, 100000000);
  EXPECT_EQ(lidar.offset_ns[9], 81000000u) << "nanoseconds, by the message's definition";
  EXPECT_EQ(lidar.ring[3], 3u);
  EXPECT_NEAR(lidar.intensity[0], 0.2f, 1e-6);
  EXPECT_EQ(lidar.position_L_m[2], Vector3f(3.0f, 2.0f, 3.0f));
  EXPECT_THAT(imported.notes, Not(Contains(HasSubstr("timebase"))));
}

TEST_P(Livox, TwoClocksAreSaid) {
  ros::LivoxCustomMsg first = message(1690000000'000000000), second = message(1690000000'100000000);
  first.timebase = 12'000000000;
  second.timebase = 12'100000000;
  EXPECT_THAT(written({first, second}).notes,
              Contains(HasSubstr("timebase and the header stamp of the messages differ by up to 1689999988")));
}

TEST_P(Livox, ACountThatIsNoneIsRefused) {
  ros::LivoxCustomMsg first = message(1690000000'000000000), second = message(1690000000'100000000);
  second.point_num = 4000000000u;
  EXPECT_THAT(
      test::complaint([&] {
        written({first, second});
      }),
      HasSubstr(
          "message 1 of /livox/lidar: the header of the cloud states 4000000000 points, but the message contains 10"));
}

INSTANTIATE_TEST_SUITE_P(Kinds, Livox, testing::Values(fixture::kRos1, fixture::kRos2, fixture::kMcap),
                         fixture::name_of);

TEST(LivoxMessage, ALengthThatItDoesNotHaveAllocatesNothing) {
  ros::LivoxCustomMsg message;
  message.points.resize(3);
  for (const bool cdr : {false, true}) {
    ros::Bytes bytes = cdr ? ros::to_cdr(message) : ros::to_ros1(message);
    // the number of points precedes 3 points of 19 bytes; in CDR each except the last is padded to 20
    const std::size_t at = bytes.size() - (cdr ? 59 : 57) - 4;
    ASSERT_EQ(bytes[at], 3);
    bytes[at + 3] = 0xff;
    const auto read = [&] {
      cdr ? ros::from_cdr<ros::LivoxCustomMsg>(bytes) : ros::from_ros1<ros::LivoxCustomMsg>(bytes);
    };
    EXPECT_THROW(read(), ros::BadMessage) << cdr;
  }
}

using LivoxExport = test::TemporaryFolder;

TEST_F(LivoxExport, WhatTheMessageCannotStoreIsRefused) {
  const auto complaint_of = [&](const std::function<void(sim::LidarRecord&)>& change) {
    sim::Recording recording = fixture::recording();
    change(recording.sensors.lidars[0]);
    BagWriting writing;
    writing.sweeps = livox_sweep_layout();
    const std::string said =
        test::complaint([&] { export_ros1_bag(recording.sensors, writing, folder_ / "refused.bag"); });
    EXPECT_EQ(files(), 0u) << said;
    return said;
  };
  EXPECT_THAT(complaint_of([](sim::LidarRecord& lidar) { lidar.ring[7] = 256; }),
              HasSubstr("a point of lidar 'lidar' has ring 256; a Livox CustomMsg can only store rings 0 to 255"));
  EXPECT_THAT(complaint_of([](sim::LidarRecord& lidar) { lidar.position_L_m[7].x() = std::nanf(""); }),
              HasSubstr("point 7 of lidar 'lidar' is not finite"));
  EXPECT_THAT(complaint_of([](sim::LidarRecord& lidar) { lidar.intensity[7] = std::nanf(""); }),
              HasSubstr("point 7 of lidar 'lidar' is not finite"));
  for (const sim::PointTimes times : {sim::PointTimes::unknown, sim::PointTimes::not_skewed}) {
    EXPECT_THAT(
        complaint_of([&](sim::LidarRecord& lidar) {
          lidar.point_times = times;
          std::fill(lidar.offset_ns.begin(), lidar.offset_ns.end(), 0u);
        }),
        HasSubstr("the points of lidar 'lidar' have no time stamps, but a Livox CustomMsg needs measured time stamps"));
  }
}

}  // namespace
}  // namespace tumble::scenarios
