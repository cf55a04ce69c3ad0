// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tables/table.hpp"

#include <nlohmann/json.hpp>

#include "tests/testing.hpp"
#include "tests/tools/results_fixture.hpp"
#include "tools/tumble/score_tables.hpp"

namespace tumble::tools {
namespace {

TEST(Table, ColumnsAreAsWideAsTheirWidestCell) {
  Table table("title", {"name", "n"});
  table.add_row({"a", "1"});
  table.add_row({"longer", "22"});
  EXPECT_EQ(table.text(),
            "title\n"
            "name    n\n"
            "------  --\n"
            "a       1\n"
            "longer  22\n");
}

TEST(Table, NumbersAreAlignedToTheRight) {
  Table table("", {"name", "value"});
  table.align_right_from(1);
  table.add_row({"a", "1"});
  table.add_row({"b", "1234567"});
  EXPECT_EQ(table.text(),
            "name    value\n"
            "----  -------\n"
            "a           1\n"
            "b     1234567\n");
}

TEST(Table, CountsCharactersAndNotBytes) {
  EXPECT_EQ(character_count("20–45°"), 6u);  // nine bytes
  Table table("", {"x", "y"});
  table.add_row({"–°", "1"});
  table.add_row({"ab", "1"});
  EXPECT_EQ(table.text(), "x   y\n--  -\n–°  1\nab  1\n");
}

TEST(Table, ALongLastColumnWraps) {
  Table table("", {"name", "meaning"});
  std::string meaning;
  for (int k = 0; k < 40; ++k) meaning += std::string(k == 0 ? "" : " ") + "seventeen-letters";
  table.add_row({"a", meaning});
  table.add_row({"b", "short"});
  const auto longest = [&] {
    std::istringstream lines(table.text());
    std::size_t most = 0;
    for (std::string line; std::getline(lines, line);) most = std::max(most, line.size());
    return most;
  };
  EXPECT_GT(longest(), 700u) << "cells are whole unless asked for";
  table.wrap_last();
  EXPECT_LE(longest(), kLineMax);
  EXPECT_NE(table.text().find("\n      seventeen-letters"), std::string::npos) << "under its own column";
  EXPECT_NE(table.text().find("\nb     short\n"), std::string::npos);
  EXPECT_NE(table.markdown().find(meaning), std::string::npos) << "other formats have no lines";
}

TEST(Table, MissingCellsAreEmptyAndSurplusOnesRefused) {
  Table table("", {"x", "y"});
  table.add_row({"a"});
  EXPECT_EQ(table.text(), "x  y\n-  -\na\n");
  EXPECT_THROW(table.add_row({"1", "2", "3"}), std::logic_error);
}

TEST(Table, IsTextInEveryFormatWhateverItHolds) {
  Table table("a|b\nc", {"name_of", "n"});
  table.align_right_from(1);
  table.add_row({"<b>_x_</b>|`\n", "1,5"});
  table.add_row({"50 % & \\ {$#^~}", "\"q\""});
  EXPECT_EQ(table.markdown(),
            "**a\\|b c**\n\n"
            "| name_of | n |\n"
            "| --- | ---: |\n"
            "| \\<b\\>\\_x\\_\\</b\\>\\|\\`  | 1,5 |\n"
            "| 50 % \\& \\\\ {$\\#^\\~} | \"q\" |\n");
  EXPECT_EQ(table.csv(),
            "# a|b c\n"
            "name_of,n\n"
            "\"<b>_x_</b>|`\n\",\"1,5\"\n"
            "50 % & \\ {$#^~},\"\"\"q\"\"\"\n");
  EXPECT_EQ(table.tex(),
            "% a|b c\n"
            "\\begin{tabular}{lr}\n\\toprule\n"
            "name\\_of & n \\\\\n\\midrule\n"
            "$<$b$>$\\_x\\_$<$/b$>$|`  & 1,5 \\\\\n"
            "50 \\% \\& \\textbackslash{} \\{\\$\\#\\textasciicircum{}\\textasciitilde{}\\} & \"q\" \\\\\n"
            "\\bottomrule\n\\end{tabular}\n");
}

TEST(NumberText, HasFourSignificantDigits) {
  EXPECT_EQ(number_text(0.0), "0");
  EXPECT_EQ(number_text(1.0 / 3.0), "0.3333");
  EXPECT_EQ(number_text(-12345.6), "-1.235e+04");
  EXPECT_EQ(number_text(std::numeric_limits<double>::quiet_NaN()), "-");
  EXPECT_EQ(number_text(-std::numeric_limits<double>::infinity()), "-inf");
}

scenarios::Outcome outcome(scenarios::Kind kind, const std::string& method, scenarios::OutcomeStatus status,
                           std::vector<scenarios::Score> scores) {
  return testing::hill_outcome(7, kind, method, status, std::move(scores));
}

TEST(ScoreTables, HaveARowPerMetricAndAColumnPerMethod) {
  const std::vector<scenarios::Outcome> outcomes = {
      outcome(scenarios::Kind::rate, "raw", scenarios::OutcomeStatus::ok, {{"error", 2.5}, {"cost", 0.1}}),
      outcome(scenarios::Kind::rate, "saave", scenarios::OutcomeStatus::diverged, {{"error", 0.5}}),
      outcome(scenarios::Kind::slam, "icp", scenarios::OutcomeStatus::ok, {{"overlap", 0.9}})};
  const std::vector<Table> tables = score_tables("hill, seed 7", outcomes);
  ASSERT_EQ(tables.size(), 2u);
  EXPECT_EQ(tables[0].text(),
            "hill, seed 7: rate\n"
            "metric  raw     saave\n"
            "------  ---  --------\n"
            "status   ok  diverged\n"
            "error   2.5       0.5\n"
            "cost    0.1\n");
  EXPECT_EQ(overall_status(outcomes), "diverged");
  const std::vector<Table> said = score_tables("t", std::span(outcomes).last(1), "partial");
  EXPECT_EQ(said.at(0).text(), "t: slam\nmetric       icp\n-------  -------\nstatus   partial\noverlap      0.9\n");
}

TEST(ScoreTables, RowsInJsonCarryWhatTheDatabaseDoes) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<scenarios::Outcome> outcomes = {
      outcome(scenarios::Kind::rate, "raw", scenarios::OutcomeStatus::ok, {{"error", 2.5}, {"bad", nan}})};
  const nlohmann::json rows = score_rows(outcomes);
  ASSERT_EQ(rows.size(), 2u);
  EXPECT_EQ(rows[0].dump(),
            R"({"kind":"rate","method":"raw","metric":"error","scenario":"hill","seed":7,"status":"ok","value":2.5})");
  EXPECT_TRUE(rows[1]["value"].is_null()) << "JSON has no NaN: " << rows[1].dump();
}

}  // namespace
}  // namespace tumble::tools
