// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/run_again.hpp"
#include "scenarios/methods/registry.hpp"

#include "scenarios/draw/fixed_scenario.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/sweep.hpp"
#include "scenarios/sweep/variation.hpp"
#include "tests/scenarios/testing.hpp"
#include "tests/testing.hpp"

namespace tumble::scenarios {
namespace {

using Notes = std::map<std::string, std::string>;

TEST(CommandAgain, IsOfEachSortOfRow) {
  const RunKey plain{"hill", 7, "slam", "tumble"};
  EXPECT_EQ(command_again(plain, {}), "tumble run hill --seed 7 --method slam/tumble");
  const RunKey point{"hill", 7, "rate", "raw", {"world.rock_count", 12.0}};
  EXPECT_EQ(command_again(point, {}), "tumble run hill --seed 7 --method rate/raw --vary world.rock_count=12");
  const RunKey rejected{"hill", 18446744073709551615u, "", ""};
  EXPECT_EQ(command_again(rejected, {}), "tumble run hill --seed 18446744073709551615");
  const Notes theirs = {{"method slam/theirs", "1"}, {description_note("slam", "theirs"), "/a b/it's.yaml"}};
  EXPECT_EQ(command_again({"hill", 7, "slam", "theirs"}, theirs),
            "tumble run hill --seed 7 --method '/a b/it'\\''s.yaml'");
  EXPECT_EQ(command_again({"hill", 7, "slam", "theirs"}, {{"method slam/theirs", "1"}}),
            "tumble run hill --seed 7 --method theirs.yaml");
  const Notes recorded = {{"source", kRecordingsSource}, {recording_note("trial"), "/data/trial.h5"}};
  EXPECT_EQ(command_again({"trial", 1, "rate", "raw"}, recorded),
            "tumble estimate /data/trial.h5 --method rate/raw -o trial");
  EXPECT_THAT(command_again({"other", 1, "rate", "raw"}, recorded), HasSubstr("FOLDER/other.h5"));
}

TEST(CommandAgain, SettingsComeBackToTheBit) {
  for (const double value : {0.1, 1.0 / 3.0, -2e-300, 12.0}) {
    const Setting setting{"given.lever_arm_error_m+given.mounting_error_rad", value};
    EXPECT_EQ(setting_from(to_text(setting)), setting);
  }
  for (const char* wrong : {"", "=", "a=", "=1", "a=x", "a=1x", "a=nan", "a=inf", "a 1"})
    EXPECT_THROW(setting_from(wrong), BadInput) << wrong;
  EXPECT_EQ(setting_from("a.b + c.d=2").key, "a.b+c.d");
}

using CommandAgainOfASweep = test::TemporaryFolder;

/// Each point of a sweep's curves, run by its command, has the same bits.
TEST_F(CommandAgainOfASweep, RunsWhatItRan) {
  Scenario scenario = load_scenario(test::tree_data(), "bare");
  fix_number(scenario, "duration_s", 2.5);
  std::erase_if(scenario.sensors, [](const Scenario::Sensor& sensor) { return sensor.name == "lidar"; });
  write("short.yaml", to_yaml(fixed_as(scenario, draw(test::tree_data(), scenario, 1))));
  Suite suite;
  suite.name = "small";
  suite.scenarios = {(folder_ / "short.yaml").string()};
  suite.methods = {"rate/raw", "rate/saave"};
  suite.curves = {{{"world.rock_count", "world.trunk_count"}, {3.0}},
                  {{"given.time_offset_s"}, {0.015}},
                  {{"rate/saave.jerk_psd_rad2_s5"}, {100.0}}};
  for (const Variation& curve : suite.curves) check(curve, test::tree_data(), suite.scenarios, 1);
  sweep(test::tree_data(), suite, DatabaseOwner(folder_ / "a.db"), {});

  const Results results(folder_ / "a.db", Results::Mode::read_only);
  const std::vector<Outcome> outcomes = results.outcomes(Rows::all);
  ASSERT_EQ(outcomes.size(), 7u);
  std::set<std::string> digests;
  for (const Outcome& outcome : outcomes) {
    const RunKey key = key_of(outcome);
    const std::string command = command_again(key, results.notes());
    const std::size_t vary = command.find(" --vary ");
    const Setting setting = vary == std::string::npos ? Setting{} : setting_from(command.substr(vary + 8));
    const RunResult run =
        run_situation(test::tree_data(), load_scenario(test::tree_data(), suite.scenarios.front()), key.seed,
                      find_methods(key.kind + "/" + key.method), 1, Lidars::left_out, setting);
    ASSERT_EQ(run.outcomes.size(), 1u);
    EXPECT_EQ(run.outcomes[0].estimate_digest, outcome.estimate_digest) << command;
    EXPECT_EQ(run.outcomes[0].status, outcome.status);
    EXPECT_EQ(run.outcomes[0].setting, outcome.setting);
    digests.insert(outcome.estimate_digest);
  }
  EXPECT_GE(digests.size(), 5u) << "a setting that is left out shows: raw and saave differ, and so do their points";
}

/// Returns what a shell makes of `words` as one argument.
std::string seen_by_a_shell(const std::string& words) {
  const std::string command = "printf '%s|' " + words;
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::array<char, 256> buffer{};
  std::string out;
  while (pipe && std::fgets(buffer.data(), buffer.size(), pipe.get()) != nullptr) out += buffer.data();
  return out;
}

TEST(SweepNotes, AShellReadsAWordAsItWas) {
  for (const std::string text : {"hill", "o u t/x.db", "it's", "$HOME", "a;b", "`id`", "\"", "", "*", "-x", "x\\y"})
    EXPECT_EQ(seen_by_a_shell(shell_word(text)), text + "|") << text;
  EXPECT_NE(seen_by_a_shell("o u t/x.db"), "o u t/x.db|") << "negative control";
  EXPECT_EQ(shell_word("suites/my-own_1.yaml"), "suites/my-own_1.yaml") << "no quotes where none are needed";
}

TEST(SweepNotes, EachCommandStandsOnceInItsOrder) {
  std::string note = with_commands("", "hill --seeds 1..4");
  note = with_commands(note, "throw --seeds 1..4");
  note = with_commands(note, "hill --seeds 1..4\nhill --seeds 5..8");
  const std::vector<std::string> all = {"hill --seeds 1..4", "throw --seeds 1..4", "hill --seeds 5..8"};
  EXPECT_EQ(commands_of(note), all);
  EXPECT_TRUE(commands_of("").empty());
  EXPECT_EQ(with_commands(note, ""), note);
}

}  // namespace
}  // namespace tumble::scenarios
