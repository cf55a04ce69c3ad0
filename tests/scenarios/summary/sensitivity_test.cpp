// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/sensitivity.hpp"

#include "scenarios/draw/drawn_numbers.hpp"
#include "sim/random/stream.hpp"
#include "tests/scenarios/summary/rate_error.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

/// Fixture has 120 draws whose error follows the slope, and which fail where the rocks are large.
struct Fixture {
  Summary summary;
  std::map<std::string, NumbersOfDraws> numbers;
};

Fixture fixture(std::size_t draws = 120) {
  sim::Stream stream(1, "test.sensitivity");
  Section section;
  section.scenario = "hill";
  section.kind = Kind::rate;
  section.baseline = "raw";
  section.metrics = {kError};
  MethodSummary method;
  method.method = "raw";
  MetricSummary& metric = method.metrics[kError];
  Fixture out;
  NumbersOfDraws& numbers = out.numbers["hill"];
  for (std::uint64_t seed = 1; seed <= draws; ++seed) {
    const double slope = stream.uniform(), rock = stream.uniform();
    numbers["world.slope_rad"].push_back({seed, slope});
    numbers["world.rock_m"].push_back({seed, rock});
    for (int i = 0; i < 8; ++i) numbers["motion.idle_" + std::to_string(i)].push_back({seed, stream.uniform()});
    method.seeds.push_back(seed);
    if (rock > 0.85) {
      method.not_ok_seeds.push_back(seed);
      metric.failed.push_back(seed);
    } else {
      metric.seeds.push_back(seed);
      metric.values.push_back(std::exp(3.0 * slope + 0.5 * stream.normal()));
    }
  }
  section.methods = {method};
  out.summary.sections = {section};
  return out;
}

TEST(Sensitivity, NamesWhatBreaksAMethod) {
  const Fixture given = fixture();
  const std::vector<Sensitivity> rows = sensitivities(given.summary, given.numbers, {{}, {kError}});
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].metric, "not ok");
  EXPECT_EQ(rows[0].influences[0].number, "world.rock_m");
  EXPECT_LT(rows[0].influences[0].corrected, 1e-6);
  const Sensitivity& row = rows[1];
  EXPECT_EQ(row.draws, 120u) << "a failed draw is the worst, not left out";
  ASSERT_EQ(row.influences.size(), 10u);
  EXPECT_EQ(row.influences[0].number, "world.slope_rad");
  EXPECT_GT(row.influences[0].correlation.rho, 0.5) << "steeper is worse";
  EXPECT_GT(row.influences[0].median_high, 3.0 * row.influences[0].median_low);
  const std::vector<DependenceClass>& slope = row.influences[0].dependence;
  ASSERT_EQ(slope.size(), 8u);
  EXPECT_GT(slope.back().centre.low, slope.front().centre.value) << "the score rises over the classes of the slope";
  const std::vector<DependenceClass>& share = rows[0].influences[0].dependence;
  ASSERT_EQ(share.size(), 8u);
  for (const DependenceClass& each : share) EXPECT_LE(each.centre.high, 1.0) << "a share that has failed";
  EXPECT_EQ(row.influences[1].number, "world.rock_m");
  EXPECT_LT(row.influences[1].corrected, 0.05);
  for (std::size_t i = 2; i < row.influences.size(); ++i)
    EXPECT_GT(row.influences[i].corrected, 0.05) << "negative control: " << row.influences[i].number;
}

// a quick sweep has twenty draws: a rank correlation finds strong influences with them, and an index needs more draws
TEST(Sensitivity, FewDrawsNameWhatIsStrongByRankCorrelationAlone) {
  Fixture given = fixture(20);
  MethodSummary& method = given.summary.sections[0].methods[0];
  method.not_ok_seeds.clear();
  MetricSummary& metric = method.metrics[kError];
  metric.failed.clear();
  metric.seeds = method.seeds;
  metric.values.clear();
  for (const RankedValue& slope : given.numbers["hill"]["world.slope_rad"])
    metric.values.push_back(std::exp(slope.value));
  const std::vector<Sensitivity> rows = sensitivities(given.summary, given.numbers, {{}, {kError}});
  ASSERT_EQ(rows.size(), 1u) << "none has failed";
  EXPECT_EQ(rows[0].influences[0].number, "world.slope_rad");
  EXPECT_LT(rows[0].influences[0].corrected, 0.05);
  for (const Influence& each : rows[0].influences) EXPECT_EQ(each.first_order.index, 0.0) << each.number;
}

TEST(Sensitivity, FewDrawsSayNothing) {
  const Fixture given = fixture(11);
  EXPECT_TRUE(sensitivities(given.summary, given.numbers, {{}, {kError}}).empty());
  EXPECT_THROW(sensitivities(given.summary, given.numbers, {{"nobody"}, {}}), BadInput);
}

// in a table without any dependence, at most one of twenty rows names one
void expect_nothing_named(std::size_t draws) {
  int named = 0;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Fixture given = fixture(draws);
    sim::Stream stream(trial, "test.shuffled");
    for (auto& [name, column] : given.numbers["hill"]) {
      for (RankedValue& each : column) each.value = stream.uniform();
    }
    for (const Sensitivity& row : sensitivities(given.summary, given.numbers, {{}, {kError}})) {
      if (row.metric != kError) continue;
      named += std::any_of(row.influences.begin(), row.influences.end(),
                           [](const Influence& each) { return each.corrected < 0.05; });
    }
  }
  EXPECT_LE(named, 20) << "5 % of 200 are 10";
}

TEST(Sensitivity, NamesNothingWhereNothingIs) {
  for (const std::size_t draws : {12u, 60u}) expect_nothing_named(draws);
}

// the numbers computed for a seed are those with which a draw of that seed is made
TEST(DrawnNumbers, AreThoseOfTheDraw) {
  const DataRoot data{test::source_dir()};
  const Scenario scenario = load_scenario(data, "hill");
  const std::vector<DrawnNumber> numbers = drawn_numbers(scenario);
  ASSERT_GT(numbers.size(), 5u);
  for (const std::uint64_t seed : {1001u, 1002u}) {
    const sim::Situation situation = draw(data, scenario, seed);
    const std::string text = to_yaml(situation);
    std::size_t found = 0;
    for (const DrawnNumber& number : numbers) {
      const std::string name = number.place.substr(number.place.rfind('.') + 1);
      const auto holds = [&](const sim::Values& values) {
        return values.has(name) && values.at(name) == number.of(seed);
      };
      bool held = situation.duration_s == number.of(seed) || holds(situation.world.values) ||
                  holds(situation.robot.values) || holds(situation.motion.values);
      for (const sim::SensorSpec& sensor : situation.sensors) {
        if (!number.place.starts_with("sensors." + sensor.name + ".")) continue;
        held =
            held || holds(number.place.find(".mount_error.") == std::string::npos ? sensor.values : sensor.mount_error);
      }
      EXPECT_TRUE(held) << number.place;
      found += held;
    }
    EXPECT_EQ(found, numbers.size());
  }
  EXPECT_NE(numbers[0].of(1001), numbers[0].of(1002));
}

}  // namespace
}  // namespace tumble::scenarios
