// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/methods/synthetic_recording.hpp"
#include "scenarios/sweep/outcome.hpp"
#include "tests/scenarios/testing.hpp"

// the test applies the same rules to every registered method, without naming it
namespace tumble::scenarios {

void PrintTo(const Method& method, std::ostream* out) {
  *out << to_string(method.info.kind) << "/" << method.info.name;
}

namespace {

/// Returns the motion of the synthetic rig with shorter rests, because every method runs over it several times.
testing::SyntheticMotion brief_motion() {
  testing::SyntheticMotion motion;
  motion.start_s = 0.9;
  motion.end_s = 3.9;
  motion.duration_s = 4.8;
  return motion;
}

class MethodContract : public ::testing::TestWithParam<Method> {
 protected:
  const Method& method() const { return GetParam(); }

  /// Returns a copy of a recording that all tests share.
  sim::Recording recording() const {
    static const sim::Recording rig = testing::synthetic_rig(brief_motion()), sphere = testing::synthetic_sphere();
    return method().info.applies_to({"rig"}) ? rig : sphere;
  }

  Estimate run(const sim::Recording& recording) const {
    return method().run(recording.sensors, {}, OracleInput{method().info.needs_truth ? &recording.truth : nullptr});
  }

  // the method must return a status that is not ok or throw BadInput: anything else would let a fault pass for a result
  void expect_refused(const sim::Recording& recording) const {
    try {
      const Estimate estimate = run(recording);
      EXPECT_FALSE(estimate.status.ok()) << estimate.status.message();
      EXPECT_NE(std::string(estimate.status.field), "");
    } catch (const BadInput& error) {
      EXPECT_NE(std::string(error.what()), "");
    }
  }
};

TEST_P(MethodContract, DescribesItself) {
  const MethodInfo& info = method().info;
  EXPECT_NE(info.name, "");
  EXPECT_NE(info.doc, "");
  EXPECT_NE(info.source, "");
  // the source of a method of this project may be followed by what it is based on; a method kept for comparison must
  // not be listed as one of this project
  EXPECT_TRUE(info.ours ? info.source.starts_with("ours") : info.source != "ours") << "whose it is, told twice";
  for (const sim::Parameter& parameter : info.parameters) {
    EXPECT_NE(parameter.doc, "") << parameter.name;
    EXPECT_LE(parameter.low, parameter.default_value) << parameter.name;
    EXPECT_GE(parameter.high, parameter.default_value) << parameter.name;
  }
}

void expect_of_kind(const Estimate& estimate, Kind kind, const sim::Sensors& sensors) {
  const std::size_t samples = sensors.imus.front().time_ns.size();
  switch (kind) {
    case Kind::rate:
      EXPECT_EQ(estimate.rates.size(), samples);
      break;
    case Kind::attitude:
      EXPECT_EQ(estimate.attitudes.size(), samples);
      break;
    case Kind::position:
      EXPECT_EQ(estimate.poses.size(), samples);
      break;
    case Kind::slam:
      EXPECT_GT(6 * estimate.sweeps.size(), 5 * sensors.lidars.front().sweep_start_ns.size());
      EXPECT_EQ(estimate.sweep_end_ns.size(), estimate.sweeps.size());
      EXPECT_GT(6 * estimate.poses.size(), 5 * samples);
      EXPECT_GT(estimate.map.size(), 1000u);
      break;
  }
}

// two runs check both: the second run also receives the truth, which a method may use only when it declares that
TEST_P(MethodContract, AnswersWithTheSameBitsWhateverTheTruth) {
  const sim::Recording given = recording();
  const Estimate estimate = run(given);
  ASSERT_TRUE(estimate.status.ok()) << estimate.status.message();
  expect_of_kind(estimate, method().info.kind, given.sensors);
  const std::string first = digest(estimate);
  EXPECT_EQ(first, digest(method().run(given.sensors, {}, {&given.truth})));
  if (method().info.needs_truth) {
    EXPECT_THROW(method().run(given.sensors, {}, {}), BadInput);
  }
  // negative control: the digest depends on the data; two methods show this, because each run takes seconds
  const std::string name = full_name(method().info);
  if (name != "rate/raw" && name != "slam/icp") return;
  sim::Recording other = given;
  for (auto& rate : other.sensors.imus.front().gyro_rad_s) rate *= 1.001;
  for (auto& rate : other.truth.imus.front().gyro_unclipped_rad_s) rate *= 1.001;
  for (auto& force : other.sensors.imus.front().accel_m_s2) force *= 1.001;
  EXPECT_NE(first, digest(run(other)));
}

TEST_P(MethodContract, RefusesAnEmptyRecording) {
  sim::Recording empty;
  empty.sensors.robot = "rig";
  expect_refused(empty);
  sim::Recording no_samples = recording();
  no_samples.sensors.imus.front().time_ns.clear();
  no_samples.sensors.imus.front().gyro_rad_s.clear();
  no_samples.sensors.imus.front().accel_m_s2.clear();
  no_samples.sensors.imus.front().clip_flags.clear();
  expect_refused(no_samples);
}

/// Damages every tenth reading, more than a recording may leave out (bridge::imu_samples).
template <class Spoil>
void spoil_a_tenth(sim::ImuRecord& imu, Spoil&& spoil) {
  for (std::size_t k = 1; k + 1 < imu.time_ns.size(); k += 10) spoil(k);
}

TEST_P(MethodContract, RefusesManyReadingsThatAreNotFinite) {
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    for (const bool gyro : {true, false}) {
      sim::Recording spoilt = recording();
      sim::ImuRecord& imu = spoilt.sensors.imus.front();
      spoil_a_tenth(imu, [&](std::size_t k) { (gyro ? imu.gyro_rad_s : imu.accel_m_s2)[k].x() = bad; });
      expect_refused(spoilt);
    }
  }
}

TEST_P(MethodContract, RefusesManyFallingTimeStamps) {
  sim::Recording spoilt = recording();
  sim::ImuRecord& imu = spoilt.sensors.imus.front();
  spoil_a_tenth(imu, [&](std::size_t k) { std::swap(imu.time_ns[k], imu.time_ns[k + 1]); });
  expect_refused(spoilt);
}

TEST_P(MethodContract, AGapIsRefusedOrReported) {
  sim::Recording spoilt = recording();
  auto& times = spoilt.sensors.imus.front().time_ns;
  for (std::size_t k = 600; k < times.size(); ++k) times[k] += 3000000000;
  try {
    const Estimate estimate = run(spoilt);
    if (estimate.status.ok())
      EXPECT_TRUE(estimate.health.contains("gaps")) << "the method continues after the gap without a report";
    else
      EXPECT_NE(std::string(estimate.status.field), "");
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()), "");
  }
}

TEST_P(MethodContract, RefusesAParameterItDoesNotKnow) {
  sim::Values values;
  values.set("no_such_parameter", 1.0);
  const sim::Recording given = recording();
  EXPECT_THROW(method().run(given.sensors, values, {&given.truth}), BadInput);
  for (const sim::Parameter& parameter : method().info.parameters) {
    sim::Values beyond;
    beyond.set(std::string(parameter.name), parameter.high * 2.0 + 1.0);
    EXPECT_THROW(method().run(given.sensors, beyond, {&given.truth}), BadInput) << parameter.name;
  }
}

std::string test_name(const ::testing::TestParamInfo<Method>& param) {
  return std::string(to_string(param.param.info.kind)) + "_" + param.param.info.name;
}

INSTANTIATE_TEST_SUITE_P(Registered, MethodContract, ::testing::ValuesIn(methods().begin(), methods().end()),
                         test_name);

class SlamContract : public MethodContract {};

TEST_P(SlamContract, RefusesALidarThatNeverSawAnything) {
  sim::Recording spoilt = recording();
  for (auto& point : spoilt.sensors.lidars.front().position_L_m)
    point.setConstant(std::numeric_limits<float>::quiet_NaN());
  expect_refused(spoilt);
}

// an idealised simulator gives such points, and so does a driver that loses the stamps
TEST_P(SlamContract, RefusesPointsThatAllBearOneTimeStamp) {
  sim::Recording spoilt = recording();
  for (auto& offset : spoilt.sensors.lidars.front().offset_ns) offset = 0;
  expect_refused(spoilt);
}

TEST_P(SlamContract, RefusesAPointBeyondItsSweep) {
  sim::Recording spoilt = recording();
  sim::LidarRecord& lidar = spoilt.sensors.lidars.front();
  lidar.offset_ns[lidar.sweep_first[30] + 5] = 200000000;
  expect_refused(spoilt);
}

TEST_P(SlamContract, RefusesARecordingWithoutLidar) {
  sim::Recording spoilt = recording();
  spoilt.sensors.lidars.clear();
  expect_refused(spoilt);
}

/// Removes all points of one sweep.
void empty_sweep(sim::LidarRecord& lidar, std::size_t sweep) {
  const auto first = static_cast<std::ptrdiff_t>(lidar.sweep_first[sweep]);
  const auto last = static_cast<std::ptrdiff_t>(lidar.sweep_first[sweep + 1]);
  const auto cut = [&](auto& array) { array.erase(array.begin() + first, array.begin() + last); };
  cut(lidar.position_L_m);
  cut(lidar.range_m);
  cut(lidar.intensity);
  cut(lidar.offset_ns);
  cut(lidar.ring);
  for (std::size_t k = sweep + 1; k < lidar.sweep_first.size(); ++k)
    lidar.sweep_first[k] -= static_cast<std::size_t>(last - first);
}

TEST_P(SlamContract, TakesAPointThatIsNotANumberForAMissAndCountsSweepsWithoutPoints) {
  sim::Recording spoilt = recording();
  sim::LidarRecord& lidar = spoilt.sensors.lidars.front();
  lidar.position_L_m[lidar.sweep_first[30] + 5].x() = std::numeric_limits<float>::quiet_NaN();
  empty_sweep(lidar, 43);  // in the middle of the rest at the end
  const Estimate estimate = run(spoilt);
  ASSERT_TRUE(estimate.status.ok()) << estimate.status.message();
  for (const PoseState& pose : estimate.poses) ASSERT_TRUE(pose.position_W_m.allFinite());
  for (const MapPoint& point : estimate.map) ASSERT_TRUE(point.position_W_m.allFinite());
  EXPECT_EQ(estimate.health.at("sweeps_empty"), 1.0);
  ASSERT_EQ(estimate.sweeps.size(), 48u);
  EXPECT_EQ(estimate.sweeps[43].verdict, SweepVerdict::rejected);
  EXPECT_NE(estimate.sweeps[44].verdict, SweepVerdict::rejected);
}

std::vector<Method> slam_methods() {
  std::vector<Method> chosen;
  std::copy_if(methods().begin(), methods().end(), std::back_inserter(chosen),
               [](const Method& method) { return method.info.kind == Kind::slam && method.info.applies_to({"rig"}); });
  return chosen;
}

INSTANTIATE_TEST_SUITE_P(Registered, SlamContract, ::testing::ValuesIn(slam_methods()), test_name);

TEST(Registry, NamesAreUniqueWithinAKindAndSortedByKind) {
  const auto all = methods();
  ASSERT_GE(all.size(), 9u);
  for (std::size_t k = 1; k < all.size(); ++k) {
    EXPECT_LE(all[k - 1].info.kind, all[k].info.kind);
    for (std::size_t j = 0; j < k; ++j) {
      EXPECT_FALSE(all[j].info.kind == all[k].info.kind && all[j].info.name == all[k].info.name) << all[k].info.name;
    }
  }
}

// `tumble run SCENARIO` shows this method next to the baseline
TEST(Registry, TheFirstOfOursIsTheOneThatIsCalledTumble) {
  for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
    const auto is_ours = [&](const Method& method) {
      return method.info.kind == kind && method.info.ours && !method.info.needs_truth;
    };
    const auto first = std::find_if(methods().begin(), methods().end(), is_ours);
    ASSERT_NE(first, methods().end());
    EXPECT_EQ(first->info.name, "tumble") << to_string(kind);
  }
}

TEST(Registry, FindsByNameAndByKindAndName) {
  EXPECT_EQ(find_methods("oracle").size(), 3u);
  ASSERT_EQ(find_methods("rate/oracle").size(), 1u);
  EXPECT_EQ(find_methods("rate/oracle").front()->info.kind, Kind::rate);
  try {
    find_methods("saav");
    FAIL() << "an unknown name was found";
  } catch (const BadInput& error) {
    EXPECT_EQ(std::string(error.what()), "unknown method 'saav'; did you mean 'saave'?");
  }
}

}  // namespace
}  // namespace tumble::scenarios
