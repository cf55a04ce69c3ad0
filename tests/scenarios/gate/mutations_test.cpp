// SPDX-License-Identifier: BSD-3-Clause
// The gate of this tree against methods with a fault built in: each has to fail it, the method as it is has to pass. On
// the first draws of the gate alone; over all of them it sees more.
#include "scenarios/gate/mutations.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

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

/// A method, and the first draws of the gate that its mutations are held on.
struct Asked {
  std::string method;
  std::size_t draws;
};

/// What each method's mutations made of the draws; each draw is simulated once for all of them. Rates alone need no
/// lidar, and are the same without.
std::map<std::string, Outcomes> run_scenario(const DataRoot& data, const std::string& scenario,
                                             const std::vector<Asked>& asked) {
  std::map<std::string, Outcomes> all;
  const std::vector<std::uint64_t> seeds = load_gate(data, "gate").accepted.seeds;
  for (std::size_t k = 0; k < seeds.size(); ++k) {
    std::vector<std::string> wanted;
    for (const Asked& each : asked) {
      if (k < each.draws) wanted.push_back(each.method);
    }
    if (wanted.empty()) break;
    const bool maps = std::any_of(wanted.begin(), wanted.end(), [](const auto& m) { return m.starts_with("slam/"); });
    const SimulatedDraw draw =
        simulate_draw(data, load_scenario(data, scenario), seeds[k], 1, maps ? Lidars::simulated : Lidars::left_out);
    std::optional<sim::Surface> surface;
    if (maps) surface.emplace(*draw.built);
    for (const std::string& method : wanted) run_draw(draw, surface ? &*surface : nullptr, method, all[method]);
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

void expect_refused(const DataRoot& data, const std::string& scenario, const Asked& asked, const Outcomes& all) {
  const Gate gate = first_draws(load_gate(data, "gate"), asked.draws);
  std::size_t refused = 0;
  for (const auto& [name, outcomes] : all) {
    ASSERT_EQ(outcomes.size(), asked.draws) << name;
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
              return m.scenario == scenario && m.method == asked.method;
            })));
}

void expect_refused(const std::string& scenario, const std::vector<Asked>& asked) {
  const DataRoot data{test::source_dir()};
  const std::map<std::string, Outcomes> all = run_scenario(data, scenario, asked);
  for (const Asked& each : asked) {
    SCOPED_TRACE(each.method);
    expect_refused(data, scenario, each, all.at(each.method));
  }
}

// on some draws nothing clips: of twelve, ten are too few for a test on both sides among so many; of maps a test on
// both sides is worth 2^-13 with fourteen draws, beside a hundred others; with twelve it is not enough
TEST(GateMutations, OfRatesAndMapsAreRefused) {
  expect_refused("hill", {{"rate/tumble", 18}, {"rate/tumble_lag", 18}, {"slam/tumble", 14}});
}

TEST(GateMutations, OfTheRollingSphereAreRefused) {
  expect_refused("bump", {{"position/tumble", 14}, {"position/tumble_live", 14}, {"attitude/tumble", 14}});
}

TEST(GateMutations, OfTheCarriedBodyAreRefused) {
  expect_refused("swing", {{"rate/tumble", 14}, {"attitude/tumble", 14}});
}

}  // namespace
}  // namespace tumble::scenarios
