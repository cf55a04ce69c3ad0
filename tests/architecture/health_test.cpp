// SPDX-License-Identifier: BSD-3-Clause
// The health of an estimate is output for users. The test checks that no method reads entries of the health.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tree.hpp"

namespace {

namespace fs = std::filesystem;

/// Returns the lines of a source that read an entry of an estimate's health.
std::vector<std::string> reads_of_health(const std::string& source) {
  static const std::regex asks(R"(health\s*\.\s*(contains|find|at|count)\s*\(|health\[[^\]]*\]\s*[;,)<>!&|?*/])");
  std::vector<std::string> out;
  std::istringstream lines(source);
  for (std::string line; std::getline(lines, line);) {
    if (std::regex_search(line, asks)) out.push_back(line);
  }
  return out;
}

/// Returns the sources of the harness by their path in the tree.
std::vector<std::string> harness_sources() {
  std::vector<std::string> out;
  for (const char* folder : {"scenarios", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".hpp" || extension == ".cpp")
        out.push_back(fs::relative(entry.path(), tumble::test::source_dir()).generic_string());
    }
  }
  return out;
}

std::string text_of_source(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(tumble::test::source_dir() / file).rdbuf();
  return text.str();
}

/// Returns the names of health entries that report failed checks, or the last parts of these names.
std::vector<std::string> rows_of_doubts(const std::string& source) {
  static const std::regex row(
      "\"((?:imu_|localised|rate_unit|force_unit|attitude_unknown|lidar_scale|learnt_rig|vertical|_[a-z])[a-z_]*)\"");
  std::vector<std::string> out;
  for (auto it = std::sregex_iterator(source.begin(), source.end(), row); it != std::sregex_iterator(); ++it)
    out.push_back("\"" + (*it)[1].str() + "\"");
  return out;
}

// An entry that is written without a failed check would not be reported.
TEST(Health, RowsOfDoubtsAreWrittenByDoubtsAlone) {
  const std::string own = "scenarios/methods/findings.cpp";
  const std::vector<std::string> rows = rows_of_doubts(text_of_source(own));
  EXPECT_EQ(rows.size(), 14u);
  for (const std::string& file : harness_sources()) {
    if (file == own) continue;
    const std::string text = text_of_source(file);
    for (const std::string& row : rows) EXPECT_EQ(text.find(row), std::string::npos) << file << ": " << row;
  }
}

TEST(Health, IsReadByNoStage) {
  std::size_t writers = 0;
  for (const std::string& file : harness_sources()) {
    const std::string text = text_of_source(file);
    writers += text.find("health[") != std::string::npos;
    EXPECT_EQ(reads_of_health(text), std::vector<std::string>{}) << file;
  }
  EXPECT_GT(writers, 10u) << "the scan found too little to mean anything";
  // negative control
  EXPECT_EQ(reads_of_health("health[\"imus\"] = 1.0;\nestimate.health[\"a\"] += 1.0;\n"), std::vector<std::string>{});
  for (const char* line :
       {"if (estimate.health.contains(\"a\")) f();", "x = out.health.at(kName);", "g(health[\"a\"]);"})
    EXPECT_EQ(reads_of_health(line), std::vector<std::string>{line});
}

}  // namespace
