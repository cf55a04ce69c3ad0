// SPDX-License-Identifier: BSD-3-Clause
// The test runs gate and triage as the program does, on fast draws of the sphere.
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

/// Writes a suite of two draws.
fs::path small_suite(const fs::path& folder) {
  std::ofstream(folder / "small.yaml")
      << "name: small\ndoc: two draws\nscenarios: [roll]\nseeds: {first: 1, last: 2}\n";
  return folder / "small.yaml";
}

TEST(Gate, HoldsARunToTheAcceptedOne) {
  const fs::path folder = test_folder(), suite = small_suite(folder);
  const std::string database = (folder / "g.db").string(), against = (folder / "accepted.yaml").string();
  std::vector<std::string> arguments = {"gate", suite.string(), "--against", against,
                                        "--db", database,       "--json",    "--quiet"};
  std::vector<std::string> accept = arguments;
  accept.emplace_back("--accept");
  run_successfully(accept, in_short_catalogue());
  const Ended same = run_successfully(arguments, in_short_catalogue());
  EXPECT_EQ(same.err, "");
  const json held = json_of(same);
  EXPECT_EQ(held["verdict"], "pass");
  ASSERT_GE(held["held"].size(), 4u);
  EXPECT_EQ(held["held"][0]["draws"], 2);
  EXPECT_THAT(held["certificate"].get<std::string>(), ::testing::AnyOf(HasSubstr("not measured"), HasSubstr("within")));

  // negative control: the accepted run was far better, and its results exist already
  const std::string key = "roll,position,tumble,position_end_error_share";
  std::string table = read_file(folder / "accepted.csv");
  const std::size_t begin = table.find(key);
  ASSERT_NE(begin, std::string::npos) << table;
  table.replace(begin, table.find('\n', begin) - begin, key + ",1e-9,1e-9");
  std::ofstream(folder / "accepted.csv") << table;
  const Ended worse = run_program(arguments, in_short_catalogue());
  EXPECT_EQ(worse.status, 1);
  EXPECT_EQ(json::parse(worse.out)["verdict"], "fail");

  // the gate of another suite does not apply to this one
  std::string policy = read_file(against);
  policy.replace(policy.find("suite: small"), 12, "suite: other");
  std::ofstream(against) << policy;
  const Ended other = run_program(arguments, in_short_catalogue());
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("'other'"));
}

TEST(Gate, WithoutAnAcceptedRunSaysHowToMakeIt) {
  const fs::path folder = test_folder();
  const Ended ended = run_program({"gate", small_suite(folder).string()});
  EXPECT_EQ(ended.status, 2);
  EXPECT_EQ(line_count(ended.err), 1u) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("'tumble gate small --accept'"));
}

/// The test makes a case from a draw that fails, runs it by its name, compares it with its bound, finds it cured, and
/// accepts it.
TEST(Shrink, LeavesACaseThatTheGateHolds) {
  const fs::path folder = test_folder();
  const auto in_own_data = [&] { setenv("TUMBLE_DATA", folder.c_str(), 1); };
  fs::create_directories(folder / "scenarios" / "regressions");
  fs::create_symlink(test::source_dir() / "models", folder / "models");
  for (const char* name : {"catalogue", "suites", "gates"})
    fs::create_symlink(test::source_dir() / "scenarios" / name, folder / "scenarios" / name);
  const fs::path file = folder / "scenarios" / "regressions" / "raw_clips.yaml";
  const Ended shrunk =
      run_successfully({"shrink", "swing", "--seed", "1", "--method", "rate/raw", "--failure",
                        "rate_error_free_median_rad_s > 0.0001", "--budget", "6", "-o", file.string(), "--json"},
                       in_own_data);
  EXPECT_THAT(shrunk.err, HasSubstr("6 of at most 6: "));
  const json document = json_of(shrunk);
  EXPECT_EQ(document["runs"], 6);
  EXPECT_GT(document["shrunk"]["value"], 0.0001);
  EXPECT_EQ(document["lines"][0]["what"], "duration_s");
  EXPECT_LT(document["lines"][0]["to"], document["lines"][0]["from"]);

  EXPECT_THAT(run_program({"list", "scenarios"}, in_own_data).out, HasSubstr("raw_clips"));
  const Ended run = run_program({"run", "raw_clips", "--method", "rate/raw", "--json", "--quiet"}, in_own_data);
  EXPECT_EQ(json_of(run)["seed"], 1) << run.err;

  const std::vector<std::string> gate = {"gate", "regressions", "--json", "--quiet"};
  const Ended held = run_program(gate, in_own_data);
  EXPECT_EQ(held.status, 0) << held.out;
  EXPECT_EQ(json_of(held)["cases"][0]["expected"], "fails");

  // negative control: with a bound that the case does not exceed, the case is cured
  std::string text = read_file(file);
  const std::string key = "worse_than: ";
  const std::size_t bound = text.find(key) + key.size();
  text.replace(bound, text.find(',', bound) - bound, "9999");
  std::ofstream(file) << text;
  const Ended cured = run_program(gate, in_own_data);
  EXPECT_EQ(cured.status, 1);
  EXPECT_THAT(json_of(cured)["cases"][0]["fault"].get<std::string>(), HasSubstr("cured"));
  run_successfully({"gate", "raw_clips", "--accept", "--quiet"}, in_own_data);
  EXPECT_THAT(read_file(file), HasSubstr("run: holds"));
  run_successfully(gate, in_own_data);
}

TEST(Triage, OfASuiteSaysWhichInputMattersMost) {
  const fs::path folder = test_folder();
  std::ofstream(folder / "small.yaml")
      << "name: small\ndoc: two draws\nscenarios: [swing]\nseeds: {first: 1, last: 2}\n";
  const Ended ended = run_successfully({"triage", (folder / "small.yaml").string(), "--method", "rate/raw", "--failure",
                                        "rate_error_free_median_rad_s > 0.0001", "--jobs", "2", "--json"});
  EXPECT_THAT(ended.err, HasSubstr("gyro_exact"));
  EXPECT_THAT(ended.err, HasSubstr("has the strongest influence: its true value prevents 2 of 2 failures"));
  const json triage = json_of(ended);
  EXPECT_EQ(triage["draws"].size(), 2u);
  EXPECT_EQ(triage["inputs"][0]["share_cured"]["value"], 1.0);
}

}  // namespace
}  // namespace tumble::system_test
