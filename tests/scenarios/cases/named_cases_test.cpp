// SPDX-License-Identifier: BSD-3-Clause
// Tests the named cases of the tree as files; tools/tumble/gate_cases.cpp runs them.
#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/cases/complication.hpp"
#include "scenarios/cases/hold_case.hpp"
#include "scenarios/draw/fixed_scenario.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

TEST(NamedCases, AreCompleteAndExpectWhatThereIs) {
  const DataRoot data{test::source_dir()};
  const std::vector<std::string> scenarios = scenario_names(data), names = case_names(data);
  EXPECT_FALSE(names.empty());
  for (const std::string& name : names) {
    EXPECT_FALSE(std::binary_search(scenarios.begin(), scenarios.end(), name)) << name << " is a scenario's name too";
    const Scenario scenario = load_scenario(data, name);
    EXPECT_NO_THROW(require_known(scenario)) << name;
    const Scenario drawn = load_scenario(data, scenario.named_case->scenario);
    const sim::ResolvedSituation situation = draw(data, scenario, scenario.named_case->seed);
    // the file contains every number of the draw, so later changes of data sheets and defaults have no effect
    EXPECT_EQ(to_yaml(fixed_as(scenario, situation)), to_yaml(scenario)) << name;
    EXPECT_LE(complications(scenario).size(),
              complications(fixed_as(drawn, draw(data, drawn, scenario.named_case->seed))).size())
        << name << " is no simpler than its draw";
  }
}

}  // namespace
}  // namespace tumble::scenarios
