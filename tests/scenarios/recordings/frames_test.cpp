// SPDX-License-Identifier: BSD-3-Clause
// The test checks /tf, /tf_static and /clock in every kind of bag, and how the reader uses the frames.
#include "scenarios/recordings/bag_kinds.hpp"
#include "scenarios/recordings/bags/bag.hpp"
#include "scenarios/recordings/bags/bag_messages.hpp"
#include "scenarios/recordings/bags/bag_storage.hpp"
#include "scenarios/recordings/bags/sensor_places.hpp"
#include "scenarios/recordings/fixture_recording.hpp"

namespace tumble::scenarios {
namespace {

class Frames : public test::TemporaryFolder, public testing::WithParamInterface<fixture::BagKind> {
 protected:
  Frames() {
    for (sim::ImuRecord& imu : recording_.sensors.imus) {
      for (Vector3d& force : imu.accel_m_s2) force *= 0.2;
    }
    for (std::uint32_t& offset : recording_.sensors.lidars[0].offset_ns) offset *= 600;
  }
  template <class Message>
  std::vector<Message> messages(const std::string& topic) {
    const auto reader = GetParam().open(path_);
    std::vector<Message> out;
    reader->read(topic, [&](ros::Bytes& bytes, std::int64_t) {
      out.push_back(reader->cdr(topic) ? ros::from_cdr<Message>(bytes) : ros::from_ros1<Message>(bytes));
    });
    return out;
  }
  std::vector<std::string> topics() {
    std::vector<std::string> names;
    for (const BagTopic& topic : GetParam().open(path_)->topics()) names.push_back(topic.name + " " + topic.type);
    return names;
  }
  sim::Recording recording_ = fixture::recording();
  fs::path path_ = folder_ / "bag";
};

INSTANTIATE_TEST_SUITE_P(Kinds, Frames, testing::Values(fixture::kRos1, fixture::kRos2, fixture::kMcap),
                         fixture::name_of);

TEST_P(Frames, SensorsHangOnTheBody) {
  GetParam().write(recording_.sensors, {}, path_);
  EXPECT_THAT(topics(), Contains("/tf_static tf2_msgs/TFMessage"));
  EXPECT_THAT(topics(), Not(Contains("/tf tf2_msgs/TFMessage"))) << "nobody says where the body is";
  const std::vector<ros::TFMessage> found = messages<ros::TFMessage>("/tf_static");
  ASSERT_EQ(found.size(), 1u);
  ASSERT_EQ(found[0].transforms.size(), 3u);
  const char* names[] = {"imu", "imu_reference", "lidar"};
  const Isometry3d poses[] = {recording_.sensors.imus[0].T_BI, recording_.sensors.imus[1].T_BI,
                              recording_.sensors.lidars[0].T_BL};
  for (std::size_t k = 0; k < 3; ++k) {
    const ros::TransformStamped& each = found[0].transforms[k];
    EXPECT_EQ(each.header.frame_id, "body");
    EXPECT_EQ(each.child_frame_id, names[k]);
    EXPECT_EQ(Eigen::Vector3d::Map(each.translation.data()), poses[k].translation());
    Quaterniond q;
    q.coeffs() = Eigen::Vector4d::Map(each.rotation_xyzw.data());
    EXPECT_TRUE(q.toRotationMatrix().isApprox(poses[k].linear(), 1e-14));
  }
}

TEST_P(Frames, TheTruthMovesTheBodyAndEstimatesFramesOfTheirOwn) {
  const StoredTruth truth = fixture::stored_truth(recording_, folder_);
  const BagTrack track{"slam_mine", {{7'000'000, {1, 2, 3}, Quaterniond(0.6, 0.8, 0, 0)}}};
  GetParam().write(recording_.sensors, {0, &truth, {track}}, path_);
  const std::vector<ros::TFMessage> found = messages<ros::TFMessage>("/tf");
  ASSERT_EQ(found.size(), 9u) << "40 ms in steps of 5, and one of the track";
  std::size_t truths = 0, tracks = 0;
  for (const ros::TFMessage& message : found) {
    ASSERT_EQ(message.transforms.size(), 1u);
    const ros::TransformStamped& each = message.transforms[0];
    EXPECT_EQ(each.header.frame_id, "world");
    const auto p = Eigen::Vector3d::Map(each.translation.data());
    if (each.child_frame_id == "body") {
      EXPECT_EQ(p, recording_.truth.p_WB_m[5 * truths++]);
    } else {
      EXPECT_EQ(each.child_frame_id, "slam_mine");
      EXPECT_EQ(p, Vector3d(1, 2, 3));
      EXPECT_EQ(each.rotation_xyzw, (std::array<double, 4>{0.8, 0, 0, 0.6}));
      EXPECT_EQ(each.header.nanosec, 7'000'000u);
      ++tracks;
    }
  }
  EXPECT_EQ(truths, 8u);
  EXPECT_EQ(tracks, 1u);
  EXPECT_EQ(messages<ros::Odometry>("/slam_mine").at(0).child_frame_id, "slam_mine");
  // without the truth, the sensors are attached to the first estimate
  fs::remove_all(path_);
  GetParam().write(recording_.sensors, {0, nullptr, {track}}, path_);
  EXPECT_EQ(messages<ros::TFMessage>("/tf").at(0).transforms.at(0).child_frame_id, "body");
}

TEST_P(Frames, TheClockTicks) {
  GetParam().write(recording_.sensors, {}, path_);
  const std::vector<ros::Clock> ticks = messages<ros::Clock>("/clock");
  ASSERT_GT(ticks.size(), 10u);
  std::int64_t before = -1;
  for (const ros::Clock& tick : ticks) {
    const std::int64_t time = std::int64_t{tick.sec} * 1'000'000'000 + tick.nanosec;
    if (before >= 0) {
      EXPECT_GE(time - before, 10'000'000);
    }
    before = time;
  }
  EXPECT_EQ(ticks.front().sec, 1'000'000'000u);
}

TEST_P(Frames, AStatedPlaceHoldsAndAContradictionShowsBoth) {
  GetParam().write(recording_.sensors, {}, path_);
  const Imported found = GetParam().read(path_, {});
  EXPECT_THAT(found.notes, Contains(HasSubstr("/lidar/points: /tf_static contains the sensor's pose in 'body'")));
  EXPECT_TRUE(found.sensors.lidars[0].T_BL.isApprox(recording_.sensors.lidars[0].T_BL, 1e-12));
  BagReading stated;
  stated.sweeps.device.T_BL.translation() = Vector3d(0.5, 0.25, 0.125);
  const Imported held = GetParam().read(path_, stated);
  EXPECT_EQ(held.sensors.lidars[0].T_BL.translation(), Vector3d(0.5, 0.25, 0.125));
  EXPECT_THAT(held.notes, Contains(AllOf(HasSubstr("/lidar/points: /tf_static states the sensor's pose in 'body' as"),
                                         HasSubstr("but your option states (0.5 "))));
  // the same position stated twice is no contradiction
  stated.sweeps.device.T_BL = recording_.sensors.lidars[0].T_BL;
  EXPECT_THAT(GetParam().read(path_, stated).notes, Not(Contains(HasSubstr("caution: /tf_static"))));
}

TEST_P(Frames, CloudsInTheWorldAreNoSensors) {
  BagTrack track{"mine", {}, {20'000'000, 30'000'000}};
  track.cloud = [](const BagTrack&, std::size_t number) {
    return number == 0 ? BagCloud{{{1, 2, 3}, {4, 5, 6}}, {0.5f, 0.25f}} : BagCloud{};
  };
  GetParam().write(recording_.sensors, {0, nullptr, {track}}, path_);
  ASSERT_EQ(messages<ros::PointCloud2>("/mine/points").size(), 1u) << "one without points is left out";
  const ros::PointCloud2 written = messages<ros::PointCloud2>("/mine/points").at(0);
  ASSERT_EQ(written.fields.size(), 4u);
  EXPECT_EQ(written.fields[3].name, "error_m");
  EXPECT_EQ(written.point_step, 16u);
  float numbers[8];
  ASSERT_EQ(written.data.size(), sizeof numbers);
  std::memcpy(numbers, written.data.data(), sizeof numbers);
  EXPECT_THAT(numbers, ElementsAre(1, 2, 3, 0.5f, 4, 5, 6, 0.25f));
  const Imported imported = GetParam().read(path_, {});
  EXPECT_EQ(imported.sensors.lidars.size(), 1u);
  EXPECT_THAT(imported.notes, Contains(HasSubstr("/mine/points: the points are in frame 'world'")));
}

ros::TransformStamped hung(const std::string& child, const std::string& parent, const Vector3d& p,
                           const Quaterniond& q = Eigen::Quaterniond::Identity()) {
  return transform_message(p, q, child, header_of(1'000'000'000, parent));
}

/// Writes five messages of an IMU at rest, whose topic has the name of its frame; each message is written `times`
/// times.
void write_imu(BagWriter& bag, const std::string& frame, int times = 1) {
  sim::ImuRecord imu;
  imu.period_ns = 10'000'000;
  for (std::size_t k = 0; k < 5; ++k) {
    imu.gyro_rad_s.emplace_back(0, 0, 0);
    imu.accel_m_s2.emplace_back(0, 0, 9.8);
    const std::int64_t stamp = 1'000'000'000 + 10'000'000 * static_cast<std::int64_t>(k);
    for (int i = 0; i < times; ++i) bag.write(frame, stamp, imu_message(imu, k, header_of(stamp, frame)));
  }
}

/// Writes a bag with an IMU "imu" and these frames.
void write_frames(BagWriter& bag, const std::vector<ros::TransformStamped>& frames) {
  bag.write("/tf_static", 1'000'000'000, ros::TFMessage{frames});
  write_imu(bag, "/imu");
  bag.finish();
}

TEST_P(Frames, AreFollowedThroughOthers) {
  const Quaterniond turn(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  // as on a robot, both sensors are attached to a mast that is attached to the base
  write_frames(*GetParam().writer(path_),
               {hung("mast", "base_link", {0, 0, 1}, turn), hung("imu", "mast", {0.5, 0, 0})});
  const Imported found = GetParam().read(path_, {});
  const Isometry3d T_BI = found.sensors.imus.at(0).T_BI;
  EXPECT_TRUE(T_BI.translation().isApprox(Vector3d(0, 0.5, 1))) << T_BI.translation();
  EXPECT_TRUE(T_BI.linear().isApprox(turn.toRotationMatrix()));
  EXPECT_THAT(found.notes, Contains(HasSubstr("/imu: /tf_static contains the sensor's pose in 'base_link'")));
}

TEST_P(Frames, ThatNobodyTiesToTheBodyPlaceNothing) {
  write_frames(*GetParam().writer(path_), {hung("imu", "mast", {0.5, 0, 0})});
  const Imported found = GetParam().read(path_, {});
  EXPECT_TRUE(found.sensors.imus.at(0).T_BI.isApprox(Eigen::Isometry3d::Identity()));
}

TEST_P(Frames, SensorsWithoutABodyStandBesideEachOther) {
  const Quaterniond turn(Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ()));
  const auto bag = GetParam().writer(path_);
  bag->write("/robot/tf_static", 1'000'000'000,
             ros::TFMessage{{hung("left", "os_sensor", {0, 0, 1}, turn), hung("right", "os_sensor", {0.5, 0, 1})}});
  for (const char* frame : {"/left", "/right", "/elsewhere"}) write_imu(*bag, frame);
  bag->finish();
  const Imported found = GetParam().read(path_, {});
  const std::vector<sim::ImuRecord>& imus = found.sensors.imus;
  ASSERT_EQ(imus.size(), 3u);
  EXPECT_TRUE(imus[0].T_BI.isApprox(Eigen::Isometry3d::Identity()));
  EXPECT_LT((imus[1].T_BI.translation() - Vector3d(0, -0.5, 0)).norm(), 1e-12);
  EXPECT_TRUE(imus[1].T_BI.linear().isApprox(turn.toRotationMatrix().transpose(), 1e-12));
  EXPECT_THAT(found.notes, Contains(HasSubstr("/right: /tf_static contains the sensor's pose relative to /left")));
  EXPECT_THAT(found.notes, Contains(HasSubstr("/elsewhere: neither /tf_static nor --lever-arm")));
  EXPECT_THAT(found.notes, Contains(HasSubstr("'left' is the primary IMU, because its topic comes first")));
  // when the pose of the first sensor is given, the second one's follows from it
  BagReading given;
  given.imu_topics = {"/left", "/right"};
  given.imu.T_BI.translation() = Vector3d(1, 2, 3);
  const Imported held = GetParam().read(path_, given);
  EXPECT_LT((held.sensors.imus[0].T_BI.translation() - Vector3d(1, 2, 3)).norm(), 1e-12);
}

TEST_P(Frames, APoseOfAnotherFrameIsMovedToTheBody) {
  const auto bag = GetParam().writer(path_);
  bag->write("/tf_static", 1'000'000'000, ros::TFMessage{{hung("mast", "base_link", {0, 0.5, 2})}});
  write_imu(*bag, "/imu");
  BagTrack::Pose pose;
  for (int k = 0; k < 5; ++k) {
    const std::int64_t stamp = 1'000'000'000 + 10'000'000 * k;
    pose.p_WB_m = {7, 8, 9};
    for (const char* child : {"mast", "base_link", "unknown"})
      bag->write(std::string("/of_") + child, stamp, odometry_message(pose, child, header_of(stamp, "world")));
  }
  bag->finish();
  const auto start = [&](const std::string& child, ReferenceOf whose, const char* said) {
    BagReading reading;
    reading.reference_topic = "/of_" + child;
    reading.reference_of = whose;
    const Imported found = GetParam().read(path_, reading);
    EXPECT_THAT(found.notes, said[0] == 0 ? Not(Contains(HasSubstr("according to the messages, the poses belong to")))
                                          : testing::Matcher<std::vector<std::string>>(Contains(HasSubstr(said))));
    return found.reference->p_WB_m.at(0);
  };
  EXPECT_EQ(start("mast", ReferenceOf::named,
                  "/of_mast: according to the messages, the poses belong to the frame 'mast'; the import converts the "
                  "poses to poses "
                  "of the body"),
            Vector3d(7, 7.5, 7));
  EXPECT_EQ(start("mast", ReferenceOf::body, ""), Vector3d(7, 8, 9));
  EXPECT_EQ(start("base_link", ReferenceOf::named, ""), Vector3d(7, 8, 9));
  EXPECT_EQ(start("unknown", ReferenceOf::named, "The pose of this frame on the body is unknown"), Vector3d(7, 8, 9));
}

// a motion capture system sends such a transform
TEST_P(Frames, ATransformIsAReference) {
  const auto bag = GetParam().writer(path_);
  write_imu(*bag, "/imu");
  for (int k = 0; k < 5; ++k) {
    const std::int64_t stamp = 1'000'000'000 + 10'000'000 * k;
    bag->write("/vicon", stamp,
               transform_message({7, 8, 9}, Quaterniond(0.6, 0.8, 0, 0), "rig", header_of(stamp, "world")));
  }
  bag->finish();
  BagReading reading;
  reading.reference_topic = "/vicon";
  const Imported found = GetParam().read(path_, reading);
  ASSERT_TRUE(found.reference.has_value());
  EXPECT_EQ(found.reference->p_WB_m.at(0), Vector3d(7, 8, 9));
  EXPECT_TRUE(found.reference->q_WB.at(0).isApprox(Quaterniond(0.6, 0.8, 0, 0), 1e-12));
  EXPECT_THAT(found.notes, Contains(HasSubstr("/vicon: according to the messages, the poses belong to the frame 'rig'. "
                                              "The pose of this frame on the body is unknown")));
}

TEST_P(Frames, AStatedZeroIsAMounting) {
  const auto bag = GetParam().writer(path_);
  write_imu(*bag, "/imu");
  bag->finish();
  BagReading reading;
  const auto missing = Contains(HasSubstr("neither /tf_static nor --lever-arm states the sensor's pose"));
  EXPECT_THAT(GetParam().read(path_, reading).notes, missing);
  reading.imu_placed = true;
  EXPECT_THAT(GetParam().read(path_, reading).notes, Not(missing));
}

// --lever-arm states the position of the first IMU; without the rotation of /tf_static, tracking fails
TEST_P(Frames, AStatedLeverArmKeepsTheOrientationOfTheImuAndTheOtherImus) {
  const Matrix3d mounted = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitX()).toRotationMatrix();
  recording_.sensors.imus[0].T_BI.linear() = mounted;
  GetParam().write(recording_.sensors, {}, path_);
  BagReading reading;
  reading.imu_placed = true;
  reading.imu.T_BI.translation() = Vector3d(0.1, 0.2, 0.3);
  const std::vector<sim::ImuRecord> imus = GetParam().read(path_, reading).sensors.imus;
  ASSERT_EQ(imus.size(), 2u);
  EXPECT_TRUE(imus[0].T_BI.linear().isApprox(mounted, 1e-12));
  EXPECT_EQ(imus[0].T_BI.translation(), Vector3d(0.1, 0.2, 0.3));
  EXPECT_TRUE(imus[1].T_BI.isApprox(recording_.sensors.imus[1].T_BI, 1e-12));
}

// zeros of an estimate mean unknown; zeros of the truth are values
TEST_P(Frames, WhatAnEstimateDoesNotKnowIsUnknown) {
  const StoredTruth truth = fixture::stored_truth(recording_, folder_);
  BagTrack track{"mine", {{7'000'000, {1, 2, 3}, Eigen::Quaterniond::Identity()}}};
  track.poses[0].covariance(0, 0) = 4.0;
  GetParam().write(recording_.sensors, {0, &truth, {track}}, path_);
  const ros::Odometry mine = messages<ros::Odometry>("/mine").at(0), known = messages<ros::Odometry>("/truth").at(0);
  EXPECT_EQ(mine.pose_covariance[0], 4.0);
  for (const std::size_t row : {3u, 4u, 5u}) EXPECT_EQ(mine.pose_covariance[7 * row], -1.0);
  for (std::size_t row = 0; row < 6; ++row) {
    EXPECT_EQ(mine.twist_covariance[7 * row], -1.0);
    EXPECT_EQ(known.pose_covariance[7 * row], 0.0);
    EXPECT_EQ(known.twist_covariance[7 * row], 0.0);
  }
  EXPECT_EQ(mine.linear_velocity, (std::array<double, 3>{}));
  EXPECT_NE(known.angular_velocity, (std::array<double, 3>{}));
}

TEST_P(Frames, AMessageThatIsThereTwiceIsTakenOnce) {
  const auto bag = GetParam().writer(path_);
  write_imu(*bag, "/imu", 2);
  bag->finish();
  const Imported found = GetParam().read(path_, {});
  EXPECT_EQ(found.sensors.imus.at(0).time_ns.size(), 5u);
  EXPECT_THAT(found.notes, Contains(HasSubstr("the import left out 5 duplicate messages")));
}

TEST_P(Frames, WhatNoSensorAsksForMayMakeNoSense) {
  write_frames(*GetParam().writer(path_),
               {hung("map", "utm", {456e3, 0, 0}), hung("body", "map", {0, 0, 0}), hung("imu", "body", {0.5, 0, 0}),
                hung("camera", "camera", {0, 0, 0}), hung("lamp", "body", {0, 0, 0}, Quaterniond(0, 0, 0, 0))});
  const Imported found = GetParam().read(path_, {});
  EXPECT_EQ(found.sensors.imus.at(0).T_BI.translation(), Vector3d(0.5, 0, 0));
  for (const char* said :
       {"the transform of frame 'map' relative to frame 'utm': the translation must be finite and at most 1 km",
        "'camera': the frame is its own parent", "'lamp' relative to frame 'body': the rotation quaternion has norm"})
    EXPECT_THAT(found.notes, Contains(HasSubstr(said)));
}

TEST_P(Frames, AFrameOnTwoOthersIsReported) {
  write_frames(*GetParam().writer(path_), {hung("imu", "body", {0.5, 0, 0}), hung("imu", "other", {0.1, 0, 0})});
  EXPECT_THAT(GetParam().read(path_, {}).notes, Contains(HasSubstr("'imu' has two parents, 'body' and later 'other'")));
  fs::remove_all(path_);
  write_frames(*GetParam().writer(path_), {hung("imu", "body", {0.5, 0, 0}), hung("imu", "body", {0.1, 0, 0})});
  EXPECT_THAT(GetParam().read(path_, {}).notes, Not(Contains(HasSubstr("has two parents")))) << "said anew";
}

TEST_P(Frames, ThatMakeNoSenseAreRefused) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const std::pair<std::vector<ros::TransformStamped>, const char*> cases[] = {
      {{hung("imu", "mast", {0, 0, 0}), hung("mast", "imu", {0, 0, 0}), hung("x", "body", {0, 0, 0})},
       "and its parent frames form a loop"},
      {{hung("imu", "mast", {0, 0, 0}), hung("mast", "imu", {0, 0, 0})},
       "and its parent frames form a loop"},  // no body
      {{hung("imu", "body", {kNan, 0, 0})},
       "the transform of frame 'imu' relative to frame 'body': the translation must be finite and at most 1 km"},
      {{hung("imu", "body", {0, 2000, 0})}, "the translation must be finite and at most 1 km"},
      {{hung("imu", "body", {0, 0, 0}, Quaterniond(0, 0, 0, 0))},
       "the rotation quaternion has norm 0.000000; its norm must be 1"},
      {{hung("imu", "body", {0, 0, 0}, Quaterniond(kNan, 0, 0, 0))}, "the rotation quaternion has norm nan"}};
  for (const auto& [frames, complaint] : cases) {
    fs::remove_all(path_);
    write_frames(*GetParam().writer(path_), frames);
    EXPECT_THAT(test::complaint([&] { GetParam().read(path_, {}); }),
                AllOf(HasSubstr("/tf_static: "), HasSubstr(complaint)));
  }
}

}  // namespace
}  // namespace tumble::scenarios
