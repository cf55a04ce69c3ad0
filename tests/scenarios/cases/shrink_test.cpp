// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/shrink.hpp"
#include "scenarios/methods/registry.hpp"

#include "scenarios/draw/fixed_scenario.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr std::uint64_t kSeed = 5;
constexpr double kDrawn_s = 6.0, kShortest_s = 3.1;

/// Returns the beginning of a pendulum's swing whose IMU loses samples; no draw takes less time to simulate.
Scenario losing_samples() {
  Scenario scenario = load_scenario(test::tree_data(), "swing");
  fix_number(scenario, "duration_s", kDrawn_s);
  fix_number(scenario, "sensors.imu.dropout_share", 0.2);
  return scenario;
}

bool has_gap(const sim::ImuRecord& imu) {
  for (std::size_t k = 1; k < imu.time_ns.size(); ++k) {
    if (2 * (imu.time_ns[k] - imu.time_ns[k - 1]) > 3 * imu.period_ns) return true;
  }
  return false;
}

/// The failure of this method has a known cause: samples are lost, the gyro has a stated range of less than 50 rad/s,
/// and the run is longer than `kShortest_s`. No other property affects this method.
Method breaks_on(bool gaps, bool range) {
  Method method = *find_methods("rate/raw").front();
  method.info.name = "toy";
  method.run = [run = method.run, gaps, range](const sim::Sensors& sensors, const sim::Values& values,
                                               const OracleInput& oracle) {
    const sim::ImuRecord& imu = sensors.imus.front();
    const bool breaks = (!gaps || has_gap(imu)) && (!range || imu.stated_gyro_range_rad_s < 50.0) &&
                        1e-9 * static_cast<double>(imu.time_ns.back()) > kShortest_s;
    if (breaks) throw BadInput("it breaks");
    return run(sensors, values, oracle);
  };
  return method;
}

std::vector<std::string> names_with(const Shrunk& shrunk, Fate fate) {
  std::vector<std::string> names;
  for (const ShrinkLine& line : shrunk.lines) {
    if (line.fate == fate) names.push_back(line.what);
  }
  return names;
}

TEST(Shrink, FindsTheKnownCauseOfAToyExactly) {
  const Method toy = breaks_on(true, true);
  const Shrunk shrunk = shrink(test::tree_data(), losing_samples(), kSeed, toy, {});
  EXPECT_TRUE(shrunk.complete);
  EXPECT_EQ(shrunk.failure, "failed");
  EXPECT_THAT(names_with(shrunk, Fate::needed), ElementsAre("sensors.imu: rail of the gyro"));
  EXPECT_THAT(names_with(shrunk, Fate::smaller), ElementsAre("duration_s", "sensors.imu: dropouts"));
  EXPECT_THAT(names_with(shrunk, Fate::not_tried), ElementsAre());
  EXPECT_GT(names_with(shrunk, Fate::removed).size(), 8u);

  // runs shorter than kShortest_s do not fail; the length found is within the search's resolution of kShortest_s
  const double left_s = shrunk.scenario.duration_s.numbers.front();
  EXPECT_GE(left_s, kShortest_s);
  EXPECT_LE(left_s, kShortest_s + 0.05 * kDrawn_s + 0.02);
  EXPECT_LT(shrunk.scenario.sensors.front().numbers.at("dropout_share").numbers.front(), 0.2);
  EXPECT_EQ(shrunk.scenario.sensors.front().numbers.at("gyro_noise_rad_s_sqrt_hz").numbers.front(), 0.0);

  // each needed line has evidence: a run without that line which passed
  for (const ShrinkLine& line : shrunk.lines) {
    if (line.without) {
      EXPECT_EQ(line.without->status, OutcomeStatus::ok) << line.what;
    }
  }
  // the remaining scenario fails when it is shrunk again
  ShrinkOptions once;
  once.budget = 1;
  EXPECT_EQ(shrink(test::tree_data(), shrunk.scenario, kSeed, toy, once).drawn.status, OutcomeStatus::failed);
}

TEST(Shrink, TwiceIsTheSame) {
  const Method toy = breaks_on(true, false);
  std::vector<std::string> first, second;
  ShrinkOptions options;
  options.on_trial = [&](const ShrinkTrial& trial) { first.push_back(trial.what + (trial.kept ? "+" : "-")); };
  const Shrunk once = shrink(test::tree_data(), losing_samples(), kSeed, toy, options);
  options.on_trial = [&](const ShrinkTrial& trial) { second.push_back(trial.what + (trial.kept ? "+" : "-")); };
  const Shrunk again = shrink(test::tree_data(), losing_samples(), kSeed, toy, options);
  EXPECT_EQ(first, second);
  EXPECT_EQ(static_cast<int>(first.size()), once.runs);
  EXPECT_EQ(to_yaml(once.scenario), to_yaml(again.scenario));
  EXPECT_EQ(once.left.estimate_digest, again.left.estimate_digest);
  EXPECT_EQ(once.left.recording_digest, again.left.recording_digest);
}

TEST(Shrink, ADrawThatDoesNotFailIsRefused) {
  Scenario scenario = losing_samples();
  fix_number(scenario, "sensors.imu.dropout_share", 0.0);
  int runs = 0;
  ShrinkOptions options;
  options.on_trial = [&](const ShrinkTrial&) { ++runs; };
  EXPECT_THROW(shrink(test::tree_data(), scenario, kSeed, breaks_on(true, false), options), BadInput);
  EXPECT_EQ(runs, 0);
}

/// The toy method fails whatever is removed: without a control method nothing remains, and with one only what the
/// control method tolerates remains removed.
TEST(Shrink, WhatTheControlCannotDoEitherIsNotKept) {
  const Method toy = breaks_on(false, false);
  ShrinkOptions options;
  options.budget = 40;
  const Shrunk alone = shrink(test::tree_data(), losing_samples(), kSeed, toy, options);
  EXPECT_THAT(names_with(alone, Fate::needed), ElementsAre());
  EXPECT_FALSE(alone.controlled);

  Method control = *find_methods("rate/raw").front();  // needs a saturation limit
  control.run = [run = control.run](const sim::Sensors& sensors, const sim::Values& values, const OracleInput& oracle) {
    const sim::ImuRecord& imu = sensors.imus.front();
    if (imu.stated_gyro_range_rad_s > 50.0) throw BadInput("no rail");
    return run(sensors, values, oracle);
  };
  options.control = unowned(control);
  const Shrunk held = shrink(test::tree_data(), losing_samples(), kSeed, toy, options);
  EXPECT_TRUE(held.controlled);
  EXPECT_THAT(names_with(held, Fate::needed), ElementsAre("sensors.imu: rail of the gyro"));
}

/// The drawn failure comes from saturated readings. Without saturation the toy method fails for another reason, which
/// no true rate corrects: the search rejects such a reduction.
TEST(Shrink, OnlyWhatTheSameInputCuresIsKept) {
  Scenario scenario = losing_samples();
  fix_number(scenario, "sensors.imu.gyro_range_rad_s", 1.0);
  fix_number(scenario, "sensors.imu.gyro_rail_rad_s", 1.0);
  Method toy = *find_methods("rate/raw").front();
  toy.run = [run = toy.run](const sim::Sensors& sensors, const sim::Values& values, const OracleInput& oracle) {
    const sim::ImuRecord& imu = sensors.imus.front();
    double largest = 0.0;
    for (const Vector3d& rate : imu.gyro_rad_s) largest = std::max(largest, rate.lpNorm<Eigen::Infinity>());
    if (imu.stated_gyro_range_rad_s > 50.0) throw BadInput("another cause");
    if (largest < 1.5) throw BadInput("it clips");
    return run(sensors, values, oracle);
  };
  const Shrunk shrunk = shrink(test::tree_data(), scenario, kSeed, toy, {});
  EXPECT_EQ(shrunk.cure, "gyro_unclipped");
  EXPECT_THAT(names_with(shrunk, Fate::needed), Contains("sensors.imu: rail of the gyro"));
}

TEST(Shrink, ASpentBudgetSaysWhatWasNotTried) {
  ShrinkOptions options;
  options.budget = 8;
  const Shrunk shrunk = shrink(test::tree_data(), losing_samples(), kSeed, breaks_on(true, true), options);
  EXPECT_EQ(shrunk.runs, 8);
  EXPECT_FALSE(shrunk.complete);
  EXPECT_FALSE(names_with(shrunk, Fate::not_tried).empty());
}

TEST(Shrink, MethodsThatDoNotApplyAreRefused) {
  EXPECT_THROW(shrink(test::tree_data(), losing_samples(), kSeed, *find_methods("position/rolling").front(), {}),
               BadInput);
  ShrinkOptions options;
  options.control = find_methods("slam/oracle").front();
  EXPECT_THROW(shrink(test::tree_data(), losing_samples(), kSeed, breaks_on(true, true), options), BadInput);
}

}  // namespace
}  // namespace tumble::scenarios
