// SPDX-License-Identifier: BSD-3-Clause
// The test runs the repository's gate on methods with a built-in fault: each must fail the gate, and the unchanged
// method must pass. The test evaluates only the gate's rows of the method, on its first draws. The gate divides its
// risk by its rows, and one draw less doubles the chance of pairs that all shift: ten rows on ten draws (2 * 10 *
// 2^-10, on both sides) detect less than all 143 rows on all 18 draws (2 * 143 * 2^-18). The whole gate rejects every
// shift that is rejected here.
#include "scenarios/gate/mutations.hpp"
#include "scenarios/methods/registry.hpp"

#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/gate.hpp"
#include "sim/lidar/surface.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios {
namespace {

using testing::Mutation;
using testing::mutations;

/// An Asked contains a method and the number of the gate's first draws on which its mutations are tested.
struct Asked {
  std::string method;
  std::size_t draws;
};

/// Returns the accepted run of one method on a scenario, limited to its first draws.
Gate rows_of(Gate gate, const std::string& scenario, const Asked& asked) {
  std::erase_if(gate.accepted.methods, [&](const MethodRun& run) {
    return run.scenario != scenario || full_name(run.kind, run.method) != asked.method;
  });
  gate.accepted.seeds.resize(asked.draws);
  for (MethodRun& run : gate.accepted.methods) {
    run.status.resize(asked.draws);
    for (auto& [metric, values] : run.values) values.resize(asked.draws);
  }
  return gate;
}

/// Outcomes contains the results of each mutation on the draws of a scenario; the key "" is the unchanged method.
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

/// Returns the results of each method's mutations on the draws; each draw is simulated once for all mutations. Methods
/// that estimate rates need no lidar, and give the same results without one.
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

const std::vector<std::string>& metrics_of(const std::string& scenario, const std::string& method,
                                           const std::string& mutation) {
  const auto is_it = [&](const Mutation& one) {
    return one.scenario == scenario && one.method == method && one.name == mutation;
  };
  return std::find_if(mutations().begin(), mutations().end(), is_it)->metrics;
}

void expect_refused(const DataRoot& data, const std::string& scenario, const Asked& asked, const Outcomes& all) {
  const Gate gate = rows_of(load_gate(data, "gate"), scenario, asked);
  ASSERT_EQ(gate.accepted.methods.size(), 1u);
  const std::vector<std::uint64_t>& seeds = gate.accepted.seeds;
  std::size_t refused = 0;
  for (const auto& [name, outcomes] : all) {
    ASSERT_EQ(outcomes.size(), asked.draws) << name;
    const std::string faults = faults_of(gate_run(outcomes, seeds.front(), seeds.back()), gate);
    if (name.empty()) {
      EXPECT_EQ(faults, "") << "the methods as they are";
      continue;
    }
    for (const std::string& metric : metrics_of(scenario, asked.method, name)) {
      const bool row = faults.find(" " + metric + ": ") != std::string::npos;
      const bool failure = faults.find(": " + metric + " at seed ") != std::string::npos;
      EXPECT_TRUE(row || failure) << name << ": " << metric << " passes the gate";
    }
    std::printf("%s: %s\n", name.c_str(), faults.c_str());
    ++refused;
  }
  EXPECT_EQ(refused, static_cast<std::size_t>(std::count_if(mutations().begin(), mutations().end(), [&](const auto& m) {
              return m.scenario == scenario && m.method == asked.method;
            })));
}

/// A Group contains the methods and draws that one test evaluates for a scenario.
struct Group {
  std::string scenario;
  std::vector<Asked> asked;
};

/// On some draws of hill nothing is saturated: of twelve draws, ten remain.
const std::map<std::string, Group>& groups() {
  static const std::map<std::string, Group> kGroups = {
      {"rates and maps", {"hill", {{"rate/tumble", 12}, {"rate/tumble_lag", 12}, {"slam/tumble", 10}}}},
      {"the odometry", {"hill", {{"slam/tumble_lag", 10}, {"slam/tumble_live", 10}}}},
      {"the rolling sphere",
       {"bump",
        {{"position/tumble", 10}, {"position/tumble_lag", 10}, {"position/tumble_live", 10}, {"attitude/tumble", 10}}}},
      {"slip", {"slip", {{"position/tumble", 10}, {"position/tumble_lag", 10}, {"position/tumble_live", 10}}}},
      {"rolling alone", {"roll", {{"position/tumble", 10}}}},
      {"hand-held motion", {"swing", {{"rate/tumble", 9}, {"attitude/tumble", 9}}}},
  };
  return kGroups;
}

void expect_refused(const std::string& name) {
  const Group& group = groups().at(name);
  const DataRoot data{test::source_dir()};
  const std::map<std::string, Outcomes> all = run_scenario(data, group.scenario, group.asked);
  for (const Asked& each : group.asked) {
    SCOPED_TRACE(each.method);
    expect_refused(data, group.scenario, each, all.at(each.method));
  }
}

TEST(GateMutations, OfRatesAndMapsAreRefused) {
  expect_refused("rates and maps");
}

// these tests apply the same faults to other methods, which map each draw twice more: `tools/test --all`
TEST(GateMutationsSoak, OfTheOdometryAreRefused) {
  expect_refused("the odometry");
}

TEST(GateMutations, OfTheRollingSphereAreRefused) {
  expect_refused("the rolling sphere");
}

TEST(GateMutations, OfEventsOfSlipAreRefused) {
  expect_refused("slip");
}

TEST(GateMutations, OfRollingAloneAreRefused) {
  expect_refused("rolling alone");
}

TEST(GateMutations, OfHandHeldMotionAreRefused) {
  expect_refused("hand-held motion");
}

// a metric that no fault changes would be useless in the gate
TEST(GateMutations, EachMetricOfTheGateRejectsOne) {
  std::set<std::string> rejecting, gated;
  for (const Mutation& mutation : mutations()) rejecting.insert(mutation.metrics.begin(), mutation.metrics.end());
  for (const MethodRun& run : load_gate(test::tree_data(), "gate").accepted.methods) {
    for (const auto& [metric, values] : run.values) gated.insert(metric);
  }
  EXPECT_GE(gated.size(), 30u);
  EXPECT_EQ(rejecting, gated);
}

TEST(GateMutations, EachIsTried) {
  EXPECT_GE(mutations().size(), 52u);
  for (const Mutation& mutation : mutations()) {
    EXPECT_FALSE(mutation.metrics.empty()) << mutation.name;
    const auto tries = [&](const auto& group) {
      const auto is_it = [&](const Asked& each) { return each.method == mutation.method; };
      return group.second.scenario == mutation.scenario &&
             std::any_of(group.second.asked.begin(), group.second.asked.end(), is_it);
    };
    EXPECT_EQ(std::count_if(groups().begin(), groups().end(), tries), 1) << mutation.name;
  }
}

}  // namespace
}  // namespace tumble::scenarios
