// SPDX-License-Identifier: BSD-3-Clause
// The test compares the list of public headers in estimator/README.md with the folders. Other installed headers are in
// folders called detail; programs for users do not include them.
#include "tests/testing.hpp"
#include "tests/tree.hpp"

namespace {

using tumble::test::read_file;
using Names = std::set<std::string>;

/// Returns all matches of the first group of a pattern.
Names found_in(const std::string& text, const char* pattern) {
  const std::regex wanted(pattern);
  Names out;
  for (std::sregex_iterator it(text.begin(), text.end(), wanted), end; it != end; ++it) out.insert((*it)[1]);
  return out;
}

/// Returns the headers that the README lists.
Names listed(const std::string& readme) {
  return found_in(readme, R"(`((?:[a-z_0-9]+/)?[a-z_0-9]+\.hpp)`)");
}

std::vector<fs::path> public_headers() {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / "estimator/include/tumble"))
    if (entry.path().extension() == ".hpp") out.push_back(entry.path());
  return out;
}

/// Returns the headers outside of folders called detail.
Names open_headers() {
  Names out;
  for (const fs::path& header : public_headers()) {
    const fs::path path = fs::relative(header, tumble::test::source_dir() / "estimator/include/tumble");
    if (path.parent_path().filename() != "detail") out.insert(path.generic_string());
  }
  return out;
}

/// Returns the includes of a user's program that are not public: headers in detail, and missing headers.
Names unlisted_includes(const std::string& source, const Names& list) {
  Names out;
  for (const std::string& header : found_in(source, R"re(#\s*include\s*[<"]tumble/([^>"]+)[>"])re"))
    if (!list.contains(header)) out.insert(header);
  return out;
}

TEST(PublicHeaders, AreThoseThatTheReadmeLists) {
  const Names list = listed(read_file(tumble::test::source_dir() / "estimator/README.md"));
  EXPECT_EQ(open_headers(), list);
  EXPECT_LE(list.size(), 14u);
  // negative controls
  EXPECT_TRUE(listed("| `src/mapping/README.md` | a `detail` folder |").empty());
  EXPECT_EQ(listed("| `tumble.hpp` `common/types.hpp` |"), (Names{"tumble.hpp", "common/types.hpp"}));
}

/// kCodeLinesMax is the largest number of lines of code in a public header. Documentation does not count, because a
/// limit would shorten it.
constexpr std::ptrdiff_t kCodeLinesMax = 150;

std::ptrdiff_t code_lines(const std::string& text) {
  std::istringstream lines(text);
  std::ptrdiff_t out = 0;
  for (std::string line; std::getline(lines, line);) {
    const std::size_t first = line.find_first_not_of(' ');
    out += first != std::string::npos && line.compare(first, 2, "//") != 0 ? 1 : 0;
  }
  return out;
}

TEST(PublicHeaders, AreReadInOneGo) {
  const fs::path folder = tumble::test::source_dir() / "estimator/include/tumble";
  for (const std::string& header : open_headers())
    EXPECT_LE(code_lines(read_file(folder / header)), kCodeLinesMax) << header;
  EXPECT_EQ(code_lines("int a;\n\n  // text\n  int b;  // text\n"), 2) << "negative control";
}

TEST(PublicHeaders, IncludeNothingThatIsNotInstalled) {
  std::size_t includes = 0;
  for (const fs::path& header : public_headers()) {
    for (const std::string& own : found_in(read_file(header), R"re(#\s*include\s*"([^"]+)")re")) {
      ++includes;
      EXPECT_TRUE(fs::exists(tumble::test::source_dir() / "estimator/include" / own)) << header << " includes " << own;
    }
  }
  EXPECT_GT(includes, 100u);
}

/// Adds a header and all headers of the library that it includes to `reached`.
void collect(const std::string& header, Names& reached) {
  if (!reached.insert(header).second) return;
  const std::string text = read_file(tumble::test::source_dir() / "estimator/include/tumble" / header);
  for (const std::string& included : found_in(text, R"re(#\s*include\s*"tumble/([^"]+)")re"))
    collect(included, reached);
}

TEST(PublicHeaders, OfMostRobotsAreFewAndReachNoDetail) {
  Names reached;
  collect("tumble.hpp", reached);
  EXPECT_LE(reached.size(), 9u);
  EXPECT_GT(reached.size(), 5u) << "the scan found too few headers to mean anything";
  EXPECT_EQ(std::count_if(reached.begin(), reached.end(),
                          [](const std::string& header) { return header.find("detail/") != std::string::npos; }),
            0);
  Names of_experts;
  collect("odometry/expert_params.hpp", of_experts);
  EXPECT_GT(of_experts.size(), 20u) << "negative control";
}

TEST(PublicHeaders, AreAllThatProgramsForAUserInclude) {
  const Names list = listed(read_file(tumble::test::source_dir() / "estimator/README.md"));
  std::size_t programs = 0;
  for (const char* folder : {"examples", "tests/install/consumer"}) {
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      ++programs;
      EXPECT_EQ(unlisted_includes(read_file(entry.path()), list), Names{}) << entry.path();
    }
  }
  EXPECT_GT(programs, 6u);
  // negative control
  EXPECT_EQ(
      unlisted_includes("#include \"tumble/common/detail/scalar_update.hpp\"\n#include <tumble/tumble.hpp>\n", list),
      Names{"common/detail/scalar_update.hpp"});
}

}  // namespace
