// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>

#include "scenarios/draw/distribution.hpp"
#include "scenarios/draw/scenario.hpp"
#include "scenarios/draw/without_lidars.hpp"
#include "scenarios/errors.hpp"
#include "scenarios/estimates/findings.hpp"
#include "scenarios/methods/bridge.hpp"
#include "scenarios/methods/rate_tumble.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/simulate.hpp"
#include "stand_ins/stand_ins.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

sim::Values defaults() {
  const SettingsTable* const stages[] = {&rate_tumble_settings()};
  return resolve_settings("method.rate/tumble", {}, stages);
}

// the synthetic rig never flies, so its runs do not improve the calibration; the next run must not have a larger
// uncertainty than the prior
TEST(RateLearnt, RunsThatLearnNothingDoNotWearOutThePrior) {
  const sim::Recording recording = testing::synthetic_rig();
  std::optional<CalibratedRig> rig, next;
  ASSERT_TRUE(run_rate_tumble(recording.sensors, defaults(), nullptr, &rig).status.ok());
  ASSERT_TRUE(rig);
  ASSERT_TRUE(run_rate_tumble(recording.sensors, defaults(), &*rig, &next).status.ok());
  ASSERT_TRUE(next);
  for (int j = 0; j < 3; ++j) {
    EXPECT_LT(next->calibration.covariance(j, j), 1.01 * rig->calibration.covariance(j, j)) << j;
    EXPECT_GT(next->calibration.covariance(j, j), 0.0) << j;
  }
}

TEST(RateLearnt, TheNextRunStartsFromWhatItIsGiven) {
  const sim::Recording recording = testing::synthetic_rig();
  CalibratedRig given;
  std::optional<CalibratedRig> found;
  given.calibration.constants.lever_arm_m = {0.4, 0.1, -0.2};
  given.calibration.covariance = 1e-12 * RigConstants::Matrix::Identity();
  ASSERT_TRUE(run_rate_tumble(recording.sensors, defaults(), &given, &found).status.ok());
  ASSERT_TRUE(found);
  // four times the stated covariance corresponds to a standard deviation of 2e-6
  EXPECT_NEAR((found->calibration.constants.lever_arm_m - given.calibration.constants.lever_arm_m).norm(), 0.0, 1e-5);
}

TEST(RateLearnt, WithoutAStartItIsTheMethodOfTheRegistry) {
  const sim::Recording recording = testing::synthetic_rig();
  const Estimate registered = find_methods("rate/tumble").front()->run(recording.sensors, {}, {});
  const Estimate here = run_rate_tumble(recording.sensors, defaults(), nullptr, nullptr);
  ASSERT_EQ(here.rates.size(), registered.rates.size());
  ASSERT_GT(here.rates.size(), 0u);
  for (std::size_t k = 0; k < here.rates.size(); ++k) {
    ASSERT_EQ(here.rates[k].w_WI_I_rad_s, registered.rates[k].w_WI_I_rad_s) << k;
  }
}

TEST(RateLearnt, AFailedRunLeavesWhatWasLearnt) {
  sim::Recording recording = testing::synthetic_rig();
  for (Eigen::Vector3d& rate : recording.sensors.imus.front().gyro_rad_s)
    rate.x() = std::numeric_limits<double>::quiet_NaN();
  std::optional<CalibratedRig> rig = CalibratedRig();
  rig->calibration.constants.lever_arm_m = {1.0, 2.0, 3.0};
  EXPECT_FALSE(run_rate_tumble(recording.sensors, defaults(), nullptr, &rig).status.ok());
  EXPECT_EQ(rig->calibration.constants.lever_arm_m, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(RateLearnt, BatchAndStreamStartFromWhatEitherHasLearnt) {
  const sim::Recording recording = testing::synthetic_rig();
  CalibratedRig rig;
  rig.calibration.constants.lever_arm_m = {0.4, 0.1, -0.2};
  rig.calibration.constants.gyro_bias_rad_s = {0.01, -0.02, 0.005};
  rig.calibration.covariance = 1e-12 * RigConstants::Matrix::Identity();
  for (const char* const name : {"rate/tumble", "rate/tumble_lag"}) {
    const Method& method = *find_methods(name).front();
    RigCalibrationUse learning{rig, {}, {}};
    const Estimate informed = calibrating_method(method, learning).run(recording.sensors, {}, {});
    const Estimate fresh = method.run(recording.sensors, {}, {});
    ASSERT_TRUE(informed.status.ok()) << name;
    ASSERT_EQ(informed.rates.size(), fresh.rates.size());
    double moved = 0.0;
    for (std::size_t k = 0; k < fresh.rates.size(); ++k) {
      moved = std::max(moved, (informed.rates[k].w_WI_I_rad_s - fresh.rates[k].w_WI_I_rad_s).norm());
    }
    EXPECT_GT(moved, 1e-3) << name;  // the file counts
    // in the middle of the first rest, the rate is the reading minus the bias, so the method must not use the bias of
    // the other run
    EXPECT_LT(informed.rates[150].w_WI_I_rad_s.norm(), 1e-3) << name;
    const bool held = informed.health.at("calibration_at_prior") > 0.5, batch = std::string(name) == "rate/tumble";
    const bool doubted = has_finding(HealthFinding::Kind::rig_calibration, informed);
    EXPECT_EQ((batch ? learning.of_batch : learning.of_stream).has_value(), !held && !doubted) << name;
    EXPECT_FALSE((batch ? learning.of_stream : learning.of_batch).has_value()) << name;
  }
}

/// Returns draws of `hill` with the same rig for all of them.
sim::Sensors hill_of_one_rig(std::uint64_t seed) {
  constexpr std::uint64_t kRig = 96001;
  const DataRoot data{test::source_dir()};
  Scenario scenario = load_scenario(data, "hill");
  for (auto& [name, number] : scenario.robot.numbers) {
    const double value = draw_number(number, kRig, "robot." + name);
    number = {};
    number.numbers = {value};
  }
  return simulate_draw(data, scenario, seed, 1, Lidars::left_out).recording.sensors;
}

/// Returns the calibration that the batch method estimates from the first tumble of the rig.
const CalibratedRig& calibration_of_one_rig() {
  static const CalibratedRig rig = [] {
    RigCalibrationUse first;
    calibrating_method(*find_methods("rate/tumble").front(), first).run(hill_of_one_rig(96100), {}, {});
    return first.of_batch.value();
  }();
  return rig;
}

void expect_no_finding_for_the_right_rig(std::uint64_t first_seed, std::uint64_t last_seed) {
  for (std::uint64_t seed = first_seed; seed <= last_seed; ++seed) {
    RigCalibrationUse right{calibration_of_one_rig(), {}, {}};
    const Method method = calibrating_method(*find_methods("rate/tumble").front(), right);
    const Estimate estimate = method.run(hill_of_one_rig(seed), {}, {});
    EXPECT_FALSE(has_finding(HealthFinding::Kind::rig_calibration, estimate))
        << seed << ' ' << estimate.faults.message();
  }
}

// the stated inertia has a small uncertainty, so the estimator classifies contradicting samples as contact
TEST(RateLearnt, TheInertiaOfAnotherRigIsSuspectAndNotSaved) {
  expect_no_finding_for_the_right_rig(96101, 96102);
  const sim::Sensors sensors = hill_of_one_rig(96101);
  for (const char* const name : {"rate/tumble", "rate/tumble_lag"}) {
    for (const int shape : {0, 2, 4}) {
      RigCalibrationUse other{calibration_of_one_rig(), {}, {}};
      other.given->calibration.constants.inertia[shape] += 0.3;
      const Estimate estimate = calibrating_method(*find_methods(name).front(), other).run(sensors, {}, {});
      EXPECT_TRUE(has_finding(HealthFinding::Kind::rig_calibration, estimate)) << name << ' ' << shape;
      EXPECT_EQ(other.found(), nullptr) << "the file stays as it is";
    }
  }
}

// the same statement as above over further draws
TEST(RateLearntSoak, TheInertiaOfTheRigIsNotSuspect) {
  expect_no_finding_for_the_right_rig(96103, 96108);
}

AngularRateModelParams assumed_model() {
  AngularRateModelParams model;
  model.nominal.lever_arm_m.setZero();
  return model;
}

/// Returns the readings of the wand's simulated recording between two times.
sim::Sensors wand(double from_s, double to_s) {
  const auto folder = test::written(test::data_folders("repoimu").front());
  sim::Sensors out = import_imu_csv(folder / test::kStandInWand, {}, AccelUnit::m_s2, GyroUnit::rad_s,
                                    "time=0,gyro=8,9,10,accel=5,6,7")
                         .sensors;
  sim::ImuRecord& imu = out.imus.front();
  const auto at = [](double t_s) { return static_cast<std::ptrdiff_t>(100.0 * t_s); };
  const auto cut = [&](auto& values) { values = {values.begin() + at(from_s), values.begin() + at(to_s)}; };
  cut(imu.time_ns);
  cut(imu.gyro_rad_s);
  cut(imu.accel_m_s2);
  if (!imu.clip_flags.empty()) cut(imu.clip_flags);
  return out;
}

TEST(RateLearnt, SaturationLimitsThatReadingsContradictAreRemoved) {
  SaturationPlane plane;
  plane.row = {1.0, 0.01, 0.02};
  plane.saturation_limit_rad_s = 7.3;
  plane.samples = {40, 40};
  plane.log_odds = 100.0;
  plane.covariance.diagonal() << 1e-6, 1e-6, 1e-7, 1e-7;
  CalibratedRig before = prior_rig_calibration(nullptr, assumed_model());
  before.gyro_saturation_planes_rad_s[1] = {-7.2, 7.4};
  before.gyro_saturation_planes_rad_s[2] = {-7.1, 7.5};
  SaturationLevels rails;
  EXPECT_FALSE(calibration_with_saturation_limits(before, rails).has_value());
  rails.gyro_planes.sensing_axis[0] = plane;
  rails.gyro_planes.sensing_axis[1] =
      before.saturation_planes().sensing_axis[1];  // as returned by a run that did not reach this plane
  const std::optional<CalibratedRig> after = calibration_with_saturation_limits(before, rails);
  ASSERT_TRUE(after);
  EXPECT_EQ(after->gyro_saturation_planes_rad_s[0][1], 7.3);
  EXPECT_EQ(after->saturation_limits[0], 7.3);
  EXPECT_EQ(after->calibration.constants.gyro_misalignment[0], 0.01);
  EXPECT_EQ(after->gyro_saturation_planes_rad_s[1], before.gyro_saturation_planes_rad_s[1]);
  EXPECT_FALSE(after->gyro_saturation_planes_rad_s[2][0] || after->gyro_saturation_planes_rad_s[2][1])
      << "the finder has dropped it";
  rails.gyro_planes.sensing_axis[0]->log_odds = 5.0;
  EXPECT_FALSE(calibration_with_saturation_limits(before, rails).has_value()) << "not sure";
}

// The live method estimates an accelerometer delay of 10 ms in the first tumble of a device. The next run starts with
// the estimated delay. For an accelerometer without delay, the method reports no delay.
TEST(RateLearnt, TheStreamLeavesALateAccelerometerToTheNextRun) {
  const DataRoot data{test::source_dir()};
  const Scenario hill = load_scenario(data, "hill");
  for (const double delay_s : {0.0, 0.01}) {
    sim::Situation situation = without_lidars(draw(data, hill, 40001));
    situation.sensors.front().values.set("accel_delay_s", delay_s);
    const sim::Recording recording = sim::simulate(sim::BuiltSituation(sim::resolve(situation), data.models()));
    RigCalibrationUse first, second;
    const Method& stream = *find_methods("rate/tumble_lag").front();
    ASSERT_TRUE(calibrating_method(stream, first).run(recording.sensors, {}, {}).status.ok());
    const bool late = delay_s > 0.0;
    ASSERT_EQ(first.of_stream && first.of_stream->known_sensor_errors.has_value(), late);
    if (!late) continue;
    const KnownSensorErrors& errors = *first.of_stream->known_sensor_errors;
    const double sigma_s = std::sqrt(errors.covariance(SensorErrors::kDelay, SensorErrors::kDelay));
    EXPECT_NEAR(errors.errors.accel_delay_s, delay_s, 3.0 * sigma_s);
    EXPECT_LT(sigma_s, 2e-3);
    second.given = *first.found();
    const Estimate next = calibrating_method(stream, second).run(recording.sensors, {}, {});
    ASSERT_TRUE(next.status.ok());
    EXPECT_EQ(next.health.at("accel_delay_s"), errors.errors.accel_delay_s);
  }
}

// The motion of a wand determines the saturation planes, but not the lever arm or the inertia. A run that is too short
// for the estimation of the planes uses the planes of the previous run.
TEST(RateLearnt, SaturationLimitsOfHandHeldMotionAreUsedInTheNextRun) {
  const DataRoot data{test::source_dir()};
  sim::Recording recording = simulate_draw(data, load_scenario(data, "twirl"), 99560, 1, Lidars::left_out).recording;
  std::optional<CalibratedRig> rig;
  for (const char* const name : {"rate/tumble_lag", "rate/tumble"}) {
    RigCalibrationUse learning;
    const Estimate whole = calibrating_method(*find_methods(name).front(), learning).run(recording.sensors, {}, {});
    ASSERT_TRUE(whole.status.ok()) << name;
    EXPECT_EQ(whole.health.at("calibration_at_prior"), 1.0) << name;
    ASSERT_NE(learning.found(), nullptr) << name;
    rig = *learning.found();
    EXPECT_TRUE(rig->only_saturation_limits) << name;
  }

  sim::ImuRecord& imu = recording.sensors.imus.front();
  const std::size_t short_run = imu.time_ns.size() / 25;
  imu.time_ns.resize(short_run), imu.gyro_rad_s.resize(short_run), imu.accel_m_s2.resize(short_run);
  if (!imu.clip_flags.empty()) imu.clip_flags.resize(short_run);
  recording.sensors.imus.resize(1);
  const auto rails = [](const Estimate& estimate) {
    return std::count_if(estimate.health.begin(), estimate.health.end(),
                         [](const auto& row) { return row.first.starts_with("gyro_limit_"); });
  };
  const Estimate alone = run_rate_tumble(recording.sensors, defaults(), nullptr, nullptr),
                 knowing = run_rate_tumble(recording.sensors, defaults(), &*rig, nullptr);
  ASSERT_TRUE(alone.status.ok());
  ASSERT_TRUE(knowing.status.ok());
  EXPECT_EQ(rails(alone), 0);
  EXPECT_GT(rails(knowing), 0);
}

TEST(RateLearnt, EachMethodReportsTheSaturationLimitsThatItFound) {
  const sim::Sensors twirled = wand(0.0, 30.0);
  const test::WandRail rail;
  for (const char* const name : {"rate/tumble", "rate/tumble_lag", "attitude/tumble"}) {
    const auto health = find_methods(name).front()->run(twirled, {}, {}).health;
    ASSERT_TRUE(health.contains("gyro_limit_x_rad_s")) << name;
    EXPECT_NEAR(health.at("gyro_limit_x_rad_s"), rail.distance_rad_s, 0.01) << name;
    for (const char* const key : {"gyro_limit_y_rad_s", "gyro_limit_z_rad_s"})
      EXPECT_FALSE(health.contains(key)) << name << ' ' << key << ": no rail was seen there";
  }
}

TEST(RateLearnt, TheBatchOverridesTheStreamAndOtherMethodsAreRefused) {
  RigCalibrationUse learning;
  EXPECT_EQ(learning.found(), nullptr);
  learning.of_stream = CalibratedRig{};
  EXPECT_EQ(learning.found(), &*learning.of_stream);
  learning.of_batch = CalibratedRig{};
  EXPECT_EQ(learning.found(), &*learning.of_batch);
  EXPECT_THROW(calibrating_method(*find_methods("rate/saave").front(), learning), BadInput);
  EXPECT_THROW(calibrating_method(*find_methods("attitude/tumble").front(), learning), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
