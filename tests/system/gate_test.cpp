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

std::string bounds_with(double high) {
  return "suite: small\nmargin: 0\nbounds:\n  - {scenario: roll, kind: position, method: rolling, metric: "
         "position_end_error_share, "
         "statistic: median, accepted: 0, high: " +
         std::to_string(high) + "}\n";
}

TEST(Gate, HoldsARunToItsBounds) {
  const fs::path folder = test_folder(), suite = small_suite(folder);
  const std::string database = (folder / "g.db").string(), bounds = (folder / "bounds.yaml").string();
  std::ofstream(bounds) << bounds_with(0.1);
  const std::vector<std::string> arguments = {"gate", suite.string(), "--bounds", bounds,
                                              "--db", database,       "--json",   "--quiet"};
  const Ended within = run_program(arguments);
  EXPECT_EQ(within.status, 0) << within.err;
  EXPECT_EQ(within.err, "");
  const json held = json_of(within);
  EXPECT_EQ(held["verdict"], "pass");
  ASSERT_EQ(held["bounds"].size(), 1u);
  EXPECT_EQ(held["bounds"][0]["draws"], 2);
  EXPECT_THAT(held["certificate"].get<std::string>(), ::testing::AnyOf(HasSubstr("not measured"), HasSubstr("within")));

  // negative control: a bound that nothing can keep; the results are there already
  std::ofstream(bounds) << bounds_with(1e-9);
  const Ended outside = run_program(arguments);
  EXPECT_EQ(outside.status, 1);
  EXPECT_EQ(json::parse(outside.out)["verdict"], "fail");

  // accepting that very run widens the bound to it
  std::vector<std::string> accept = arguments;
  accept.insert(accept.end(), {"--accept", "--margin", "0.5"});
  EXPECT_EQ(run_program(accept).status, 0);
  EXPECT_EQ(run_program(arguments).status, 0);
  EXPECT_THAT(read_file(bounds), HasSubstr("margin: 0.5"));
}

TEST(Gate, WithoutBoundsSaysHowToMakeThem) {
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
