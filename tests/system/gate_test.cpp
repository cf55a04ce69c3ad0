// SPDX-License-Identifier: BSD-3-Clause
// Gate and triage as the program does them, on fast draws of the sphere.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "system/program.hpp"

namespace tumble::system_test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::HasSubstr;

/// A suite of two draws.
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
  EXPECT_EQ(run_program(accept).status, 0);
  const Ended same = run_program(arguments);
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(same.err, "");
  const json held = json_of(same);
  EXPECT_EQ(held["verdict"], "pass");
  ASSERT_GE(held["held"].size(), 4u);
  EXPECT_EQ(held["held"][0]["draws"], 2);
  EXPECT_THAT(held["certificate"].get<std::string>(), ::testing::AnyOf(HasSubstr("not measured"), HasSubstr("within")));

  // negative control: an accepted run that was far better; the results are there already
  const std::string key = "roll,position,tumble,position_end_error_share";
  std::string table = read_file(folder / "accepted.csv");
  const std::size_t begin = table.find(key);
  ASSERT_NE(begin, std::string::npos) << table;
  table.replace(begin, table.find('\n', begin) - begin, key + ",1e-9,1e-9");
  std::ofstream(folder / "accepted.csv") << table;
  const Ended worse = run_program(arguments);
  EXPECT_EQ(worse.status, 1);
  EXPECT_EQ(json::parse(worse.out)["verdict"], "fail");

  // the gate of another suite is no gate of this one
  std::string policy = read_file(against);
  policy.replace(policy.find("suite: small"), 12, "suite: other");
  std::ofstream(against) << policy;
  const Ended other = run_program(arguments);
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

TEST(Triage, NamesTheInputThatCures) {
  const Ended ended = run_program({"triage", "hill", "--seed", "1", "--method", "rate/raw", "--metric",
                                   "rate_error_clipped_median_rad_s", "--limit", "0.1", "--json"});
  EXPECT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("cured by: "));
  const json triage = json_of(ended);
  EXPECT_EQ(triage["fails"], true);
  EXPECT_THAT(triage["cures"].get<std::vector<std::string>>(), testing::Contains("gyro_unclipped"));
}

}  // namespace
}  // namespace tumble::system_test
