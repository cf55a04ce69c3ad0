// SPDX-License-Identifier: BSD-3-Clause
// The test checks that the methods `tumble` and `tumble_lag` use what a recording contains besides the primary IMU's
// readings (further IMUs, the device's clip flags, stated ranges, saturation of the accelerometer), and report faults.
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/scoring/score.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "stand_ins/stand_ins.hpp"
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

Estimate estimated_rates(const std::string& method, const sim::Recording& recording) {
  Estimate estimate = find_methods("rate/" + method).front()->run(recording.sensors, {}, {&recording.truth});
  EXPECT_TRUE(estimate.status.ok()) << estimate.status.message();
  EXPECT_EQ(estimate.rates.size(), recording.sensors.imus.front().time_ns.size());
  return estimate;
}

double clipped_median(const std::string& method, const sim::Recording& recording) {
  const ScoringInput input{&recording.sensors, &recording.truth, nullptr};
  for (const Score& score : score(Kind::rate, {estimated_rates(method, recording), input})) {
    if (score.metric == "rate_error_clipped_median_rad_s") return score.value;
  }
  ADD_FAILURE() << "no score";
  return NAN;
}

// adds a second IMU of the same kind at another position and orientation, with samples half a period later
void add_second_imu(const std::string& name, const Vector3d& p_B_m, bool with_gyro, sim::Recording& recording) {
  const testing::SyntheticMotion motion;
  sim::ImuRecord record = recording.sensors.imus.front();
  sim::ImuTruth truth = recording.truth.imus.front();
  record.name = truth.name = name;
  record.T_BI.translation() = p_B_m;
  record.T_BI.linear() = Eigen::AngleAxisd(1.1, Vector3d(-2, 1, 1).normalized()).toRotationMatrix();
  truth.T_BI = record.T_BI;
  const std::int64_t half_ns = record.period_ns / 2;
  for (std::size_t k = 0; k < record.time_ns.size(); ++k) {
    const double middle_s = 1e-9 * static_cast<double>(record.time_ns[k]);
    record.time_ns[k] += half_ns;
    const Matrix3d R_IB = record.T_BI.linear().transpose();
    const Vector3d rate = R_IB * motion.rate_B_rad_s(middle_s);
    record.gyro_rad_s[k] = rate.cwiseMax(-motion.rail_rad_s).cwiseMin(motion.rail_rad_s);
    if (!with_gyro) record.gyro_rad_s[k] = Eigen::Vector3d::Constant(motion.rail_rad_s);
    record.accel_m_s2[k] = R_IB * motion.specific_force_B_m_s2(middle_s, p_B_m);
  }
  recording.sensors.imus.push_back(record);
  recording.truth.imus.push_back(truth);
}

// an external torque causes the rotation, so one IMU alone cannot determine the saturated rate
TEST(RateRecording, FurtherImusAreUsedAndTheReferenceIsNot) {
  const sim::Recording alone = testing::synthetic_rig();
  sim::Recording reference = alone, gyro = alone, accelerometers = alone;
  add_second_imu("imu_reference", {0.2, 0.1, -0.1}, true, reference);
  add_second_imu("imu_2", {0.2, 0.1, -0.1}, true, gyro);
  add_second_imu("imu_2", {0.2, 0.1, -0.1}, false, accelerometers);
  add_second_imu("imu_3", {-0.1, 0.2, 0.15}, false, accelerometers);
  for (const std::string method : {"tumble", "tumble_lag"}) {
    const double one = clipped_median(method, alone);
    EXPECT_EQ(clipped_median(method, reference), one) << method;
    EXPECT_LT(clipped_median(method, gyro), 0.1 * one) << method;
    EXPECT_LT(clipped_median(method, accelerometers), 0.25 * one) << method;
  }
  EXPECT_EQ(estimated_rates("tumble", reference).health.at("imus"), 1.0);
  EXPECT_EQ(estimated_rates("tumble", accelerometers).health.at("imus"), 3.0);
}

// the saturation level fluctuates: there is no plateau and no stated range, so only the flags show the saturation
TEST(RateRecording, FlagsOfTheDeviceAreUsed) {
  sim::Recording recording = testing::synthetic_rig();
  sim::ImuRecord& imu = recording.sensors.imus.front();
  imu.stated_gyro_range_rad_s = 0.0;
  std::size_t flagged = 0;
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    for (int j = 0; j < 3; ++j) {
      double& reading = imu.gyro_rad_s[k][j];
      if (std::abs(reading) < 10.5) continue;
      reading *= 1.0 - 0.03 * std::abs(std::sin(0.7 * static_cast<double>(k)));
      imu.clip_flags[k] = static_cast<std::uint8_t>(imu.clip_flags[k] | 1u << j);
      ++flagged;
    }
  }
  ASSERT_GT(flagged, 50u);
  sim::Recording unflagged = recording;
  for (std::uint8_t& flags : unflagged.sensors.imus.front().clip_flags) flags = 0;
  for (const std::string method : {"tumble", "tumble_lag"}) {
    const Estimate with = estimated_rates(method, recording), without = estimated_rates(method, unflagged);
    std::size_t told = 0, guessed = 0;
    for (std::size_t k = 0; k < with.rates.size(); ++k) {
      if (imu.clip_flags[k] == 0) continue;
      told += with.rates[k].clipped_axes == imu.clip_flags[k];
      guessed += without.rates[k].clipped_axes == imu.clip_flags[k];
    }
    EXPECT_EQ(told, flagged) << method;
    EXPECT_LT(guessed, flagged / 2) << method;
  }
}

TEST(RateRecording, AStatedRangeThatTheDataContradictIsReported) {
  sim::Recording recording = testing::synthetic_rig();
  EXPECT_EQ(estimated_rates("tumble", recording).health.at("gyro_axes_beyond_stated_range"), 0.0);
  const double right = clipped_median("tumble", recording);
  for (const double stated : {7.854, 14.0}) {
    recording.sensors.imus.front().stated_gyro_range_rad_s = stated;
    const Estimate estimate = estimated_rates("tumble", recording);
    EXPECT_GE(estimate.health.at("gyro_axes_beyond_stated_range"), 1.0) << stated;
    EXPECT_EQ(estimate.health.at("gyro_limit_x_rad_s"), 10.5) << stated;
    EXPECT_EQ(clipped_median("tumble", recording), right) << stated;  // the plateau is sufficient
  }
}

TEST(RateRecording, UnitsThatLookWrongAreReported) {
  sim::Recording recording = testing::synthetic_rig();
  EXPECT_TRUE(estimated_rates("tumble", recording).faults.ok());
  sim::Recording degrees = recording, in_g = recording;
  for (Vector3d& rate : degrees.sensors.imus.front().gyro_rad_s) rate *= 57.29578;
  for (Vector3d& force : in_g.sensors.imus.front().accel_m_s2) force /= 9.80665;
  const Status refused = find_methods("rate/tumble").front()->run(degrees.sensors, {}, {&degrees.truth}).status;
  EXPECT_FALSE(refused.ok()) << "beyond twice the range that is stated";
  EXPECT_TRUE(has_finding(HealthFinding::Kind::wrong_force_magnitude_at_rest, estimated_rates("tumble", in_g)));
}

// an accelerometer axis is saturated during a rotation in free fall; with a stated range, the method uses the reading
// as a bound, and without a range, the method mistakes the bound for a measurement
TEST(RateRecording, ClippedAxesOfTheAccelerometerAreBounds) {
  sim::Recording recording = testing::synthetic_rig();
  sim::ImuRecord& imu = recording.sensors.imus.front();
  const testing::SyntheticMotion motion;
  const Vector3d p_B = imu.T_BI.translation();
  double largest = 0.0;
  for (std::size_t k = 0; k < imu.time_ns.size(); ++k) {
    const double middle_s = 1e-9 * static_cast<double>(imu.time_ns[k]) - 0.0025;
    imu.accel_m_s2[k] =
        imu.T_BI.linear().transpose() *
        (motion.specific_force_B_m_s2(middle_s, p_B) - motion.specific_force_B_m_s2(middle_s, Eigen::Vector3d::Zero()));
    largest = std::max(largest, imu.accel_m_s2[k].cwiseAbs().maxCoeff());
  }
  const double free = clipped_median("tumble", recording);
  const double rail = 0.85 * largest;
  std::size_t clipped = 0;
  for (Vector3d& force : imu.accel_m_s2) {
    clipped += force.cwiseAbs().maxCoeff() > rail;
    force = force.cwiseMax(-rail).cwiseMin(rail);
  }
  ASSERT_GT(clipped, 20u);
  // the readings fluctuate a little, so that no plateau shows the saturation
  for (std::size_t k = 0; k < imu.accel_m_s2.size(); ++k) {
    imu.accel_m_s2[k] *= 1.0 - 1e-3 * std::abs(std::sin(0.9 * static_cast<double>(k)));
  }
  imu.stated_accel_range_m_s2 = rail;
  const double stated = clipped_median("tumble", recording);
  imu.stated_accel_range_m_s2 = 1000.0;
  const double hidden = clipped_median("tumble", recording);
  // Without the stated range, the model of a steady spin uses the clipped forces, and limits the error: 0.144 rad/s
  // with the stated range, 0.128 rad/s without.
  EXPECT_LT(stated, 1.2 * hidden) << "without a rail " << free;
}

/// Returns the first 30 s of the wand's simulated recording.
sim::Sensors wand() {
  const auto folder = test::written(test::data_folders("repoimu").front());
  sim::Sensors out = import_imu_csv(folder / test::kStandInWand, {}, AccelUnit::m_s2, GyroUnit::rad_s,
                                    "time=0,gyro=8,9,10,accel=5,6,7")
                         .sensors;
  sim::ImuRecord& imu = out.imus.front();
  constexpr std::size_t kSamples = 3000;
  imu.time_ns.resize(kSamples);
  imu.gyro_rad_s.resize(kSamples);
  imu.accel_m_s2.resize(kSamples);
  if (!imu.clip_flags.empty()) imu.clip_flags.resize(kSamples);
  return out;
}

TEST(RateRecording, EachMethodReportsTheSaturationLimitsThatItFound) {
  const sim::Sensors twirled = wand();
  const test::WandRail rail;
  for (const char* const name : {"rate/tumble", "rate/tumble_lag", "attitude/tumble"}) {
    const auto health = find_methods(name).front()->run(twirled, {}, {}).health;
    ASSERT_TRUE(health.contains("gyro_limit_x_rad_s")) << name;
    EXPECT_NEAR(health.at("gyro_limit_x_rad_s"), rail.distance_rad_s, 0.01) << name;
    for (const char* const key : {"gyro_limit_y_rad_s", "gyro_limit_z_rad_s"})
      EXPECT_FALSE(health.contains(key)) << name << ' ' << key << ": no saturation limit was observed there";
  }
}

// In this draw, several tilted gyro axes are saturated together in each flight, so the readings do not determine the
// slopes of the saturation planes. A slope of -22 made the calibration invalid.
TEST(RateRecording, PlanesWithUndeterminedSlopesAreNotUsed) {
  const DataRoot data{test::source_dir()};
  const SimulatedDraw ball = simulate_draw(data, load_scenario(data, "ball"), 27, 1, Lidars::left_out);
  for (const char* method : {"tumble", "tumble_lag"}) (void)estimated_rates(method, ball.recording);
}

}  // namespace
}  // namespace tumble::scenarios
