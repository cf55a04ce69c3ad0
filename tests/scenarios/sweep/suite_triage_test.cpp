// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/suite_triage.hpp"
#include "scenarios/methods/registry.hpp"

#include <signal.h>
#include <unistd.h>

#include "scenarios/draw/fixed_scenario.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr const char* kMetric = "rate_error_clipped_median_rad_s";

using SuiteTriage = test::TemporaryFolder;

/// Returns a file of one tumble with saturation, without the lidar; the seeds change the noise of its sensors.
std::string clipping_tumble(const fs::path& folder) {
  Scenario scenario = load_scenario(test::tree_data(), "hill");
  fix_number(scenario, "duration_s", 4.0);
  std::erase_if(scenario.sensors, [](const Scenario::Sensor& sensor) { return sensor.name == "lidar"; });
  const fs::path file = folder / "clipping.yaml";
  std::ofstream(file) << to_yaml(fixed_as(scenario, draw(test::tree_data(), scenario, 1)));
  return file.string();
}

std::vector<std::string> said(const std::vector<DrawTriage>& all) {
  std::vector<std::string> out;
  for (const DrawTriage& draw : all) {
    out.push_back(std::to_string(draw.draw.seed) + draw.error_code);
    for (const TriageRow& row : draw.rows)
      out.push_back(row.input + (row.fails ? "+" : "-") + row.outcome.estimate_digest + row.doc);
  }
  return out;
}

TEST_F(SuiteTriage, IsTheTriageOfEachDrawForAnyNumberOfJobs) {
  const std::string scenario = clipping_tumble(folder_);
  const std::vector<DrawName> draws = {{scenario, 1}, {scenario, 2}};
  const Method& raw = *find_methods("rate/raw").front();
  SuiteTriageOptions options;
  options.triage.failure = {kMetric, 0.1};
  std::size_t told = 0;
  options.on_draw = [&](const DrawTriage&) { ++told; };
  const std::vector<DrawTriage> one = triage_draws(test::tree_data(), draws, raw, options);
  options.jobs = 2;
  const std::vector<DrawTriage> two = triage_draws(test::tree_data(), draws, raw, options);
  EXPECT_EQ(told, 4u);
  EXPECT_EQ(said(one), said(two));

  TriageOptions alone;
  alone.failure = options.triage.failure;
  const DrawTriage same{
      {scenario, 2}, triage(test::tree_data(), load_scenario(test::tree_data(), scenario), 2, raw, alone), ""};
  ASSERT_EQ(one.size(), 2u);
  EXPECT_EQ(said({one[1]}), said({same}));
  for (const DrawTriage& draw : one) {
    EXPECT_TRUE(draw.rows.at(0).fails);
    for (const TriageRow& row : draw.rows)
      EXPECT_EQ(row.fails, !row.input.starts_with("gyro") && row.input != "all") << row.input;
  }
}

TEST_F(SuiteTriage, ADrawThatCannotBeSimulatedSaysWhy) {
  const std::vector<DrawName> draws = {{clipping_tumble(folder_), 1}};
  const std::vector<DrawTriage> all =
      triage_draws(test::tree_data(), draws, *find_methods("position/rolling").front(), {});
  ASSERT_EQ(all.size(), 1u);
  EXPECT_TRUE(all[0].rows.empty());
  EXPECT_THAT(all[0].error_code, HasSubstr("does not support the robot"));
  EXPECT_THROW(
      triage_draws(test::tree_data(), std::vector<DrawName>{{"hil", 1}}, *find_methods("rate/raw").front(), {}),
      BadInput);
}

/// Returns the method, of which the n-th run does something else first. A file counts the runs, because each run is a
/// process.
Method disturbed(const fs::path& folder, std::uintmax_t n, const std::function<void()>& disturbance) {
  Method method = *find_methods("rate/raw").front();
  const fs::path count = folder / "count";
  method.run = [run = method.run, count, n, disturbance](const sim::Sensors& sensors, const sim::Values& parameters,
                                                         const OracleInput& oracle) {
    std::ofstream(count, std::ios::app) << '.';
    if (fs::file_size(count) == n) disturbance();
    return run(sensors, parameters, oracle);
  };
  return method;
}

TEST_F(SuiteTriage, AProcessThatDiesCostsTheRestOfItsDrawAlone) {
  const std::string scenario = clipping_tumble(folder_);
  const std::vector<DrawName> draws = {{scenario, 1}, {scenario, 2}};
  const Method dies = disturbed(folder_, 3, [] { kill(getppid(), SIGKILL); });
  const std::vector<DrawTriage> all = triage_draws(test::tree_data(), draws, dies, {});
  ASSERT_EQ(all.size(), 2u);
  EXPECT_THAT(all[0].error_code, HasSubstr("ended by signal 9"));
  EXPECT_EQ(all[0].rows.size(), 2u) << "what it had told stands";
  EXPECT_EQ(all[1].error_code, "");
  EXPECT_GT(all[1].rows.size(), 3u);
}

TEST_F(SuiteTriage, AProcessThatHangsIsLate) {
  SuiteTriageOptions options;
  options.triage.timeout_s = 0.2;
  const Method hangs = disturbed(folder_, 1, [] { kill(getppid(), SIGSTOP); });
  const std::vector<DrawTriage> all =
      triage_draws(test::tree_data(), std::vector<DrawName>{{clipping_tumble(folder_), 1}}, hangs, options);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].error_code, "the simulated run did not end within its time limit");
}

TEST_F(SuiteTriage, MemoryIsLimited) {
  const std::vector<DrawName> draws = {{clipping_tumble(folder_), 1}};
  const auto statuses_of = [](const std::vector<DrawTriage>& all) {
    std::vector<OutcomeStatus> out;
    for (const TriageRow& row : all.at(0).rows) out.push_back(row.outcome.status);
    return out;
  };
  const auto takes = [&](std::size_t mib) {
    return disturbed(folder_, 1, [mib] { std::vector<char>(mib << 20, '1').back() = '2'; });
  };
  SuiteTriageOptions options;
  options.memory_mib = 1024.0;
  EXPECT_THAT(statuses_of(triage_draws(test::tree_data(), draws, takes(16), options)),
              ::testing::Each(OutcomeStatus::ok));
  fs::remove(folder_ / "count");
  EXPECT_EQ(statuses_of(triage_draws(test::tree_data(), draws, takes(2048), options)).at(0), OutcomeStatus::killed);
  for (const double none : {0.0, 63.0, 1e9, std::nan("")}) {
    options.memory_mib = none;
    EXPECT_THROW(triage_draws(test::tree_data(), draws, takes(1), options), BadInput) << none;
  }
}

TEST_F(SuiteTriage, OfASuiteTheDrawsOfTheMethodsRobotSeedsOutermost) {
  Suite suite;
  suite.scenarios = {"hill", "roll", "cliff"};
  suite.first_seed = 3;
  suite.last_seed = 4;
  EXPECT_THAT(draws_of(test::tree_data(), suite, *find_methods("slam/tumble").front()),
              ElementsAre(DrawName{"hill", 3}, DrawName{"cliff", 3}, DrawName{"hill", 4}, DrawName{"cliff", 4}));
  suite.classes = {{"mild", {{"hill", 4}}}, {"wild", {{"cliff", 3}, {"roll", 3}}}};
  EXPECT_THAT(draws_of(test::tree_data(), suite, *find_methods("slam/tumble").front()),
              ElementsAre(DrawName{"cliff", 3}, DrawName{"hill", 4}));
  suite.classes.clear();
  suite.last_seed = 20'000'000;
  EXPECT_THROW(draws_of(test::tree_data(), suite, *find_methods("slam/tumble").front()), BadInput);
  suite.last_seed = 4;
  suite.scenarios = {"roll"};
  EXPECT_THAT(draws_of(test::tree_data(), suite, *find_methods("slam/tumble").front()), IsEmpty());
}

TEST_F(SuiteTriage, FailedAreThoseOfTheMethodThatFailedThere) {
  Results results(folder_ / "a.db", Results::Mode::create_or_append);
  const auto store = [&](std::uint64_t seed, const std::string& method, OutcomeStatus status, double value,
                         const Setting& setting = {}) {
    Outcome outcome;
    outcome.scenario = "hill";
    outcome.seed = seed;
    outcome.kind = Kind::rate;
    outcome.method = method;
    outcome.status = status;
    outcome.scores = {{kMetric, value}};
    outcome.setting = setting;
    results.store(outcome);
  };
  store(1, "raw", OutcomeStatus::ok, 0.5);
  store(2, "raw", OutcomeStatus::ok, 0.05);
  store(3, "raw", OutcomeStatus::crashed, 0.0);
  store(4, "saave", OutcomeStatus::ok, 9.0);
  store(5, "raw", OutcomeStatus::ok, 9.0, {"world.rock_count", 1.0});
  const Method& raw = *find_methods("rate/raw").front();
  EXPECT_THAT(failed_draws(results, raw, {kMetric, 0.1}), ElementsAre(DrawName{"hill", 1}, DrawName{"hill", 3}));
  EXPECT_THAT(failed_draws(results, raw, {}), ElementsAre(DrawName{"hill", 3}));
}

}  // namespace
}  // namespace tumble::scenarios
