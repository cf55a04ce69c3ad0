// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/evaluate.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/errors.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using ::testing::HasSubstr;

std::size_t applicable_of(Kind kind, const std::string& scenario) {
  std::vector<MethodPointer> all;
  for (const Method& method : methods()) all.push_back(unowned(method));
  const std::vector<MethodPointer> chosen =
      applicable(all, subject_of(load_scenario(DataRoot{test::source_dir()}, scenario)));
  return static_cast<std::size_t>(
      std::count_if(chosen.begin(), chosen.end(), [&](const auto& method) { return method->info.kind == kind; }));
}

std::string complaint(const std::string& method, const std::string& scenario) {
  try {
    require_applies(*find_methods(method).front(), load_scenario(DataRoot{test::source_dir()}, scenario));
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

// the wand and the pendulum of the catalogue have no lidar
TEST(Applicable, NoMapIsAskedForWhereThereIsNoLidar) {
  for (const char* scenario : {"twirl", "swing"}) {
    EXPECT_EQ(applicable_of(Kind::slam, scenario), 0u) << scenario;
    EXPECT_GE(applicable_of(Kind::rate, scenario), 5u) << scenario;
    EXPECT_GE(applicable_of(Kind::attitude, scenario), 3u) << scenario;
  }
  EXPECT_GE(applicable_of(Kind::slam, "hill"), 5u);
}

TEST(Applicable, WhatDoesNotApplySaysWhy) {
  EXPECT_THAT(complaint("slam/tumble", "twirl"), HasSubstr("needs a lidar, but the recording has none"));
  EXPECT_THAT(complaint("position/rolling", "hill"), HasSubstr("does not support the robot 'rig'"));
  EXPECT_EQ(complaint("slam/tumble", "hill"), "");
  EXPECT_EQ(complaint("rate/tumble", "twirl"), "");
}

// a recording that does not state its robot is valid for all methods
TEST(Applicable, AnUnknownRobotExcludesNothing) {
  EXPECT_TRUE(find_methods("position/rolling").front()->info.applies_to({"", true}));
  EXPECT_FALSE(find_methods("position/rolling").front()->info.applies_to({"rig", true}));
  EXPECT_FALSE(find_methods("slam/tumble").front()->info.applies_to({"", false}));
}

}  // namespace
}  // namespace tumble::scenarios
