// SPDX-License-Identifier: BSD-3-Clause
// The report is a function of results: the test checks that its sources name no scenario, no method and no metric.
#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "scenarios/scoring/score.hpp"
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace tumble::tools {
namespace {

/// Returns names as the registries and the catalogue have them; the program has the name of a method.
std::set<std::string> known_names() {
  std::set<std::string> names;
  for (const std::string& name : scenarios::scenario_names({test::source_dir()})) names.insert(name);
  for (const scenarios::Method& method : scenarios::methods()) names.insert(method.info.name);
  for (const scenarios::Metric& metric : scenarios::metrics()) names.insert(metric.info.name);
  names.erase("tumble");
  return names;
}

/// Returns the words of string literals that are one of the names; include paths do not count.
std::set<std::string> names_in(const std::string& source, const std::set<std::string>& names) {
  static const std::regex literal(R"re("((?:[^"\\\n]|\\.)*)")re");
  static const std::regex word("[A-Za-z0-9_]+");
  const std::string text = std::regex_replace(source, std::regex("#include[^\n]*"), "");
  std::set<std::string> found;
  for (std::sregex_iterator at(text.begin(), text.end(), literal), end; at != end; ++at) {
    // a sentence may contain a name that is also an English word: only a name alone or among punctuation counts
    const std::string content = (*at)[1];
    if (content.find(' ') != std::string::npos && content.find("<code>") == std::string::npos) continue;
    for (std::sregex_iterator each(content.begin(), content.end(), word); each != end; ++each)
      if (names.contains(each->str())) found.insert(each->str());
  }
  return found;
}

TEST(ReportSources, NameNoScenarioNoMethodAndNoMetric) {
  const std::set<std::string> names = known_names();
  ASSERT_GT(names.size(), 80u) << "too few to mean anything";
  std::size_t files = 0;
  for (const auto& entry : fs::directory_iterator(test::source_dir() / "tools" / "report")) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".cpp" && extension != ".hpp") continue;
    ++files;
    EXPECT_EQ(names_in(test::read_file(entry.path()), names), std::set<std::string>{}) << entry.path();
  }
  EXPECT_GT(files, 10u);
  // negative controls
  EXPECT_EQ(names_in("if (name == \"raw\")", names), std::set<std::string>{"raw"});
  EXPECT_EQ(names_in("x = \"slam/icp_raw\";", names), std::set<std::string>{"icp_raw"});
  EXPECT_EQ(names_in("\"of <code>map_failed</code> the share\"", names), std::set<std::string>{"map_failed"});
  EXPECT_TRUE(names_in("#include \"scenarios/hill\"\n\"hills roll\"", names).empty());
}

}  // namespace
}  // namespace tumble::tools
