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

/// The gate compares a run over a suite's fixed seeds with the accepted run, draw by draw.
///
/// A draw has the same bits in both runs, so differences between draws cancel in each pair. For each scenario and
/// method of the accepted run the gate checks:
/// - outcomes: a draw that was ok must be ok again, and no verdict (`map_failed`) may turn to 1;
/// - presence: an ok outcome must have every metric that it had;
/// - median of each gate metric (metric.hpp, `held_metrics`): the pairs must not shift for the worse by more than the
///   margin. Pairs differ by the logarithm of their ratio or by their difference, as the metric states (`Compared`).
///   The test is the exact signed-rank test (statistics/paired.hpp) of the differences minus the margin. Metrics with a
///   target are checked on both sides: a covariance that becomes too small fails too. A run that is no worse fails any
///   test of a gate with probability at most `risk` (Bonferroni);
/// - median of a metric over all scenarios of a method, which detects shifts too small for one scenario;
/// - the worst draw, which tests of the median miss: at most `worst` times the accepted worst.
namespace tumble::scenarios {

/// Results of one method, in the order of `GateRun::seeds`.
struct MethodRun {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method;
  std::vector<std::optional<OutcomeStatus>> status;   ///< empty: no outcome for this draw
  std::map<std::string, std::vector<double>> values;  ///< by gate metric; NaN: no value
};

struct GateRun {
  std::vector<std::uint64_t> seeds;  ///< ascending
  std::vector<MethodRun> methods;
  const MethodRun* find(const std::string& scenario, Kind kind, const std::string& method) const;
};

/// Returns the gate metrics of plain outcomes for seeds `first` to `last`.
GateRun gate_run(std::span<const Outcome> outcomes, std::uint64_t first, std::uint64_t last);
GateRun gate_run(const Results& results, std::uint64_t first, std::uint64_t last);

struct GatePolicy {
  double risk = 0.05;           ///< probability that an equally good run fails any test; (0, 0.5]
  double margin = 0.02;         ///< tolerated shift of ratios; [0, 10]
  double share_margin = 0.005;  ///< tolerated shift of shares; [0, 1]
  double time_margin_s = 5e-5;  ///< tolerated shift of time offsets; [0, 1]
  double worst = 2.0;           ///< allowed factor on the accepted worst draw; at least 1
};

/// The accepted run of a suite: scenarios/gates/SUITE.yaml states the policy, SUITE.csv next to it the results. Both
/// are kept in git.
struct Gate {
  std::string suite;
  GatePolicy policy;
  GateRun accepted;
};

std::vector<std::string> gate_names(const DataRoot& data);
/// Loads the gate of a suite, or a file if `name` ends in ".yaml" (with its run in ".csv"). `described` are external
/// methods (external_method.hpp) that it may contain. Throws BadInput with file and line: no such gate (suggests the
/// nearest), another suite, or an empty run. Also throws for an unknown key, kind, method, metric or status, a wrong
/// row length, or a number out of bounds.
Gate load_gate(const DataRoot& data, const std::string& name, std::span<const MethodPointer> described = {});
/// Return policy and run as `load_gate` reads them; numbers round-trip exactly.
std::string to_yaml(const Gate& gate);
std::string to_csv(const GateRun& run);
GateRun parse_gate_run(const std::string& text, const std::string& file, std::span<const MethodPointer> described = {});

/// One result of the gate: the outcomes of a method (no metric), or one metric, for one scenario or all.
struct GateResult {
  std::string scenario;  ///< empty: all that have the metric
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;                   ///< compared pairs
  double accepted = 0.0;                   ///< median, or the share of draws that were not ok, in the accepted run
  double value = 0.0;                      ///< the same in the current run
  double change = 0.0;                     ///< median of the pairs: ratio minus one, or difference
  double chance = 1.0;                     ///< p-value under the hypothesis of no degradation, times the number of
                                           ///< tests
  bool better = false;                     ///< significantly better by the opposite test; the new run should be
                                           ///< accepted
  std::string fault = {};                  ///< fault with a seed; empty if none
  std::optional<std::uint64_t> seed = {};  ///< seed of the fault
  bool passes() const { return fault.empty(); }
};

/// Compares a run with the gate. Throws BadInput if the seeds differ or the accepted run is empty.
std::vector<GateResult> hold_to_gate(const GateRun& run, const Gate& gate);

/// Throws BadInput if a draw has no outcome, or a method has no ok one; such a run cannot be accepted.
void require_acceptable(const GateRun& run);

}  // namespace tumble::scenarios
