// SPDX-License-Identifier: BSD-3-Clause
// What is added by a file and a line of registration: the line that was forgotten. Each function that a header of such
// a list declares is called where the list is made.
#include <gtest/gtest.h>

#include <regex>
#include <string>
#include <vector>

#include "tests/architecture/text_of.hpp"
#include "tests/tree.hpp"

namespace {

struct Registry {
  std::string header, returns;  ///< functions of this result
  std::string arguments;        ///< and of these arguments: one that takes more makes entries for others
  std::string list;             ///< the source that has to name each of them
  std::size_t least;            ///< so many there are at least, or they are not found
};

std::vector<std::string> declared(const std::string& text, const std::string& returns, const std::string& arguments) {
  const std::regex function("(?:^|\n)" + returns + R"( ([a-z0-9_]+)\()" + arguments + R"(\);)");
  std::vector<std::string> out;
  for (std::sregex_iterator it(text.begin(), text.end(), function), end; it != end; ++it) out.push_back((*it)[1]);
  return out;
}

std::vector<std::string> left_out(const std::vector<std::string>& names, const std::string& list) {
  std::vector<std::string> out;
  for (const std::string& name : names) {
    if (!std::regex_search(list, std::regex("\\b" + name + "\\b"))) out.push_back(name);
  }
  return out;
}

TEST(Registration, NothingThatIsDeclaredIsLeftOut) {
  const std::vector<Registry> registries = {
      {"scenarios/methods/registry.hpp", "Method", "", "scenarios/methods/registry.cpp", 30},
      {"scenarios/methods/slam_registry.hpp", "Method", "", "scenarios/methods/registry.cpp", 8},
      {"scenarios/scoring/families.hpp", "std::vector<Metric>", "(?:Kind kind)?", "scenarios/scoring/score.cpp", 9},
      {"sim/world/world_type.hpp", "const WorldType&", "", "sim/world/world_type.cpp", 7},
      {"sim/robot/robot_type.hpp", "const RobotType&", "", "sim/robot/robot_type.cpp", 3},
      {"sim/motion/motion_type.hpp", "const MotionType&", "", "sim/motion/motion_type.cpp", 7},
      {"tools/tumble/verbs.hpp", "Action", "[^;{]*", "tools/tumble/verbs.cpp", 15},
  };
  for (const Registry& registry : registries) {
    const std::vector<std::string> names = declared(tumble::test::text_of(tumble::test::source_dir() / registry.header),
                                                    registry.returns, registry.arguments);
    EXPECT_GE(names.size(), registry.least) << registry.header;
    EXPECT_EQ(left_out(names, tumble::test::text_of(tumble::test::source_dir() / registry.list)),
              std::vector<std::string>())
        << registry.header << " declares what " << registry.list << " does not name";
  }
}

TEST(Registration, CheckerFindsTheForgottenLine) {
  const std::vector<std::string> names = declared(
      "/// One.\nMethod rate_one();\nMethod rate_two();  // two\nMethod made(int n);\nint other();\n", "Method", "");
  EXPECT_EQ(names, (std::vector<std::string>{"rate_one", "rate_two"}));
  EXPECT_EQ(left_out(names, "all = { rate_one(), rate_two_more() }"), std::vector<std::string>{"rate_two"});
}

}  // namespace
