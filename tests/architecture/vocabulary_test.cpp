// SPDX-License-Identifier: BSD-3-Clause
// The test rejects names and words that terms of the field have replaced: names anywhere in the tree, and words in the
// documents that users read first.
#include <cctype>

#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

using tumble::test::read_file;

/// No name may contain these words; docs/glossary.md lists the terms of the field.
constexpr std::array kReplaced = {"companion", "excess", "stretch", "stretches", "surprise"};

/// These names may not appear anywhere.
constexpr std::array kReplacedNames = {"CarriedWay", "GravityTurn", "GravityTurningParams", "kPartialInContact",
                                       "kVoid",      "PartialLoss", "PublishedTraps",       "SeedMapper",
                                       "SeedParams", "SensorPlace", "TurnWindows",          "TurnHypotheses"};

/// These words have a private meaning that a new reader cannot understand.
const std::regex kPrivateWords(
    R"(\b(anew|whoever|somebody|anybody|dearest|mended|bears? out|borne out|told|tells|hears?|heard|doubted|believed|begins anew|of which|by itself|of its own|so many|the like|last word|carried body|is none|are none|nobody|the door)\b)",
    std::regex::icase);

bool is_of_a_name(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Returns all names of a text, also from comments and strings.
std::set<std::string> names_in(const std::string& text) {
  std::set<std::string> out;
  for (auto at = text.begin(); at != text.end();) {
    const auto first = std::find_if(at, text.end(), is_of_a_name);
    at = std::find_if_not(first, text.end(), is_of_a_name);
    if (first != at) out.emplace(first, at);
  }
  return out;
}

/// Returns the words of a name: kOldWord_rad_s consists of k, old, word, rad, s.
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

enum class Text { prose, script, source };  ///< strings of a script count like its comments

/// Replaced names in a text. A replaced word counts only as a part of a name, because in comments and strings it is a
/// plain word.
std::vector<std::string> replaced_names(const std::string& text, Text kind) {
  static const std::regex comment(R"(//[^\n]*|#[^\n]*)"), string(R"("([^"\\\n]|\\.)*")");
  std::set<std::string> out;
  for (const std::string& name : names_in(text)) {
    const bool given = std::find(kReplacedNames.begin(), kReplacedNames.end(), name) != kReplacedNames.end();
    if (given) out.insert(name);
  }
  const auto add = [&](const std::string& code, std::size_t words_least) {
    for (const std::string& name : names_in(code)) {
      const std::set<std::string> words = words_of(name);
      const bool given =
          std::any_of(kReplaced.begin(), kReplaced.end(), [&](const char* word) { return words.contains(word); });
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

TEST(Vocabulary, ReplacedNamesDoNotReturn) {
  const fs::path root = tumble::test::source_dir();
  std::size_t read = 0;
  for (const char* folder :
       {"docs", "estimator", "examples", "models", "peers", "python", "ros", "scenarios", "sim", "tests", "tools"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      const Text kind = kind_of(extension);
      if (kind == Text::prose && extension != ".md" && extension != ".yaml" && extension != ".ipynb") continue;
      if (entry.path().filename() == "vocabulary_test.cpp") continue;
      EXPECT_EQ(replaced_names(read_file(entry.path()), kind), std::vector<std::string>{}) << entry.path();
      ++read;
    }
  }
  EXPECT_GT(read, 500u) << "the scan found too little to mean anything";
}

TEST(Vocabulary, AReplacedNameIsFound) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(replaced_names("the excess, to my surprise", Text::prose), Words{});
  EXPECT_EQ(replaced_names("struct Stretch { double kStretch_s; };", Text::source), (Words{"Stretch", "kStretch_s"}));
  EXPECT_EQ(replaced_names("health[\"excess_a\"] = f(\"in excess\");  // no excess_b", Text::source),
            Words{"excess_a"});
  EXPECT_EQ(replaced_names("excess_rad_s = 1  # in excess_b\n", Text::script), Words{"excess_rad_s"});
  EXPECT_EQ(replaced_names("a `GravityTurn`, in turn", Text::prose), Words{"GravityTurn"});
  EXPECT_EQ(replaced_names("int outstretched = stretched_to;", Text::source), Words{});
}

/// Returns the lines of a document that contain a private word, except code blocks.
std::vector<std::string> private_words(const std::string& text) {
  std::vector<std::string> out;
  std::istringstream lines(text);
  bool code = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with("```")) code = !code;
    if (!code && std::regex_search(line, kPrivateWords)) out.push_back(line);
  }
  return out;
}

TEST(Vocabulary, WhatUsersReadFirstHasNoPrivateWords) {
  const fs::path root = tumble::test::source_dir();
  std::vector<fs::path> read = {root / "README.md", root / "CONTRIBUTING.md"};
  for (const char* folder : {"docs", "estimator/include"}) {
    for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
      const std::string extension = entry.path().extension().string();
      if (extension == ".md" || extension == ".hpp") read.push_back(entry.path());
    }
  }
  EXPECT_GT(read.size(), 100u) << "the scan found too little to mean anything";
  for (const fs::path& file : read) EXPECT_EQ(private_words(read_file(file)), std::vector<std::string>{}) << file;
  EXPECT_EQ(private_words("a stamp\n```\nit tells\n```\nit Tells\n").size(), 1u) << "negative control";
}

}  // namespace
