// SPDX-License-Identifier: BSD-3-Clause
// The test searches failures as a user does: search, reproduce a found draw, continue with a larger budget.
#include "system/program.hpp"
#include "system/short_sweep.hpp"

namespace tumble::system_test {
namespace {

constexpr const char* kMetric = "rate_error_free_median_rad_s";

std::vector<std::string> search_arguments(const fs::path& database, const std::string& budget) {
  return {"search",   "roll",   "--method",     "rate/raw", "--failure", std::string(kMetric) + " > 0.0001",
          "--budget", budget,   "--population", "8",        "--jobs",    "2",
          "--db",     database, "--json"};
}

/// Every run fails at such a bound, so the first population is enough.
TEST(Search, LeavesDrawsThatRunReproduces) {
  const fs::path folder = test_folder(), database = folder / "search.db";
  const Ended ended = run_shortened(search_arguments(database, "8"));
  ASSERT_EQ(ended.status, 0) << ended.err;
  EXPECT_THAT(ended.err, HasSubstr("8/8 runs  8 failures"));
  EXPECT_THAT(ended.err, HasSubstr("'tumble sweep' needs only"));
  const json found = json_of(ended)["search"][0];
  EXPECT_EQ(found["scenario"], "roll");
  EXPECT_EQ(found["probability"]["value"], 1.0);
  EXPECT_EQ(found["reached"], true);
  EXPECT_EQ(found["draws"].size(), 5u);
  const json draw = found["draws"][0];
  const fs::path file =
      database.string() + ".files/failures/roll_rate_raw_" + std::to_string(draw["run"].get<int>()) + ".yaml";
  const std::string seed = std::to_string(draw["seed"].get<std::uint64_t>());
  EXPECT_EQ(draw["command"], "tumble run " + file.string() + " --seed " + seed + " --method rate/raw");
  const json again = json_of(run_shortened({"run", file, "--seed", seed, "--method", "rate/raw", "--json"}));
  const auto has_value = [&](const json& row) { return row["metric"] == kMetric && row["value"] == draw["value"]; };
  EXPECT_TRUE(std::any_of(again["scores"].begin(), again["scores"].end(), has_value)) << again["scores"];
  EXPECT_EQ(run_shortened({"shrink", file, "--seed", seed, "--method", "rate/raw", "--failure",
                           std::string(kMetric) + " > 0.0001", "--budget", "2", "-o", folder / "case.yaml"})
                .status,
            0);
}

TEST(Search, ContinuesTheStoredSearchAndRefusesAnother) {
  const fs::path database = test_folder() / "search.db";
  std::vector<std::string> worst = {"search", "roll",         "--method", "rate/raw", "--worst", kMetric, "--budget",
                                    "8",      "--population", "8",        "--db",     database,  "--json"};
  const json first = json_of(run_shortened(worst))["search"][0];
  EXPECT_EQ(first["reached"], false);
  EXPECT_EQ(first["draws"].size(), 1u);
  worst[7] = "60";
  const json second = json_of(run_shortened(worst))["search"][0];
  EXPECT_GT(second["runs"], 8);
  EXPECT_GE(second["draws"][0]["value"], first["draws"][0]["value"]);
  EXPECT_FALSE(second["levels"].empty());
  const Ended other = run_shortened(search_arguments(database, "8"));
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("contains another search of rate/raw on roll"));
}

}  // namespace
}  // namespace tumble::system_test
