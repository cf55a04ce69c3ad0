// SPDX-License-Identifier: BSD-3-Clause
// The test checks the comparison of two methods and the causes of their failures, from a database made by hand.
#include "scenarios/draw/drawn_numbers.hpp"
#include "scenarios/provenance/data_digest.hpp"
#include "scenarios/sweep/database_owner.hpp"
#include "scenarios/sweep/results.hpp"
#include "sim/random/stream.hpp"
#include "system/program.hpp"

namespace tumble::system_test {
namespace {

using scenarios::OutcomeStatus;

const std::string kError = "rate_error_clipped_median_rad_s";

/// Writes 60 draws of hill whose errors follow the slope with which each was drawn; the errors of `raw` are twice those
/// of `saave`.
fs::path database_of(const fs::path& folder) {
  const scenarios::DataRoot data{test::source_dir()};
  const scenarios::Scenario scenario = scenarios::load_scenario(data, "hill");
  const scenarios::DrawnNumber number = scenarios::drawn_numbers(scenario).front();
  scenarios::Results results(folder / "hand.db", scenarios::Results::Mode::create_or_append);
  results.set_note("data", scenarios::data_digest(data));
  sim::Stream stream(1, "test.hand");
  results.in_one_transaction([&] {
    for (std::uint64_t seed = 1001; seed <= 1060; ++seed) {
      for (const auto& [method, factor] : {std::pair{"raw", 2.0}, std::pair{"saave", 1.0}}) {
        scenarios::Outcome outcome;
        outcome.scenario = "hill";
        outcome.seed = seed;
        outcome.method = method;
        outcome.status = factor > 1.0 && seed % 9 == 0 ? OutcomeStatus::diverged : OutcomeStatus::ok;
        outcome.scores = {{kError, factor * std::exp(4.0 * number.of(seed) + 0.1 * stream.normal())}};
        results.store(outcome);
      }
    }
  });
  return folder / "hand.db";
}

TEST(Compare, SaysWhoIsBetterByHowMuchAndHowSure) {
  const std::string database = database_of(test_folder()).string();
  const json found = json_of(run_program({"compare", database, "--margin", "10%", "--json"}));
  ASSERT_EQ(found["metrics"].size(), 1u) << "the other headline metrics have no value";
  const json& row = found["metrics"][0];
  EXPECT_EQ(row["method"], "saave");
  EXPECT_EQ(row["against"], "raw");
  EXPECT_EQ(row["pairs"], 60);
  EXPECT_EQ(row["finding"], "better");
  EXPECT_EQ(row["not_inferior"], true);
  EXPECT_LT(row["difference"]["value"], 0.0);
  ASSERT_EQ(found["failures"].size(), 1u);
  EXPECT_EQ(found["failures"][0]["only_against"], 6);
  EXPECT_EQ(found["failures"][0]["mcnemar_p"], 0.03125);
  const Ended text = run_successfully({"compare", database, "--method", "raw", "--method", "rate/saave"});
  EXPECT_THAT(text.out, HasSubstr("hill: rate, paired with saave"));
  EXPECT_THAT(text.out, HasSubstr(" worse"));
}

TEST(Compare, WritesTablesForDocuments) {
  const std::string database = database_of(test_folder()).string();
  EXPECT_THAT(run_program({"compare", database, "--format", "md"}).out, HasSubstr("| metric | method | draws |"));
  EXPECT_THAT(run_program({"compare", database, "--format", "csv"}).out, HasSubstr("\nmetric,method,draws,"));
  // other programs read numbers, so the ends of an interval have separate cells
  const std::string csv = run_program({"compare", database, "--format", "csv"}).out;
  EXPECT_THAT(csv, HasSubstr(",median difference,95 % (BCa) low,95 % (BCa) high,better,worse,sign p,"));
  EXPECT_THAT(csv, HasSubstr(",share %,share % 95 % low,share % 95 % high,against %,"));
  EXPECT_EQ(csv.find('['), std::string::npos);
  // no two columns have the same name
  EXPECT_THAT(run_program({"compare", database, "--margin", "10%", "--format", "csv"}).out,
              HasSubstr(",no worse p,no worse Holm p,no worse\n"));
  EXPECT_THAT(run_program({"report", database, "--format", "tex"}).out,
              HasSubstr("rate\\_error\\_clipped\\_median\\_rad\\_s & raw & 60 & "));
  const Ended wrong = run_program({"compare", database, "--format", "pdf"});
  EXPECT_EQ(wrong.status, 2);
}

TEST(Compare, RefusesWithOneLine) {
  const std::string database = database_of(test_folder()).string();
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrongs = {
      {{"--method", "saav"}, "did you mean 'saave'?"},
      {{"--margin", "much"}, "--margin is 'much'"},
      {{"--margin", "0.1"}, "no metric is named; add --metric"},
      {{"--metric", "ate"}, "no metric 'ate'"},
      {{"--risk", "2"}, "must be from"},
      {{"--method", "raw"}, "no simulated run of this database has results of two of the named methods"}};
  for (const auto& [words, said] : wrongs) {
    std::vector<std::string> arguments = {"compare", database};
    arguments.insert(arguments.end(), words.begin(), words.end());
    const Ended ended = run_program(arguments);
    EXPECT_EQ(ended.status, 2) << said;
    EXPECT_EQ(line_count(ended.err), 1u) << ended.err;
    EXPECT_THAT(ended.err, HasSubstr(said));
  }
}

TEST(Sensitivity, NamesTheNumberThatWasDrawn) {
  const fs::path database = database_of(test_folder());
  const scenarios::Scenario scenario = scenarios::load_scenario(scenarios::DataRoot{test::source_dir()}, "hill");
  const std::string number = scenarios::drawn_numbers(scenario).front().place;
  const json found = json_of(run_program({"sensitivity", database.string(), "--json"}))["sensitivity"];
  bool seen = false;
  for (const json& row : found) {
    if (row["metric"] != kError || row["method"] != "saave") continue;
    seen = true;
    ASSERT_FALSE(row["breaks_it"].empty());
    EXPECT_EQ(row["breaks_it"][0], number);
    EXPECT_GT(row["numbers"][0]["rho"], 0.8);
    EXPECT_GT(row["numbers"].size(), 5u);
  }
  EXPECT_TRUE(seen);
  EXPECT_THAT(run_program({"sensitivity", database.string()}).out,
              HasSubstr("hill: influence of the random parameters on scores of rate methods"));
  // with other models and scenarios, the draws cannot be computed
  scenarios::Results(database, scenarios::Results::Mode::create_or_append).set_note("data", "another");
  const Ended other = run_program({"sensitivity", database.string()});
  EXPECT_EQ(other.status, 2);
  EXPECT_THAT(other.err, HasSubstr("digest 'another'"));
}

TEST(Sweep, OnADatabaseThatIsWrittenToSaysSoAndLeaves) {
  const fs::path database = test_folder() / "owned.db";
  {
    const scenarios::DatabaseOwner owner(database);
    for (const std::vector<std::string>& words :
         {std::vector<std::string>{"sweep", "roll", "--seeds", "1..2", "--method", "rate/raw", "--examples", "0",
                                   "--db"},
          {"gate", "gate", "--db"}}) {
      std::vector<std::string> arguments = words;
      arguments.push_back(database.string());
      const Ended second = run_program(arguments);
      EXPECT_EQ(second.status, 2);
      EXPECT_EQ(line_count(second.err), 1u) << second.err;
      EXPECT_THAT(second.err, HasSubstr("is writing to this database"));
    }
  }
  EXPECT_FALSE(fs::exists(database)) << "nothing was made";
}

}  // namespace
}  // namespace tumble::system_test
