// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/slam_constant_velocity.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/triage.hpp"
#include "sim/random/stream.hpp"
#include "tumble/common/status.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

// the compared methods must be fair: each of them works on a motion that does not saturate the gyro
namespace tumble::scenarios {
namespace {

/// Returns half a turn in three seconds over a path of a metre and a half, with a saturation level that is never
/// reached.
testing::SyntheticMotion gentle() {
  testing::SyntheticMotion motion;
  motion.angle_rad = 3.0;
  motion.rail_rad_s = 100.0;
  return motion;
}

struct PeerOutcome {
  Estimate estimate;
  double end_error_m = 0.0, end_error_rad = 0.0;
};

PeerOutcome outcome_of(const std::string& name, const sim::Recording& recording) {
  const Method& method = *find_methods(name).at(0);
  PeerOutcome out;
  out.estimate = method.run(recording.sensors, {}, {&recording.truth});
  EXPECT_TRUE(out.estimate.status.ok()) << name << ": " << out.estimate.status.message();
  const ScoringInput input{&recording.sensors, &recording.truth, nullptr};
  bool any = false;
  for (const Score& score : score(method.info.kind, out.estimate, input)) {
    if (score.metric == "translation_error_end_m") out.end_error_m = score.value, any = true;
    if (score.metric == "rotation_error_end_rad") out.end_error_rad = score.value;
  }
  EXPECT_TRUE(any) << name;
  return out;
}

/// Sweeps that are cast within a microsecond at their end, as triage makes them, are easier to register.
TEST(SeedChain, SweepsOfAnInstantDoNotLeadItAstray) {
  sim::Recording recording = testing::synthetic_rig(gentle());
  const double bent_m = outcome_of("slam/icp_raw", recording).end_error_m;
  const auto inputs = true_inputs();
  const auto unbent =
      std::find_if(inputs.begin(), inputs.end(), [](const auto& i) { return i.name == "lidar_unbent"; });
  ASSERT_NE(unbent, inputs.end());
  ASSERT_TRUE(unbent->replace(recording.sensors, recording.truth));
  const double unbent_m = outcome_of("slam/icp_raw", recording).end_error_m;
  EXPECT_LT(bent_m, 0.2);
  EXPECT_LT(unbent_m, 0.2);
}

/// The test checks that the rest at the start is the mean of its samples, each of them counted once.
TEST(RigidChain, TheFirstSampleOfTheRestCountsOnce) {
  std::vector<ImuSample> samples(4);
  for (std::size_t k = 0; k < samples.size(); ++k) {
    samples[k].time_ns = static_cast<TimeNs>(k) * 10'000'000;
    samples[k].angular_velocity_rad_s = {0.01, -0.02, 0.005};
    samples[k].specific_force_m_s2 = {k == 0 ? 0.4 : 0.0, 0.0, 9.8};  // within the spread of a rest
  }
  StartAtRest start;
  ASSERT_TRUE(start_at_rest(samples, start).ok());
  EXPECT_NEAR((start.gyro_bias_rad_s - samples[0].angular_velocity_rad_s).norm(), 0.0, 1e-15);
  const Eigen::Vector3d up = start.q_WI * Eigen::Vector3d(0.1, 0.0, 9.8).normalized();
  EXPECT_NEAR(up.z(), 1.0, 1e-12);
  // a sample with a push is not part of the rest
  samples[2].specific_force_m_s2.x() = 2.0;
  samples[2].angular_velocity_rad_s.x() = 0.03;
  ASSERT_TRUE(start_at_rest(samples, start).ok());
  EXPECT_NEAR(start.gyro_bias_rad_s.x(), 0.01, 1e-15);
  // a body that turns from the start on is levelled by the first sample
  samples[0].angular_velocity_rad_s.x() = 1.0;
  ASSERT_TRUE(start_at_rest(samples, start).ok());
  EXPECT_EQ(start.gyro_bias_rad_s.norm(), 0.0);
}

/// The test checks that a number has the same bounds here and in the library.
TEST(SlamParameters, AreBoundAsTheLibraryBindsThem) {
  for (const sim::Parameter& parameter : find_methods("slam/icp").at(0)->info.parameters) {
    if (parameter.name != "map_voxel_m") continue;
    LidarInertialOdometry::Params params;
    params.expert.map.spacing_m = 0.0;
    params.expert.map.voxel_m = parameter.low;
    EXPECT_NO_THROW(LidarInertialOdometry{params});
    params.expert.map.voxel_m = 0.99 * parameter.low;
    EXPECT_THROW(LidarInertialOdometry{params}, InvalidParams);
    return;
  }
  FAIL() << "no such parameter";
}

TEST(ImuCheck, OurAttitudeMethodsSayThatTheirImuFroze) {
  sim::Recording recording = testing::synthetic_rig(gentle());
  sim::Stream noise(3, "noise");
  sim::ImuRecord& imu = recording.sensors.imus.front();
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    for (int j = 0; j < 3; ++j) imu.gyro_rad_s[k][j] += 0.01 * (noise.uniform() - 0.5);
    for (int j = 0; j < 3; ++j) imu.accel_m_s2[k][j] += 0.01 * (noise.uniform() - 0.5);
  }
  sim::Sensors frozen = recording.sensors;
  for (std::size_t k = imu.time_ns.size() / 2; k < imu.time_ns.size(); ++k) {
    frozen.imus.front().gyro_rad_s[k] = imu.gyro_rad_s[imu.time_ns.size() / 2];
    frozen.imus.front().accel_m_s2[k] = imu.accel_m_s2[imu.time_ns.size() / 2];
  }
  int asked = 0;
  for (const Method& method : methods()) {
    if (method.info.kind != Kind::attitude || !method.info.ours || method.info.needs_truth) continue;
    const auto says = [&](const sim::Sensors& sensors) {
      const Estimate estimate = method.run(sensors, {}, {nullptr});
      return !estimate.status.ok() || has_finding(HealthFinding::Kind::frozen_sensor, estimate);
    };
    EXPECT_FALSE(says(recording.sensors)) << method.info.name;
    EXPECT_TRUE(says(frozen)) << method.info.name;
    ++asked;
  }
  EXPECT_EQ(asked, 3);
}

class SlamPeer : public ::testing::TestWithParam<const char*> {};

TEST_P(SlamPeer, EndsWhereAGentleMotionEnds) {
  const PeerOutcome outcome = outcome_of(GetParam(), testing::synthetic_rig(gentle()));
  EXPECT_LT(outcome.end_error_m, 0.05);
  EXPECT_LT(outcome.end_error_rad, 0.02);
}

/// SlamPeerWithGyro tests the methods that use the gyro's readings unchanged.
class SlamPeerWithGyro : public SlamPeer {};

// negative control: the measure detects the effect of a saturated gyro on these methods
TEST_P(SlamPeerWithGyro, EndsElsewhereWhereItClips) {
  testing::SyntheticMotion wild;
  wild.angle_rad = 40.0;  // 25 rad/s
  const PeerOutcome outcome = outcome_of(GetParam(), testing::synthetic_rig(wild));
  EXPECT_GT(std::max(outcome.end_error_m, outcome.end_error_rad), 0.1);
}

std::string test_name(const ::testing::TestParamInfo<const char*>& param) {
  const std::string name = param.param;
  return name.substr(name.find('/') + 1);
}

INSTANTIATE_TEST_SUITE_P(All, SlamPeer, ::testing::Values("slam/constant_velocity", "slam/icp_raw", "slam/published"),
                         test_name);

INSTANTIATE_TEST_SUITE_P(Some, SlamPeerWithGyro, ::testing::Values("slam/icp_raw", "slam/published"), test_name);

TEST(ConstantVelocity, NeedsNoImu) {
  sim::Recording recording = testing::synthetic_rig(gentle());
  const PeerOutcome with = outcome_of("slam/constant_velocity", recording);
  recording.sensors.imus.clear();
  const PeerOutcome without = outcome_of("slam/constant_velocity", recording);
  EXPECT_EQ(without.estimate.sweeps.size(), 60u);
  EXPECT_GT(without.estimate.poses.size(), 500u);
  EXPECT_LT(without.end_error_m, 0.05);
  EXPECT_NEAR(without.end_error_m, with.end_error_m, 0.02);
}

TEST(ConstantVelocity, NeedsNoTimesOfThePointsWhereTheRecordingSaysSo) {
  // the skew is small: the points of a sweep lie within a millimetre of their positions at its start
  testing::SyntheticMotion slow;
  slow.angle_rad = 0.02;
  slow.displacement_m = {0.05, -0.03, 0.0};
  slow.rail_rad_s = 100.0;
  sim::Recording recording = testing::synthetic_rig(slow);
  recording.sensors.imus.clear();
  sim::LidarRecord& lidar = recording.sensors.lidars.front();
  std::fill(lidar.offset_ns.begin(), lidar.offset_ns.end(), 0u);
  // when the record does not state how its points are timed, equal times mean that a driver lost the stamps
  const Estimate refused = find_methods("slam/constant_velocity").at(0)->run(recording.sensors, {}, {});
  EXPECT_FALSE(refused.status.ok());
  for (const sim::PointTimes times : {sim::PointTimes::not_skewed, sim::PointTimes::unknown}) {
    lidar.point_times = times;
    const PeerOutcome outcome = outcome_of("slam/constant_velocity", recording);
    EXPECT_EQ(outcome.estimate.sweeps.size(), 60u);
    // without a prior, a sweep drifts where its rings lie on those of the map; measured 0.04
    EXPECT_LT(outcome.end_error_m, 0.06);
    // a pose belongs to the only time of its sweep
    EXPECT_EQ(outcome.estimate.sweeps[30].pose.time_ns, lidar.sweep_start_ns[30]);
  }
}

TEST(SlamMethods, SayThatTheyNeedAnImu) {
  sim::Recording recording = testing::synthetic_rig(gentle());
  recording.sensors.imus.clear();
  recording.truth.imus.clear();
  int tried = 0;
  for (const Method& method : methods()) {
    if (method.info.kind != Kind::slam || method.info.name == "constant_velocity") continue;
    if (!method.info.applies_to({"rig"})) continue;
    const Estimate estimate = method.run(recording.sensors, {}, {&recording.truth});
    EXPECT_EQ(estimate.status.error_code, ErrorCode::empty) << method.info.name;
    EXPECT_EQ(std::string(estimate.status.field), "imus") << method.info.name;
    ++tried;
  }
  EXPECT_GE(tried, 7);
}

}  // namespace
}  // namespace tumble::scenarios
