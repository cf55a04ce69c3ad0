// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/results.hpp"
#include "scenarios/sweep/small_catalogue.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "tests/scenarios/testing.hpp"

// the suites vary a number on the sphere, whose draws are short
namespace tumble::scenarios {
namespace {

constexpr const char* kHead =
    "name: test\ndoc: d\nscenarios: [roll]\nseeds: {first: 1, last: 1}\nmethods: [rate/raw, rolling]\nvary:\n";

class CurveSuiteTest : public testing::SmallCatalogue {
 protected:
  Suite suite(const std::string& vary) const {
    write("scenarios/suites/test.yaml", kHead + vary);
    return load_suite(data(), "test");
  }

  std::string complaint(const std::string& vary) const {
    return test::complaint([&] { suite(vary); });
  }
};

TEST_F(CurveSuiteTest, ReadsKeysAndValues) {
  const Suite read = suite("  given.time_offset_s: [0, 0.01]\n  world.room_half_m + world.wall_height_m: [2.6, 3.5]\n");
  ASSERT_EQ(read.curves.size(), 2u);
  EXPECT_EQ(read.curves[0].key(), "given.time_offset_s");
  EXPECT_EQ(read.curves[0].values, (std::vector<double>{0.0, 0.01}));
  EXPECT_EQ(read.curves[1].key(), "world.room_half_m+world.wall_height_m");
  EXPECT_EQ(read.curves[1].keys.size(), 2u);
}

TEST_F(CurveSuiteTest, ComplaintsNameFileLineAndNearestName) {
  // the first line of `vary` is line 7
  EXPECT_THAT(complaint("  given.time_ofset_s: [0]\n"), HasSubstr("test.yaml:7"));
  EXPECT_THAT(complaint("  given.time_ofset_s: [0]\n"), HasSubstr("did you mean 'time_offset_s'"));
  EXPECT_THAT(complaint("  given.time_offset_s: [0]\n  world.room_half: [4]\n"), HasSubstr("test.yaml:8"));
  EXPECT_THAT(complaint("  world.room_half: [4]\n"), HasSubstr("did you mean 'room_half_m'"));
  EXPECT_THAT(complaint("  rate/saav.saturation_point_rad_s: [9]\n"), HasSubstr("'rate/saave'"));
  EXPECT_THAT(complaint("  rate/saave.saturation_rad_s: [9]\n"), HasSubstr("'saturation_point_rad_s'"));
  EXPECT_THAT(complaint("  rate/saave.saturation_point_rad_s: [-9]\n"), HasSubstr("must be within"));
  EXPECT_THAT(complaint("  given.time_offset_s: []\n"), HasSubstr("test.yaml:7"));
  EXPECT_THAT(complaint("  given.time_offset_s: []\n"), HasSubstr("is empty; list at least one value"));
  EXPECT_THAT(complaint("  given.time_offset_s: [0, 5]\n"), HasSubstr("must be within [-1, 1]"));
  EXPECT_THAT(complaint("  given.time_offset_s: [0, 0]\n"), HasSubstr("a value occurs twice"));
  EXPECT_THAT(complaint("  given.time_offset_s: [zero]\n"), HasSubstr("test.yaml:7"));
  EXPECT_THAT(complaint("  given.time_offset_s: 3\n"), HasSubstr("test.yaml:7"));
  EXPECT_THAT(complaint("  world.room_half_m: [4, -4]\n"), HasSubstr("must be within"));
  EXPECT_THAT(complaint("  given.extrinsic_rotation_rad: [0]\n"), HasSubstr("has no lidar"));
  EXPECT_THAT(complaint("  given.time_offset_s + world.room_half_m: [0.1]\n"),
              HasSubstr("keys that vary together must be of the same kind"));
  EXPECT_THAT(complaint("  given.time_offset_s + : [0.1]\n"), HasSubstr("empty or occurs twice"));
  EXPECT_THAT(complaint("  {}\n"), HasSubstr("list at least one curve"));
}

/// Returns outcomes by their curve: (key, value) -> digests of recordings.
std::map<Setting, std::set<std::string>> recordings(const Results& results) {
  std::map<Setting, std::set<std::string>> found;
  for (const Outcome& row : results.outcomes(Rows::all)) found[row.setting].insert(row.recording_digest);
  return found;
}

TEST_F(CurveSuiteTest, SweepsEveryPointOnceAndSimulatesOnlyWhereItMust) {
  const Suite curves = suite(
      "  given.time_offset_s: [0, 0.01]\n  motion.leg_1_m: [0.35, 0.45]\n  rate/saave.saturation_point_rad_s: [9]\n");
  const auto path = folder_ / "a.db";
  const SweepProgress progress = sweep(data(), curves, DatabaseOwner(path), {});
  EXPECT_EQ(progress.draws_total, 3u) << "one simulation as it is, one for each length of the way";
  // two methods run unchanged, at two offsets and at two lengths; the parameter of an absent method adds no outcome
  EXPECT_EQ(progress.outcomes, 10u);
  EXPECT_EQ(progress.not_ok(), 0u);

  const Results results(path, Results::Mode::read_only);
  const auto by_setting = recordings(results);
  ASSERT_EQ(by_setting.size(), 5u);
  for (const auto& [setting, digests] : by_setting) EXPECT_EQ(digests.size(), 1u) << setting.key;
  const std::set<std::string>& plain = by_setting.at({});
  EXPECT_EQ(by_setting.at({"given.time_offset_s", 0.01}), plain) << "the same simulation";
  EXPECT_NE(by_setting.at({"motion.leg_1_m", 0.35}), plain);
  EXPECT_NE(by_setting.at({"motion.leg_1_m", 0.35}), by_setting.at({"motion.leg_1_m", 0.45}));

  // the points of curves are separate from the plain rows, in both views of the database
  EXPECT_EQ(results.outcomes().size(), 2u);
  EXPECT_EQ(results.outcomes(Rows::curves).size(), 8u);
  for (const ScoreRow& row : results.scores()) EXPECT_TRUE(row.setting.is_plain());
  EXPECT_EQ(results.draws().size(), 1u);
  EXPECT_EQ(results.draws(Rows::all).size(), 3u);

  // no outcome remains to be computed; only another value is run
  EXPECT_EQ(sweep(data(), curves, DatabaseOwner(path), {}).outcomes, 0u);
  EXPECT_EQ(sweep(data(), suite("  given.time_offset_s: [0, 0.01, 0.02]\n"), DatabaseOwner(path), {}).outcomes, 2u);
}

TEST_F(CurveSuiteTest, LeavesThePlainDrawAsASuiteWithoutCurvesHasIt) {
  sweep(data(), suite("  given.time_offset_s: [0.01]\n  motion.leg_1_m: [0.35]\n"), DatabaseOwner(folder_ / "a.db"),
        {});
  Suite plain = suite("  given.time_offset_s: [0.01]\n");
  plain.curves.clear();
  sweep(data(), plain, DatabaseOwner(folder_ / "b.db"), {});
  const auto digests = [&](const char* name) {
    std::vector<std::string> all;
    for (const Outcome& row : Results(folder_ / name, Results::Mode::read_only).outcomes())
      all.push_back(row.recording_digest + row.estimate_digest);
    return all;
  };
  ASSERT_EQ(digests("a.db").size(), 2u);
  EXPECT_EQ(digests("a.db"), digests("b.db"));
}

TEST_F(CurveSuiteTest, ADrawThatAValueMakesImpossibleIsKeptAsRejected) {
  // the simulation rejects a path without length, which the suite cannot foresee
  const auto path = folder_ / "a.db";
  const Suite curves = suite("  motion.leg_1_m: [0, 0.4]\n");
  EXPECT_EQ(sweep(data(), curves, DatabaseOwner(path), {}).rejected, 1u);
  const Results results(path, Results::Mode::read_only);
  EXPECT_TRUE(results.rejected().empty()) << "the scenario as it is was not rejected";
  ASSERT_EQ(results.rejected(Rows::curves).size(), 1u);
  EXPECT_EQ(results.rejected(Rows::curves)[0].setting, (Setting{"motion.leg_1_m", 0.0}));
  EXPECT_EQ(sweep(data(), curves, DatabaseOwner(path), {}).rejected, 0u) << "not tried again";
}

TEST(CurveSuites, OfTheTreeVaryWhatTheirIssuesName) {
  const DataRoot tree{test::source_dir()};
  const auto keys = [&](const char* name) {
    std::vector<std::string> all;
    for (const Variation& curve : load_suite(tree, name).curves) all.push_back(curve.key());
    return all;
  };
  EXPECT_THAT(keys("curves_rate"),
              UnorderedElementsAre("given.lever_arm_error_m", "given.stated_rail_error", "sensors.imu.output_rate_hz",
                                   "sensors.imu.accel_range_m_s2+sensors.imu.accel_rail_m_s2"));
  EXPECT_THAT(keys("curves_slam"),
              UnorderedElementsAre("given.rate_error_rad_s", "given.extrinsic_rotation_rad", "given.time_offset_s",
                                   "world.rock_count+world.trunk_count", "sensors.imu.output_rate_hz"));
}

}  // namespace
}  // namespace tumble::scenarios
