// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/search/failure_search.hpp"

#include <atomic>
#include <boost/math/distributions/normal.hpp>

#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/draw/scenario_text.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/search/input_shift.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "sim/random/stream.hpp"
#include "tests/scenarios/testing.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

constexpr const char* kMetric = "rate_error_free_median_rad_s";
constexpr const char* kX = "sensors.imu.mount_error.x_m";
constexpr const char* kY = "sensors.imu.mount_error.y_m";
constexpr double kSigma_m = 0.002;

/// A short roll with two random parameters that the planted fault depends on, and one that has no influence.
constexpr const char* kRoll = R"(name: planted
doc: A sphere rolls for a short time.
duration_s: 1.1
world: {type: floor, room_half_m: 4, pillar_count: 0, box_count: 0}
robot: {type: sphere}
motion: {type: hand_roll, rest_s: 0.6, leg_1_m: {uniform: [0.3, 0.5]}, leg_2_m: 0}
sensors:
  - name: imu
    kind: imu
    device: phidget1044
    site: phidget_1
    mount_error: {x_m: {normal: [0, 0.002]}, y_m: {normal: [0, 0.002]}}
)";

Scenario roll() {
  return parse_scenario(kRoll, "planted.yaml", Registry::of_simulation());
}

/// Returns the lever arm without error [m].
Vector3d lever_arm_m() {
  Scenario exact = roll();
  fix_number(exact, kX, 0.0);
  fix_number(exact, kY, 0.0);
  return simulate_draw(test::tree_data(), exact, 1, 1).recording.sensors.imus.front().T_BI.translation();
}

/// Returns a method with a fault of known probability: its error is exp(v) rad/s, where the sum v of both lever-arm
/// errors is a standard normal number. The gyro noise of 0.01 rad/s is negligible. Beyond `lost_beyond`, the method
/// reports an error.
Method planted(double lost_beyond = std::numeric_limits<double>::infinity()) {
  Method method = *find_methods("rate/raw").front();
  const Method oracle = *find_methods("rate/oracle").front();
  method.info.name = "planted";
  method.info.needs_truth = true;
  method.run = [oracle, lost_beyond, exact = lever_arm_m()](const sim::Sensors& sensors, const sim::Values& values,
                                                            const OracleInput& input) {
    Estimate estimate = oracle.run(sensors, values, input);
    const Vector3d error = sensors.imus.front().T_BI.translation() - exact;
    const double v = (error.x() + error.y()) / (kSigma_m * std::sqrt(2.0));
    for (AngularRateState& state : estimate.rates) state.w_WI_I_rad_s.x() += std::exp(v);
    if (v > lost_beyond) estimate.status = {ErrorCode::empty, "planted", v, lost_beyond};
    return estimate;
  };
  return method;
}

double quantile_beyond(double probability) {
  return quantile(complement(boost::math::normal(), probability));
}

class FailureSearch : public test::TemporaryFolder {
 protected:
  SearchResult search(const std::string& file, const Method& method, const FailureGoal& goal,
                      const SearchOptions& options) const {
    Results results(folder_ / file, Results::Mode::create_or_append);
    return search_failures(test::tree_data(), roll(), method, goal, results, options);
  }
};

class FailureSearchSoak : public FailureSearch {};

std::vector<double> scores_of(const SearchResult& result) {
  std::vector<double> out;
  for (const ScoredPoint& draw : result.splitting.draws) out.push_back(draw.score);
  return out;
}

SearchOptions small(std::size_t population, std::size_t budget) {
  SearchOptions out;
  out.population = population;
  out.budget = budget;
  out.jobs = 2;
  return out;
}

TEST_F(FailureSearchSoak, FindsThePlantedFaultWithItsProbabilityAndCause) {
  const double probability = 1e-2;
  const FailureGoal goal{kMetric, std::exp(quantile_beyond(probability))};
  const SearchResult found = search("p.db", planted(), goal, small(24, 3000));
  ASSERT_TRUE(found.splitting.complete);
  EXPECT_LT(found.splitting.probability.low, probability);
  EXPECT_GT(found.splitting.probability.high, probability);
  EXPECT_LT(found.splitting.probability.high / found.splitting.probability.low, 20.0);
  EXPECT_GE(found.failures, 18u);

  ASSERT_EQ(found.shifts.size(), 3u);
  EXPECT_THAT((std::vector{found.shifts[0].number, found.shifts[1].number}), UnorderedElementsAre(kX, kY));
  EXPECT_LT(found.shifts[1].corrected, 0.05);
  EXPECT_GT(found.shifts[2].corrected, 0.05) << found.shifts[2].number << " has no influence";
  EXPECT_GT(found.shifts[0].median, found.shifts[0].scenario_median);

  // the most likely failure is at the bound, in the direction of both errors
  ASSERT_FALSE(found.likely.empty());
  EXPECT_GE(found.likely.front().distance, quantile_beyond(probability));
  EXPECT_LE(found.likely.front().distance, found.likely.back().distance);
  EXPECT_GE(found.worst.value, found.likely.front().value);
}

TEST_F(FailureSearch, AFoundDrawIsReproducedBitForBit) {
  const SearchResult found = search("p.db", planted(), {kMetric, std::exp(1.5)}, small(20, 200));
  ASSERT_FALSE(found.likely.empty());
  const FoundFailure& draw = found.likely.front();
  const Results results(folder_ / "p.db", Results::Mode::read_only);
  const std::vector<Outcome> stored = results.outcomes(Rows::curves);
  const auto row = std::find_if(stored.begin(), stored.end(), [&](const Outcome& each) {
    return each.setting == Setting{kSearchRun, static_cast<double>(draw.run)};
  });
  ASSERT_NE(row, stored.end());
  // through the text of a scenario file, as the program writes it
  const Scenario read = parse_scenario(to_yaml(draw.scenario), "found.yaml", Registry::of_simulation());
  const SimulatedDraw again = simulate_draw(test::tree_data(), read, draw.seed, 1);
  Outcome outcome;
  const Method method = planted();
  assess(method, again, nullptr, run_method(method, again, outcome), outcome);
  EXPECT_EQ(outcome.estimate_digest, row->estimate_digest);
  EXPECT_EQ(value_of(outcome.scores, kMetric), draw.value);
}

TEST_F(FailureSearch, DoesNotDependOnTheNumberOfJobs) {
  SearchOptions options = small(12, 70);
  const FailureGoal goal{kMetric, std::exp(3.0)};
  const SearchResult two = search("two.db", planted(), goal, options);
  options.jobs = 1;
  const SearchResult one = search("one.db", planted(), goal, options);
  EXPECT_EQ(scores_of(one), scores_of(two));
  EXPECT_EQ(one.splitting.probability.high, two.splitting.probability.high);
  options.seed = 2;
  EXPECT_NE(scores_of(search("other.db", planted(), goal, options)), scores_of(one));
}

TEST_F(FailureSearch, ContinuesWithTheStoredRuns) {
  const FailureGoal goal{kMetric, std::exp(3.0)};
  const SearchResult whole = search("whole.db", planted(), goal, small(12, 70));
  search("part.db", planted(), goal, small(12, 40));
  std::atomic<bool> stop{false};
  SearchOptions options = small(12, 70);
  options.stop = &stop;
  options.on_runs = [&](std::size_t, std::size_t) { stop = true; };
  EXPECT_TRUE(search("part.db", planted(), goal, options).splitting.stopped);
  const SearchResult continued = search("part.db", planted(), goal, small(12, 70));
  EXPECT_EQ(scores_of(continued), scores_of(whole));
  // stored runs are not repeated: this method could not give their scores
  Method crashing = planted();
  crashing.run = [](const sim::Sensors&, const sim::Values&, const OracleInput&) -> Estimate { std::abort(); };
  EXPECT_EQ(scores_of(search("part.db", crashing, goal, small(12, 70))), scores_of(whole));
}

TEST_F(FailureSearchSoak, LostRunsExceedEachLimit) {
  const FailureGoal lost{kMetric, std::numeric_limits<double>::infinity()};
  const SearchResult found = search("p.db", planted(1.5), lost, small(16, 500));
  EXPECT_TRUE(found.splitting.complete);
  EXPECT_LT(found.splitting.probability.low, 0.0668) << "P(v > 1.5)";
  EXPECT_GT(found.splitting.probability.high, 0.0668);
  EXPECT_EQ(found.worst.status, OutcomeStatus::failed);
  EXPECT_EQ(search("none.db", planted(), lost, small(24, 24)).failures, 0u) << "negative control";
}

TEST_F(FailureSearch, ACrashIsAFailureOfThatRunOnly) {
  Method crashing = planted();
  crashing.run = [healthy = crashing.run](const sim::Sensors& sensors, const sim::Values& values,
                                          const OracleInput& input) {
    Estimate estimate = healthy(sensors, values, input);
    if (estimate.rates.front().w_WI_I_rad_s.x() > std::exp(1.0)) std::abort();
    return estimate;
  };
  const SearchResult found =
      search("p.db", crashing, {kMetric, std::numeric_limits<double>::infinity()}, small(20, 20));
  EXPECT_GT(found.failures, 0u);
  EXPECT_LT(found.failures, 20u);
  EXPECT_EQ(found.worst.status, OutcomeStatus::crashed);
}

TEST_F(FailureSearch, RejectsAnotherSearchAndAFixedScenario) {
  search("p.db", planted(), {kMetric, 1.0}, small(4, 4));
  try {
    search("p.db", planted(), {kMetric, 2.0}, small(4, 4));
    ADD_FAILURE() << "another limit was accepted";
  } catch (const BadInput& error) {
    EXPECT_THAT(error.what(), HasSubstr("contains another search of rate/planted on planted"));
    EXPECT_THAT(error.what(), HasSubstr("population 4, search seed 1"));
  }
  Scenario fixed = roll();
  for (const DrawnNumber& number : drawn_numbers(roll())) fix_number(fixed, number.place, number.of(1));
  Results results(folder_ / "f.db", Results::Mode::create_or_append);
  EXPECT_THROW(search_failures(test::tree_data(), fixed, planted(), {kMetric, 1.0}, results, small(4, 4)), BadInput);
}

const std::vector<DrawnNumber> kNumbers = {{"a", {Distribution::Shape::uniform, {0.0, 1.0}}},
                                           {"b", {Distribution::Shape::normal, {10.0, 2.0}}}};

/// Draws without influence, except that `b` is shifted. Each family has `size` draws.
std::vector<ScoredPoint> draws(std::uint64_t seed, std::size_t families, std::size_t size, double shift) {
  sim::Stream stream(seed, "test");
  std::vector<ScoredPoint> out;
  for (std::size_t family = 0; family < families; ++family) {
    const std::vector<double> normals = {stream.normal(), stream.normal() + shift};
    for (std::size_t i = 0; i < size; ++i) out.push_back({{normals, {0}}, 0.0, family});
  }
  return out;
}

TEST(InputShift, TheShiftedParameterIsFirst) {
  const std::vector<InputShift> shifts = input_shifts(kNumbers, draws(1, 40, 1, -2.0));
  ASSERT_EQ(shifts.size(), 2u);
  EXPECT_EQ(shifts[0].number, "b");
  EXPECT_NEAR(shifts[0].shift, -2.0, 4.0 / std::sqrt(40.0)) << "four standard errors";
  EXPECT_LT(shifts[0].corrected, 1e-6);
  EXPECT_GT(shifts[1].corrected, 1e-3);
  EXPECT_NEAR(shifts[0].scenario_median, 10.0, 1e-9);
  EXPECT_NEAR(shifts[0].scenario_high, 10.0 + 2.0 * 1.2816, 1e-3);
  EXPECT_NEAR(shifts[1].scenario_low, 0.1, 1e-9);
  EXPECT_LT(shifts[0].high, 10.0);
}

/// Copies of one draw must not count as independent draws: p-values below 5 % occur in at most 5 % of the cases.
TEST(InputShift, CopiesAreNoEvidence) {
  int significant = 0;
  for (std::uint64_t seed = 1; seed <= 400; ++seed)
    significant += input_shifts(kNumbers, draws(seed, 4, 25, 0.0)).front().corrected < 0.05 ? 1 : 0;
  EXPECT_LE(significant, 34) << "of 400, where 20 are expected; exceeded with a probability of 1e-3";
  EXPECT_GE(significant, 8);
}

}  // namespace
}  // namespace tumble::scenarios
