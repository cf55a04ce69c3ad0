// SPDX-License-Identifier: BSD-3-Clause
// The gate of this tree against methods with a fault built in: each has to fail it, the method as it is has to pass. On
// the first draws of the gate alone; over all of them it sees more.
#include "scenarios/gate/mutations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <set>
#include <string>

#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/gate.hpp"
#include "sim/lidar/surface.hpp"
#include "tests/tree.hpp"

namespace tumble::scenarios {
namespace {

using testing::Mutation;
using testing::mutations;

/// The accepted run cut to its first draws.
Gate first_draws(Gate gate, std::size_t draws) {
  gate.accepted.seeds.resize(draws);
  for (MethodRun& run : gate.accepted.methods) {
    run.status.resize(draws);
    for (auto& [metric, values] : run.values) values.resize(draws);
  }
  return gate;
}

/// The accepted run with these outcomes in the place of the accepted ones.
GateRun with(GateRun run, const std::vector<Outcome>& outcomes) {
  const GateRun other = gate_run(outcomes, run.seeds.front(), run.seeds.back());
  for (const MethodRun& each : other.methods) {
    std::erase_if(run.methods, [&](const MethodRun& one) {
      return one.scenario == each.scenario && one.kind == each.kind && one.method == each.method;
    });
    run.methods.push_back(each);
  }
  return run;
}

/// What each mutation made of the draws of a scenario; "" is the methods as they are.
using Outcomes = std::map<std::string, std::vector<Outcome>>;

void run_draw(const SimulatedDraw& draw, const sim::Surface* surface, const std::string& method_name, Outcomes& all) {
  const Method& method = *find_methods(method_name).at(0);
  Outcome run;
  const Estimate estimate = run_method(method, draw, run);
  Outcome as_it_is = run;
  assess(method, draw, surface, estimate, as_it_is);
  all[""].push_back(as_it_is);
  for (const Mutation& mutation : mutations()) {
    if (mutation.scenario != draw.scenario || mutation.method != method_name) continue;
    Outcome outcome = run;
    Estimate changed = estimate;
    if (mutation.given != nullptr) {
      SimulatedDraw given = draw;
      mutation.given(given.recording.sensors);
      outcome = {};
      changed = run_method(method, given, outcome);
    }
    if (mutation.returned != nullptr) mutation.returned(draw.recording, changed);
    assess(method, draw, surface, changed, outcome);
    all[mutation.name].push_back(outcome);
  }
}

bool needs_lidar(const Mutation& mutation) {
  return std::string(mutation.method).starts_with("slam/");
}

/// The mutated methods of a scenario, those that need a lidar or those that do not.
std::set<std::string> mutated_methods(const std::string& scenario, bool lidar) {
  std::set<std::string> methods;
  for (const Mutation& mutation : mutations()) {
    if (mutation.scenario == scenario && needs_lidar(mutation) == lidar) methods.insert(mutation.method);
  }
  return methods;
}

/// Without lidar nobody simulates one; what the IMUs say is the same.
Outcomes run_scenario(const DataRoot& data, const Gate& gate, const std::string& scenario, bool lidar) {
  Outcomes all;
  for (const std::uint64_t seed : gate.accepted.seeds) {
    const SimulatedDraw draw =
        simulate_draw(data, load_scenario(data, scenario), seed, 1, lidar ? Lidars::simulated : Lidars::left_out);
    std::optional<sim::Surface> surface;
    if (lidar) surface.emplace(*draw.built);
    for (const std::string& method : mutated_methods(scenario, lidar)) {
      run_draw(draw, surface ? &*surface : nullptr, method, all);
    }
  }
  return all;
}

std::string faults_of(const GateRun& run, const Gate& gate) {
  std::string faults;
  for (const GateResult& result : hold_to_gate(run, gate)) {
    if (!result.passes()) {
      faults += result.scenario + " " + to_string(result.kind) + "/" + result.method + " " + result.metric + ": " +
                result.fault + "; ";
    }
  }
  return faults;
}

/// The mutations of a scenario, of the methods with or of those without lidar.
void expect_refused(const std::string& scenario, bool lidar, std::size_t draws) {
  const DataRoot data{test::source_dir()};
  const Gate gate = first_draws(load_gate(data, "gate"), draws);
  const Outcomes all = run_scenario(data, gate, scenario, lidar);
  std::size_t refused = 0;
  for (const auto& [name, outcomes] : all) {
    ASSERT_EQ(outcomes.size() % draws, 0u) << name;
    const std::string faults = faults_of(with(gate.accepted, outcomes), gate);
    if (name.empty()) {
      EXPECT_EQ(faults, "") << "the methods as they are";
      continue;
    }
    EXPECT_NE(faults, "") << name << " passes the gate";
    std::printf("%s: %s\n", name.c_str(), faults.c_str());
    ++refused;
  }
  EXPECT_EQ(refused, static_cast<std::size_t>(std::count_if(mutations().begin(), mutations().end(), [&](const auto& m) {
              return m.scenario == scenario && needs_lidar(m) == lidar;
            })));
}

// on some draws nothing clips: of twelve, ten are too few for a test on both sides among so many
TEST(GateMutations, OfRatesAreRefused) {
  expect_refused("hill", false, 18);
}

// a test on both sides is worth 2^-13 with fourteen draws, beside a hundred others; with twelve it is not enough
TEST(GateMutations, OfMapsAreRefused) {
  expect_refused("hill", true, 14);
}

TEST(GateMutations, OfTheRollingSphereAreRefused) {
  expect_refused("bump", false, 14);
}

TEST(GateMutations, OfTheCarriedBodyAreRefused) {
  expect_refused("swing", false, 14);
}

}  // namespace
}  // namespace tumble::scenarios
