// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/triage.hpp"
#include "sim/random/stream.hpp"
#include "tests/testing.hpp"
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
  for (const Score& score : score(method.info.kind, {out.estimate, input})) {
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

INSTANTIATE_TEST_SUITE_P(All, SlamPeer, ::testing::Values("slam/icp_raw", "slam/published"), test_name);

INSTANTIATE_TEST_SUITE_P(Some, SlamPeerWithGyro, ::testing::Values("slam/icp_raw", "slam/published"), test_name);

TEST(SlamMethods, SayThatTheyNeedAnImu) {
  sim::Recording recording = testing::synthetic_rig(gentle());
  recording.sensors.imus.clear();
  recording.truth.imus.clear();
  int tried = 0;
  for (const Method& method : methods()) {
    if (method.info.kind != Kind::slam) continue;
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
