// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/bags/bag.hpp"

#include "scenarios/recordings/bag_kinds.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/export.hpp"
#include "scenarios/recordings/fixture_recording.hpp"
#include "scenarios/recordings/recording_file.hpp"

namespace tumble::scenarios {
namespace {

class Bag : public test::TemporaryFolder, public testing::WithParamInterface<fixture::BagKind> {
 protected:
  Bag() {
    for (sim::ImuRecord& imu : recording_.sensors.imus) {
      for (Vector3d& force : imu.accel_m_s2) force *= 0.2;  // scaled to a plausible median
    }
    for (std::uint32_t& offset : recording_.sensors.lidars[0].offset_ns) offset *= 600;  // points cover most of a sweep
    reading_.imu.device = "mti30";
    path_ = folder_ / "a.bag";
  }
  void write() { GetParam().write(recording_.sensors, {}, path_); }
  Imported read() { return GetParam().read(path_, reading_); }
  std::string complaint_of() {
    return test::complaint([&] { read(); });
  }
  sim::Recording recording_ = fixture::recording();
  BagReading reading_;
  fs::path path_;
};

TEST_P(Bag, SensorsComeBackToTheFormatsPrecision) {
  write();
  const Imported imported = read();
  EXPECT_EQ(imported.info.origin_ns, 1000000000000000000) << "stamps of simulated recordings begin in 2001";
  ASSERT_EQ(imported.sensors.imus.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const sim::ImuRecord &imu = imported.sensors.imus[k], &given = recording_.sensors.imus[k];
    EXPECT_EQ(imu.name, given.name);
    EXPECT_EQ(imu.device, "mti30");
    EXPECT_EQ(imu.time_ns, given.time_ns);
    EXPECT_EQ(imu.gyro_rad_s, given.gyro_rad_s);
    EXPECT_EQ(imu.accel_m_s2, given.accel_m_s2);
    EXPECT_EQ(imu.period_ns, given.period_ns);
  }
  ASSERT_EQ(imported.sensors.lidars.size(), 1u);
  const sim::LidarRecord &lidar = imported.sensors.lidars[0], &given = recording_.sensors.lidars[0];
  EXPECT_EQ(lidar.name, given.name);
  EXPECT_EQ(lidar.sweep_start_ns, given.sweep_start_ns);
  EXPECT_EQ(lidar.sweep_first, given.sweep_first);
  EXPECT_EQ(lidar.sweep_period_ns, given.sweep_period_ns);
  EXPECT_EQ(lidar.position_L_m, given.position_L_m);
  EXPECT_EQ(lidar.intensity, given.intensity);
  EXPECT_EQ(lidar.ring, given.ring);
  ASSERT_EQ(lidar.offset_ns.size(), given.offset_ns.size());
  EXPECT_EQ(lidar.offset_ns, given.offset_ns);
  // the frames are attached to the body by quaternions, which costs some rounding
  for (std::size_t k = 0; k < 2; ++k)
    EXPECT_TRUE(imported.sensors.imus[k].T_BI.isApprox(recording_.sensors.imus[k].T_BI, 1e-12));
  EXPECT_TRUE(lidar.T_BL.isApprox(given.T_BL, 1e-12));
  EXPECT_FALSE(imported.reference.has_value());
}

TEST_P(Bag, SweepsWithoutPointTimesStaySo) {
  sim::LidarRecord& lidar = recording_.sensors.lidars[0];
  lidar.point_times = sim::PointTimes::unknown;
  lidar.offset_ns.assign(lidar.offset_ns.size(), 0);
  write();
  EXPECT_EQ(read().sensors.lidars.at(0).point_times, sim::PointTimes::unknown);
}

TEST_P(Bag, TheTruthIsLeftOutUnlessAskedFor) {
  reading_.reference_topic = "/truth";
  write();
  EXPECT_THAT(complaint_of(), HasSubstr("no topic '/truth'"));
  fs::remove_all(path_);
  const StoredTruth truth = fixture::stored_truth(recording_, folder_);
  GetParam().write(recording_.sensors, {0, &truth}, path_);
  const Imported imported = read();
  ASSERT_TRUE(imported.reference.has_value());
  EXPECT_EQ(imported.reference->period_ns, 5000000);
  ASSERT_EQ(imported.reference->p_WB_m.size(), 8u);
  for (std::size_t k = 0; k < 8; ++k) {
    EXPECT_EQ(imported.reference->p_WB_m[k], recording_.truth.p_WB_m[5 * k]);
    EXPECT_EQ(imported.reference->q_WB[k].coeffs(), recording_.truth.q_WB[5 * k].coeffs());
  }
  reading_.reference_topic = "/imu";
  EXPECT_THAT(complaint_of(),
              HasSubstr("topic '/imu' has the type sensor_msgs/Imu; its type must be nav_msgs/Odometry"));
}

TEST_P(Bag, TopicsAreChosenByName) {
  write();
  reading_.imu_topics = {"/imu_reference"};
  ASSERT_EQ(read().sensors.imus.size(), 1u);
  EXPECT_EQ(read().sensors.imus[0].gyro_rad_s, recording_.sensors.imus[1].gyro_rad_s);
  reading_.imu_topics = {"imu_reference"};
  EXPECT_EQ(read().sensors.imus.at(0).name, "imu_reference");
  reading_.for_odometry = true;
  EXPECT_EQ(read().sensors.imus.at(0).name, "/imu_reference");
  EXPECT_EQ(read().sensors.lidars.at(0).name, "/lidar/points");
  reading_.imu_topics = {"/imu_referense"};
  EXPECT_THROW(read(), WrongOption);
  EXPECT_THAT(complaint_of(),
              HasSubstr("did you mean '/imu_reference'? (topics of a fitting type: /imu sensor_msgs/Imu"));
  reading_.imu_topics = {"/lidar/points"};
  EXPECT_THROW(read(), WrongOption);
  EXPECT_THAT(complaint_of(), HasSubstr("of type sensor_msgs/PointCloud2; it must be sensor_msgs/Imu (topics of"));
}

TEST_P(Bag, AnotherUnitIsSaid) {
  for (Vector3d& force : recording_.sensors.imus[0].accel_m_s2) force /= 9.80665;
  write();
  EXPECT_THAT(complaint_of(), HasSubstr("topic /imu: the median specific force is"));
}

// some drivers do not follow sensor_msgs/Imu
TEST_P(Bag, ForceInGIsReadSoAndSaid) {
  recording_.sensors.imus.resize(1);
  for (Vector3d& force : recording_.sensors.imus[0].accel_m_s2) force = Vector3d(0.6, 0.0, -0.8);
  write();
  const Imported imported = read();
  EXPECT_TRUE(imported.sensors.imus.at(0).accel_m_s2.front().isApprox(9.80665 * Vector3d(0.6, 0.0, -0.8)));
  EXPECT_THAT(imported.notes, Contains(AllOf(HasSubstr("/imu: caution: sensor_msgs/Imu requires m/s^2"),
                                             HasSubstr("(set '--accel-unit m/s^2'"))));
  reading_.accel_unit = AccelUnit::m_s2;
  EXPECT_THAT(complaint_of(), HasSubstr("The specific force may be in g (set '--accel-unit g')"));
}

// a program that takes the first IMU of a bag must get the primary one, also when the first reading of another IMU was
// earlier
TEST_P(Bag, ThePrimaryImuIsTheFirstTopicOfItsType) {
  for (std::int64_t& time : recording_.sensors.imus[0].time_ns) time += 700000;
  write();
  const Imported imported = read();
  ASSERT_EQ(imported.sensors.imus.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(imported.sensors.imus[k].name, recording_.sensors.imus[k].name);
    EXPECT_EQ(imported.sensors.imus[k].gyro_rad_s, recording_.sensors.imus[k].gyro_rad_s);
    EXPECT_EQ(imported.sensors.imus[k].time_ns, recording_.sensors.imus[k].time_ns);
  }
}

// an earlier version merged two sensors of one name into one, with the pose of the later one
TEST_P(Bag, SensorsOfOneNameStayApart) {
  recording_.sensors.imus[1].name = recording_.sensors.imus[0].name = "os";
  recording_.sensors.lidars[0].name = "os";
  write();
  const Imported imported = read();
  ASSERT_EQ(imported.sensors.imus.size(), 2u);
  for (std::size_t k = 0; k < 2; ++k) {
    const sim::ImuRecord &imu = imported.sensors.imus[k], &given = recording_.sensors.imus[k];
    EXPECT_EQ(imu.name, k == 0 ? "os" : "os_2");
    EXPECT_EQ(imu.gyro_rad_s, given.gyro_rad_s);
    EXPECT_TRUE(imu.T_BI.isApprox(given.T_BI, 1e-12));
  }
  ASSERT_EQ(imported.sensors.lidars.size(), 1u);
  EXPECT_EQ(imported.sensors.lidars[0].name, "os_3");
  EXPECT_TRUE(imported.sensors.lidars[0].T_BL.isApprox(recording_.sensors.lidars[0].T_BL, 1e-12));
}

TEST_P(Bag, ASensorIsNoFrameOfTheBags) {
  const StoredTruth truth = fixture::stored_truth(recording_, folder_);
  for (const char* name : {"body", "world", "map", "odom", "base_link", "truth"}) {
    recording_.sensors.lidars[0].name = name;
    fs::remove_all(path_);
    GetParam().write(recording_.sensors, {0, &truth}, path_);
    const Imported imported = read();
    ASSERT_EQ(imported.sensors.lidars.size(), 1u) << name;
    EXPECT_EQ(imported.sensors.lidars[0].name, std::string(name) + "_2");
    EXPECT_TRUE(imported.sensors.lidars[0].T_BL.isApprox(recording_.sensors.lidars[0].T_BL, 1e-12)) << name;
    EXPECT_TRUE(imported.sensors.imus[0].T_BI.isApprox(recording_.sensors.imus[0].T_BI, 1e-12)) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, Bag,
                         testing::Values(fixture::kRos1, fixture::kRos2, fixture::kMcap,
                                         fixture::BagKind{"Ros2Mcap", export_ros2_mcap, import_ros2_bag}),
                         fixture::name_of);

// messages should contain rad/s; a driver that writes degrees is noticed because gravity turns slowly
TEST_P(Bag, RatesInDegreesAreNoticedByGravity) {
  const auto turning = [&](double scale, double sign) {
    sim::ImuRecord& imu = recording_.sensors.imus[0];
    recording_.sensors.imus.resize(1);
    recording_.sensors.lidars.clear();
    for (auto* rows : {&imu.gyro_rad_s, &imu.accel_m_s2}) rows->clear();
    imu.time_ns.clear();
    for (int k = 0; k < 500; ++k) {
      const double angle = 0.5 * std::sin(0.02 * k);
      imu.time_ns.push_back(10'000'000LL * k);
      imu.gyro_rad_s.emplace_back(scale * std::cos(0.02 * k), 0.0, 0.0);
      imu.accel_m_s2.emplace_back(0.0, sign * 9.80665 * std::sin(angle), 9.80665 * std::cos(angle));
    }
    imu.clip_flags.assign(imu.time_ns.size(), 0);
    fs::remove_all(path_);
    write();
  };
  turning(1.0, 1.0);
  EXPECT_THAT(read().notes, Contains(HasSubstr("gyro and accelerometer agree in units and axes")));
  turning(57.29578, 1.0);
  EXPECT_THAT(complaint_of(), HasSubstr("The rates may be in deg/s"));
  reading_.gyro_unit = GyroUnit::deg_s;
  const Imported in_degrees = read();
  EXPECT_THAT(in_degrees.notes, Contains(HasSubstr("gyro and accelerometer agree in units and axes")));
  EXPECT_TRUE(in_degrees.sensors.imus[0].gyro_rad_s[0].isApprox(Vector3d(1.0, 0.0, 0.0), 1e-7));
  turning(1.0, 1.0);
  EXPECT_THAT(complaint_of(), HasSubstr("if the gyro is read in deg/s, the rotation measured by the accelerometer"));
  EXPECT_THAT(complaint_of(), HasSubstr("The rates may be in rad/s"));
  reading_.gyro_unit = GyroUnit::rad_s;
  turning(1.0, -1.0);
  EXPECT_THAT(read().notes, Contains(HasSubstr("caution: the rotation measured by the accelerometer is -1 times")));
}

TEST_P(Bag, AnImuThatIsNoneIsSaidWithTheWayOut) {
  for (Vector3d& force : recording_.sensors.imus[1].accel_m_s2) force.setZero();  // only a gyro
  write();
  EXPECT_THAT(complaint_of(),
              AllOf(HasSubstr("topic /imu_reference:"), HasSubstr("the option --imu-topic can select other topics")));
  reading_.imu_topics = {"/imu"};
  EXPECT_EQ(complaint_of(), "");
}

}  // namespace
}  // namespace tumble::scenarios
