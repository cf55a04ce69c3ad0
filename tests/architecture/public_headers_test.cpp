// SPDX-License-Identifier: BSD-3-Clause
// What a user of the library may include: the list in estimator/README.md, held to the folders. All else that is
// installed stands in folders called detail, and no program for a user includes it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "tests/architecture/text_of.hpp"
#include "tests/tree.hpp"

namespace {

namespace fs = std::filesystem;
using tumble::test::text_of;
using Names = std::set<std::string>;

/// What the first group of a pattern finds.
Names found_in(const std::string& text, const char* pattern) {
  const std::regex wanted(pattern);
  Names out;
  for (std::sregex_iterator it(text.begin(), text.end(), wanted), end; it != end; ++it) out.insert((*it)[1]);
  return out;
}

/// Headers that the README lists.
Names listed(const std::string& readme) {
  return found_in(readme, R"(`((?:[a-z_0-9]+/)?[a-z_0-9]+\.hpp)`)");
}

std::vector<fs::path> public_headers() {
  std::vector<fs::path> out;
  for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / "estimator/include/tumble"))
    if (entry.path().extension() == ".hpp") out.push_back(entry.path());
  return out;
}

/// Headers that stand outside of folders called detail.
Names open_headers() {
  Names out;
  for (const fs::path& header : public_headers()) {
    const fs::path path = fs::relative(header, tumble::test::source_dir() / "estimator/include/tumble");
    if (path.parent_path().filename() != "detail") out.insert(path.generic_string());
  }
  return out;
}

/// Includes of a user's program that are none of his business: of detail, or of no header there is.
Names unlisted_includes(const std::string& source, const Names& list) {
  Names out;
  for (const std::string& header : found_in(source, R"re(#\s*include\s*[<"]tumble/([^>"]+)[>"])re"))
    if (!list.contains(header)) out.insert(header);
  return out;
}

TEST(PublicHeaders, AreThoseThatTheReadmeLists) {
  const Names list = listed(text_of(tumble::test::source_dir() / "estimator/README.md"));
  EXPECT_EQ(open_headers(), list);
  EXPECT_LT(list.size(), 59u) << "fewer than there were without a door";
  // negative controls
  EXPECT_TRUE(listed("| `src/mapping/README.md` | a `detail` folder |").empty());
  EXPECT_EQ(listed("| `tumble.hpp` `common/imu.hpp` |"), (Names{"tumble.hpp", "common/imu.hpp"}));
}

/// Public headers that may be longer than kLinesMax, with the reason. There is none.
const std::map<std::string, std::string> kLong = {};
constexpr std::ptrdiff_t kLinesMax = 150;

bool too_long(const std::string& header, const std::string& text) {
  return !kLong.contains(header) && std::count(text.begin(), text.end(), '\n') > kLinesMax;
}

TEST(PublicHeaders, AreReadInOneGo) {
  const fs::path folder = tumble::test::source_dir() / "estimator/include/tumble";
  for (const std::string& header : open_headers()) EXPECT_FALSE(too_long(header, text_of(folder / header))) << header;
  for (const auto& [header, reason] : kLong) EXPECT_TRUE(open_headers().contains(header)) << header << ": " << reason;
  // negative control
  EXPECT_FALSE(too_long("a.hpp", std::string(150, '\n')));
  EXPECT_TRUE(too_long("a.hpp", std::string(151, '\n')));
}

TEST(PublicHeaders, IncludeNothingThatIsNotInstalled) {
  std::size_t includes = 0;
  for (const fs::path& header : public_headers()) {
    for (const std::string& own : found_in(text_of(header), R"re(#\s*include\s*"([^"]+)")re")) {
      ++includes;
      EXPECT_TRUE(fs::exists(tumble::test::source_dir() / "estimator/include" / own)) << header << " includes " << own;
    }
  }
  EXPECT_GT(includes, 100u);
}

TEST(PublicHeaders, AreAllThatProgramsForAUserInclude) {
  const Names list = listed(text_of(tumble::test::source_dir() / "estimator/README.md"));
  std::size_t programs = 0;
  for (const char* folder : {"examples", "tests/install/consumer"}) {
    for (const auto& entry : fs::recursive_directory_iterator(tumble::test::source_dir() / folder)) {
      if (entry.path().extension() != ".cpp" && entry.path().extension() != ".hpp") continue;
      ++programs;
      EXPECT_EQ(unlisted_includes(text_of(entry.path()), list), Names{}) << entry.path();
    }
  }
  EXPECT_GT(programs, 6u);
  // negative control
  EXPECT_EQ(
      unlisted_includes("#include \"tumble/common/detail/scalar_update.hpp\"\n#include <tumble/tumble.hpp>\n", list),
      Names{"common/detail/scalar_update.hpp"});
}

}  // namespace
