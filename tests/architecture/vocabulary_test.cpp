// SPDX-License-Identifier: BSD-3-Clause
// A word of ours that has given way to the field's does not come back: neither as a part of a name in the code, nor the
// names themselves, which stand in the table of old and new of CHANGELOG.md, anywhere.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/architecture/text_of.hpp"
#include "tests/tree.hpp"

namespace {

namespace fs = std::filesystem;
using tumble::test::text_of;

/// Words that no name has as a part any more; what each is called now: the glossary and CHANGELOG.md.
constexpr std::array kGiven = {"companion", "excess", "stretch", "stretches", "surprise", "thrust"};

/// Names of one word that mean nothing else: they come back nowhere either.
constexpr std::array kGivenNames = {"CarriedWay", "GravityTurn", "GravityTurningParams", "kPartialInContact",
                                    "kVoid",      "PartialLoss", "PublishedTraps",       "SeedMapper",
                                    "SeedParams", "SensorPlace", "TurnWindows",          "TurnHypotheses"};

/// Names with an underscore in the first column of the tables "was | is": those of one word may mean something else.
std::set<std::string> old_names(const std::string& changelog) {
  static const std::regex name(R"(`([A-Za-z]+(_[a-z0-9]+)+)`)");
  std::set<std::string> out;
  std::istringstream lines(changelog);
  bool within = false;
  for (std::string line; std::getline(lines, line);) {
    if (line == "| was | is |") within = true;
    if (!line.starts_with("|")) within = false;
    if (!within) continue;
    const std::string was = line.substr(0, line.find(" | "));
    for (std::sregex_iterator it(was.begin(), was.end(), name), end; it != end; ++it) out.insert((*it)[1]);
  }
  return out;
}

bool is_of_a_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// All names of a text, of comments and strings too.
std::set<std::string> names_in(const std::string& text) {
  std::set<std::string> out;
  for (auto at = text.begin(); at != text.end();) {
    const auto first = std::find_if(at, text.end(), is_of_a_name);
    at = std::find_if_not(first, text.end(), is_of_a_name);
    if (first != at) out.emplace(first, at);
  }
  return out;
}

/// The words of a name: kOldWord_rad_s is k, old, word, rad, s.
std::set<std::string> words_of(const std::string& name) {
  std::set<std::string> out;
  std::string word;
  const auto end = [&] {
    if (!word.empty()) out.insert(word);
    word.clear();
  };
  for (const char c : name) {
    const bool upper = c >= 'A' && c <= 'Z';
    if (c == '_' || upper) end();
    if (c != '_') word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  end();
  return out;
}

enum class Text { prose, script, source };  ///< a script's strings are its comments too

/// What of a text is named as it was once. In prose, and so in comments and strings, a word by itself is a word.
std::vector<std::string> come_back(const std::string& text, Text kind, const std::set<std::string>& old) {
  static const std::regex comment(R"(//[^\n]*|#[^\n]*)"), string(R"("([^"\\\n]|\\.)*")");
  std::set<std::string> out;
  for (const std::string& name : names_in(text)) {
    const bool given = std::find(kGivenNames.begin(), kGivenNames.end(), name) != kGivenNames.end();
    if (given || old.contains(name)) out.insert(name);
  }
  const auto add = [&](const std::string& code, std::size_t words_least) {
    for (const std::string& name : names_in(code)) {
      const std::set<std::string> words = words_of(name);
      const bool given =
          std::any_of(kGiven.begin(), kGiven.end(), [&](const char* word) { return words.contains(word); });
      if (given && words.size() >= words_least) out.insert(name);
    }
  };
  const std::string code = std::regex_replace(text, comment, "");
  if (kind != Text::prose) add(code, 2);
  if (kind == Text::source) add(std::regex_replace(code, string, ""), 1);
  return {out.begin(), out.end()};
}

Text kind_of(const std::string& extension) {
  if (extension == ".hpp" || extension == ".cpp") return Text::source;
  return extension == ".py" ? Text::script : Text::prose;
}

TEST(Vocabulary, WordsThatHaveGivenWayDoNotComeBack) {
  const fs::path root = tumble::test::source_dir();
  const std::set<std::string> old = old_names(text_of(root / "CHANGELOG.md"));
  ASSERT_GT(old.size(), 20u) << "the table of old and new was not found";
  std::size_t read = 0;
  for (const char* folder :
       {"docs", "estimator", "examples", "models", "peers", "python", "scenarios", "sim", "tests", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      const Text kind = kind_of(extension);
      if (kind == Text::prose && extension != ".md" && extension != ".yaml" && extension != ".ipynb") continue;
      if (entry.path().filename() == "vocabulary_test.cpp") continue;
      EXPECT_EQ(come_back(text_of(entry.path()), kind, old), std::vector<std::string>{}) << entry.path();
      ++read;
    }
  }
  EXPECT_GT(read, 500u) << "the scan found too little to mean anything";
}

TEST(Vocabulary, ANameThatComesBackIsFound) {
  const std::set<std::string> old = old_names(
      "| a_word | none |\n\n| was | is |\n| --- | --- |\n| `old_name`, `T::older_s`, `lone` | `new_name` |\n\n| `x_y` "
      "| |");
  EXPECT_EQ(old, (std::set<std::string>{"old_name"})) << "members and single words may mean something else";
  const auto found = [&](const char* text, Text kind) { return come_back(text, kind, old); };
  using Words = std::vector<std::string>;
  EXPECT_EQ(found("set `old_name` to 1, to my surprise", Text::prose), Words{"old_name"});
  EXPECT_EQ(found("double my_old_name = new_name;", Text::source), Words{});
  EXPECT_EQ(found("struct Stretch { double kStretch_s; };", Text::source), (Words{"Stretch", "kStretch_s"}));
  EXPECT_EQ(found("health[\"excess_a\"] = f(\"in excess\");  // no excess_b", Text::source), Words{"excess_a"});
  EXPECT_EQ(found("excess_rad_s = 1  # in excess_b\n", Text::script), Words{"excess_rad_s"});
  EXPECT_EQ(found("a `GravityTurn`, in turn", Text::prose), Words{"GravityTurn"});
  EXPECT_EQ(found("int outstretched = stretched_to;", Text::source), Words{});
}

}  // namespace
