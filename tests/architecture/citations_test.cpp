// SPDX-License-Identifier: BSD-3-Clause
// Sources cite the equations of docs/maths as "mapping.md (R5)" or "mapping.md (R5), (R7)": every such equation stands
// there, under its number, at the end of a line; every note is cited by the code that it derives.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/tree.hpp"

namespace {

namespace fs = std::filesystem;

/// Name of a note -> the numbers of the equations that it defines.
using Notes = std::map<std::string, std::set<std::string>>;

struct Citation {
  std::string note, equation;
};

std::string text_of(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file).rdbuf();
  return out.str();
}

std::set<std::string> defined_in(const std::string& text) {
  static const std::regex number(R"(\(([A-Z]{1,2}[0-9]+)\)\s*$)");
  std::set<std::string> out;
  std::istringstream lines(text);
  std::smatch match;
  for (std::string line; std::getline(lines, line);)
    if (std::regex_search(line, match, number)) out.insert(match[1]);
  return out;
}

/// Comments run over lines: the marks at their beginnings are no part of a citation.
std::vector<Citation> cited_in(const std::string& source) {
  static const std::regex line_break(R"(\s*\n\s*(///<?|//)?\s*)"), number(R"(\(([A-Z]{1,2}[0-9]+)\))");
  static const std::regex citation(R"(\b([a-z_]+\.md) ((?:\([A-Z]{1,2}[0-9]+\)(?:, | and | to )?)+))");
  const std::string text = std::regex_replace(source, line_break, " ");
  std::vector<Citation> out;
  for (std::sregex_iterator it(text.begin(), text.end(), citation), end; it != end; ++it) {
    const std::string numbers = (*it)[2];
    for (std::sregex_iterator n(numbers.begin(), numbers.end(), number); n != end; ++n)
      out.push_back({(*it)[1], (*n)[1]});
  }
  return out;
}

/// What is wrong with a citation; empty when nothing is.
std::string complaint(const Citation& citation, const Notes& notes) {
  const auto note = notes.find(citation.note);
  if (note == notes.end()) return "there is no docs/maths/" + citation.note;
  if (!note->second.contains(citation.equation))
    return "docs/maths/" + citation.note + " has no equation (" + citation.equation + ")";
  return {};
}

Notes notes_of_the_tree() {
  Notes out;
  for (const auto& entry : fs::directory_iterator(tumble::test::source_dir() / "docs" / "maths"))
    if (entry.path().extension() == ".md") out[entry.path().filename()] = defined_in(text_of(entry.path()));
  return out;
}

std::vector<fs::path> sources_with_equations() {
  std::vector<fs::path> out;
  for (const char* folder : {"estimator", "scenarios/baselines", "scenarios/statistics", "scenarios/summary"})
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder))
      if (entry.path().extension() == ".cpp" || entry.path().extension() == ".hpp") out.push_back(entry.path());
  return out;
}

TEST(Citations, EveryCitedEquationIsThereAndEveryNoteIsCited) {
  const Notes notes = notes_of_the_tree();
  ASSERT_GE(notes.size(), 9u);
  std::set<std::string> cited;
  for (const fs::path& file : sources_with_equations()) {
    for (const Citation& citation : cited_in(text_of(file))) {
      EXPECT_EQ(complaint(citation, notes), "") << file;
      cited.insert(citation.note);
    }
  }
  for (const auto& [name, equations] : notes) {
    EXPECT_FALSE(equations.empty()) << name;
    EXPECT_TRUE(cited.contains(name)) << "no source cites " << name;
  }
}

TEST(Citations, CheckerFindsWhatIsMissing) {
  const Notes notes = {{"mapping.md", defined_in("p = 1   (R1)\nsee (R2) here\nq = 2 (R3)  \n")}};
  EXPECT_EQ(notes.at("mapping.md"), (std::set<std::string>{"R1", "R3"}));
  const auto found = cited_in("/// By mapping.md (R1),\n  /// (R3) and (R2); rolling.md (R1).");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(complaint(found[0], notes), "");
  EXPECT_EQ(complaint(found[1], notes), "");
  EXPECT_NE(complaint(found[2], notes), "") << "(R2) is mentioned there, not defined";
  EXPECT_NE(complaint(found[3], notes), "") << "no such note";
}

}  // namespace
