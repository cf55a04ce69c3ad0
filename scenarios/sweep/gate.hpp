// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/scoring/metric.hpp"
#include "scenarios/sweep/results.hpp"

/// A gate compares new results of a suite with accepted results, separately for each simulated run. New and accepted
/// results contain the same simulated runs with equal sensor data, so differences between seeds cancel in each pair.
///
/// - Outcomes: a run that was ok must be ok again, and a pass-fail metric (`map_failed`) must not change to 1.
/// - Presence: if the accepted outcome of a run has a metric and the new outcome is ok, the new outcome must have it
///   too.
/// - Median: no gate metric may become worse by more than the margin, by the exact signed-rank test of the paired
///   differences. A metric with a target is tested on both sides, so a covariance that becomes too small also fails.
/// - Median over all scenarios of a method: detects shifts that are too small to detect in one scenario.
/// - Worst run: no value may be worse than `worst` times the worst accepted value, because tests of the median cannot
///   detect a single bad run.
///
/// If the new results are not worse, the probability that any test of a median fails is at most `risk` (Bonferroni).
namespace tumble::scenarios {

struct MethodRun {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method;
  std::vector<std::optional<OutcomeStatus>> status;   ///< status per run; empty: no outcome
  std::map<std::string, std::vector<double>> values;  ///< values per run by gate metric; NaN: no value
};

struct GateRun {
  std::vector<std::uint64_t> seeds;  ///< ascending
  std::vector<MethodRun> methods;
  const MethodRun* find(const std::string& scenario, Kind kind, const std::string& method) const;
};

GateRun gate_run(std::span<const Outcome> outcomes, std::uint64_t first, std::uint64_t last);
GateRun gate_run(const Results& results, std::uint64_t first, std::uint64_t last);

struct GatePolicy {
  double risk = 0.05;           ///< probability that any test fails although the new results are equally good; (0, 0.5]
  double margin = 0.02;         ///< tolerated relative change of ratios; [0, 10]
  double share_margin = 0.005;  ///< tolerated change of fractions; [0, 1]
  double time_margin_s = 5e-5;  ///< tolerated change of time offsets; [0, 1]
  double worst = 2.0;           ///< allowed ratio of the worst new value to the worst accepted value; at least 1
};

/// A gate has two files in git: the accepted results of a suite (scenarios/gates/SUITE.csv) and the limits for new
/// results (SUITE.yaml).
struct Gate {
  std::string suite;
  GatePolicy policy;
  GateRun accepted;
};

std::vector<std::string> gate_names(const DataRoot& data);
/// Loads the gate of a suite by its name, or from a file if `name` ends in ".yaml". `described` contains external
/// methods that may occur in the gate. Throws BadInput with file and line for an unknown gate or an invalid file.
Gate load_gate(const DataRoot& data, const std::string& name, std::span<const MethodPointer> described = {});
std::string to_yaml(const Gate& gate);
std::string to_csv(const GateRun& run);
GateRun parse_gate_run(const std::string& text, const std::string& file, std::span<const MethodPointer> described = {});

struct GateResult {
  std::string scenario;  ///< empty: all scenarios with this metric
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;                   ///< compared pairs
  double accepted = 0.0;                   ///< accepted median, or fraction of runs that were not good
  double value = 0.0;                      ///< new median, or fraction of runs that are not good
  double change = 0.0;                     ///< median change of the pairs: ratio minus one, or difference
  double chance = 1.0;                     ///< p-value of the hypothesis "not worse", times the number of tests
  bool better = false;                     ///< significantly better; the new results should be accepted
  std::string fault = {};                  ///< description of the fault; empty if none
  std::optional<std::uint64_t> seed = {};  ///< seed of the fault
  bool passes() const { return fault.empty(); }
};

/// Throws BadInput if the seeds differ or the accepted results are empty.
std::vector<GateResult> hold_to_gate(const GateRun& run, const Gate& gate);

/// Throws BadInput if a simulated run has no outcome, or if a method has no ok outcome.
void require_acceptable(const GateRun& run);

}  // namespace tumble::scenarios
