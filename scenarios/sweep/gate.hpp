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

/// A gate compares new results of a suite with accepted results. New and accepted results contain the same scenarios
/// and seeds with equal sensor data, so each test compares pairs of values. The gate performs these tests:
///
/// - Outcomes: a run whose accepted status is ok must have the status ok again, and a pass-fail metric (`map_failed`)
///   must not change to 1.
/// - Presence: if the accepted outcome of a run contains a metric and the new status is ok, the new outcome must also
///   contain the metric.
/// - Median: no metric may become worse by more than the margin, by the exact signed-rank test of the paired
///   differences. For a metric with a target, the test has two sides, because a covariance can also become too small.
/// - Median over all scenarios of a method: this test detects shifts that are too small to detect in one scenario.
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
  std::map<std::string, std::vector<double>> values;  ///< per run; NaN: no value
};

struct GateRun {
  std::vector<std::uint64_t> seeds;  ///< ascending
  std::vector<MethodRun> methods;
  const MethodRun* find(const std::string& scenario, Kind kind, const std::string& method) const;
};

GateRun gate_run(std::span<const Outcome> outcomes, std::uint64_t first, std::uint64_t last);
GateRun gate_run(const Results& results, std::uint64_t first, std::uint64_t last);

struct GatePolicy {
  double risk = 0.05;           ///< of any false alarm; (0, 0.5]
  double margin = 0.02;         ///< relative change; [0, 10]
  double share_margin = 0.005;  ///< change of fractions; [0, 1]
  double time_margin_s = 5e-5;  ///< change of time offsets; [0, 1]
  double worst = 2.0;           ///< worst new over worst accepted value
};

/// Gate contains the accepted results of a suite and the limits for new results. The two parts are stored in two files
/// in git, scenarios/gates/SUITE.csv and SUITE.yaml.
struct Gate {
  std::string suite;
  GatePolicy policy;
  GateRun accepted;
};

std::vector<std::string> gate_names(const DataRoot& data);
/// Reads the accepted results and the limits of a regression gate from two files. A gate may contain results of an
/// external method only if `described` contains this method.
Gate load_gate(const DataRoot& data, const std::string& name, std::span<const MethodPointer> described = {});
std::string to_yaml(const Gate& gate);
std::string to_csv(const GateRun& run);
GateRun parse_gate_run(const std::string& text, const std::string& file, std::span<const MethodPointer> described = {});

struct GateResult {
  std::string scenario;  ///< empty: all scenarios
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;                   ///< compared pairs
  double accepted = 0.0;                   ///< median, or fraction of failed runs
  double value = 0.0;                      ///< median, or fraction of failed runs
  double change = 0.0;                     ///< ratio minus one, or difference
  double chance = 1.0;                     ///< p-value times number of tests
  bool better = false;                     ///< significantly better
  std::string fault = {};                  ///< empty if none
  std::optional<std::uint64_t> seed = {};  ///< seed of the fault
  bool passes() const { return fault.empty(); }
};

std::vector<GateResult> hold_to_gate(const GateRun& run, const Gate& gate);

void require_acceptable(const GateRun& run);

}  // namespace tumble::scenarios
