// SPDX-License-Identifier: BSD-3-Clause
// The health of an estimate is output for users. The test checks that no method reads entries of the health.
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

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
  return tumble::test::read_file(tumble::test::source_dir() / file);
}

// An entry that is written without a failed check would not be reported.
TEST(Health, RowsOfFindingsAreWrittenByFindingsAlone) {
  const std::string own = "scenarios/estimates/findings.cpp";
  for (const char* row : {"\"imu_implausible\"", "\"localised\""}) {
    for (const std::string& file : harness_sources())
      EXPECT_EQ(text_of_source(file).find(row) != std::string::npos, file == own) << file << ": " << row;
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
