// SPDX-License-Identifier: BSD-3-Clause
// Sources cite the equations of docs/maths as "mapping.md (R5)" or "mapping.md (R5), (R7)". The test checks that each
// cited equation exists once, at the end of an indented line, and that the code cites every note. The test also checks
// that the files named in CONTRIBUTING exist.
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

using tumble::test::read_file;

/// Notes maps the name of a note to the numbers of the equations that it defines.
using Notes = std::map<std::string, std::set<std::string>>;

struct Citation {
  std::string note, equation;
};

/// A line of prose that ends in a number only mentions an equation; equations of a note are indented.
std::multiset<std::string> definitions_in(const std::string& text) {
  static const std::regex number(R"(^    .*\(([A-Z]{1,2}[0-9]+[a-z]?)\)\s*$)");
  std::multiset<std::string> out;
  std::istringstream lines(text);
  std::smatch match;
  for (std::string line; std::getline(lines, line);)
    if (std::regex_search(line, match, number)) out.insert(match[1]);
  return out;
}

std::set<std::string> defined_in(const std::string& text) {
  const std::multiset<std::string> all = definitions_in(text);
  return {all.begin(), all.end()};
}

/// Returns the numbers that two equations have.
std::set<std::string> defined_twice(const std::string& text) {
  const std::multiset<std::string> all = definitions_in(text);
  std::set<std::string> out;
  for (const std::string& number : all)
    if (all.count(number) > 1) out.insert(number);
  return out;
}

/// Returns the citations "note.md (S1), (S2)" and "(S1) and (S2) of note.md". Comments continue over lines, so the
/// comment marks are removed first.
std::vector<Citation> cited_in(const std::string& source) {
  static const std::regex line_break(R"(\s*\n\s*(///<?|//)?\s*)"), number(R"(\(([A-Z]{1,2}[0-9]+[a-z]?)\))");
  static const std::string numbers = R"(((?:\([A-Z]{1,2}[0-9]+[a-z]?\)(?:, | and | to )?)+))",
                           note = R"(\b([a-z_]+\.md))";
  static const std::regex note_first(note + " " + numbers), number_first(numbers + " of " + note);
  const std::string text = std::regex_replace(source, line_break, " ");
  std::vector<Citation> out;
  const auto add = [&](const std::string& cited_note, const std::string& cited) {
    for (std::sregex_iterator n(cited.begin(), cited.end(), number), end; n != end; ++n)
      out.push_back({cited_note, (*n)[1]});
  };
  for (std::sregex_iterator it(text.begin(), text.end(), note_first), end; it != end; ++it) add((*it)[1], (*it)[2]);
  for (std::sregex_iterator it(text.begin(), text.end(), number_first), end; it != end; ++it) add((*it)[2], (*it)[1]);
  return out;
}

/// Returns the fault of a citation, or an empty text.
std::string complaint(const Citation& citation, const Notes& notes) {
  const auto note = notes.find(citation.note);
  if (note == notes.end()) return "there is no docs/maths/" + citation.note;
  if (!note->second.contains(citation.equation))
    return "docs/maths/" + citation.note + " has no equation (" + citation.equation + ")";
  return {};
}

Notes notes_of_the_tree() {
  Notes out;
  for (const auto& entry : fs::directory_iterator(tumble::test::source_dir() / "docs" / "maths")) {
    if (entry.path().extension() != ".md") continue;
    const std::string text = read_file(entry.path());
    EXPECT_EQ(defined_twice(text), std::set<std::string>()) << entry.path();
    out[entry.path().filename()] = defined_in(text);
  }
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
    for (const Citation& citation : cited_in(read_file(file))) {
      EXPECT_EQ(complaint(citation, notes), "") << file;
      cited.insert(citation.note);
    }
  }
  for (const auto& [name, equations] : notes) {
    EXPECT_FALSE(equations.empty()) << name;
    EXPECT_TRUE(cited.contains(name)) << "no source cites " << name;
  }
}

/// Returns files, named with their folder in backticks, that the tree lacks.
std::vector<std::string> absent_files(const std::string& text) {
  static const std::regex named(R"(`([A-Za-z0-9_.]+/[A-Za-z0-9_./]+\.(cpp|hpp|md|yaml|txt|py|csv|sh)(:[0-9]+)?)`)");
  static const std::regex stands_for_a_name(R"([A-Z]{4,})");  // NAME, KIND, DEVICE
  const fs::path root = tumble::test::source_dir();
  std::vector<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), named), end; it != end; ++it) {
    const std::string name = (*it)[1];
    // a header of the library is named as it is included, and a module of the package as it is imported
    if (!std::regex_search(name, stands_for_a_name) && !fs::exists(root / name) &&
        !fs::exists(root / "estimator" / "include" / name) && !fs::exists(root / "python" / "src" / name))
      out.push_back(name);
  }
  return out;
}

TEST(Citations, FilesThatContributingNamesAreThere) {
  std::string text = read_file(tumble::test::source_dir() / "CONTRIBUTING.md");
  ASSERT_FALSE(text.empty());
  for (const auto& page : fs::directory_iterator(tumble::test::source_dir() / "docs/how_to")) text += read_file(page);
  EXPECT_EQ(absent_files(text), std::vector<std::string>());
  EXPECT_EQ(absent_files("in `docs/design.md`, `scenarios/absent.cpp` and `tests/tree.hpp:12`"),
            (std::vector<std::string>{"scenarios/absent.cpp", "tests/tree.hpp:12"}))
      << "lines move, names stay";
}

TEST(Citations, CheckerFindsWhatIsMissing) {
  const Notes notes = {
      {"mapping.md", defined_in("    p = 1   (R1)\nsee (R2) here, or\n(R2)\n    q = 2 (R3)  \n    s = 4 (R3a)\n")}};
  EXPECT_EQ(defined_twice("    p = 1 (R1)\n    q = 2 (R2)\nas (R2)\n    r = 3 (R1)\n"), std::set<std::string>{"R1"});
  EXPECT_EQ(notes.at("mapping.md"), (std::set<std::string>{"R1", "R3", "R3a"}));
  const auto found = cited_in("/// By mapping.md (R1),\n  /// (R3) and (R2); rolling.md (R1).");
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(cited_in("/// equations (R2) and\n/// (R7) of mapping.md").size(), 2u);
  EXPECT_EQ(complaint(found[0], notes), "");
  EXPECT_EQ(complaint(found[1], notes), "");
  EXPECT_NE(complaint(found[2], notes), "") << "(R2) is mentioned there, not defined";
  EXPECT_NE(complaint(found[3], notes), "") << "no such note";
  const auto lettered = cited_in("by mapping.md (R3a), (R3b)");
  ASSERT_EQ(lettered.size(), 2u);
  EXPECT_EQ(complaint(lettered[0], notes), "");
  EXPECT_NE(complaint(lettered[1], notes), "");
}

}  // namespace
