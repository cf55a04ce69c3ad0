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

/// A gate compares new results of a suite with accepted results, separately for each simulated run.
///
/// New and accepted results contain the same simulated runs with equal sensor data, so differences between seeds cancel
/// in each pair. The gate makes the following checks for each scenario and method in the accepted results.
///
/// The check of outcomes requires that a run that was ok is ok again, and that no pass-fail metric (`map_failed`)
/// changes to 1. The check of presence requires that an ok outcome still has every metric of the accepted outcome.
///
/// The check of the median requires that no gate metric (metric.hpp, `held_metrics`) becomes worse by more than the
/// margin. The difference of a pair is the logarithm of the ratio or the plain difference, as the metric states
/// (`Compared`). The exact signed-rank test (statistics/paired.hpp) tests the differences of the pairs minus the
/// margin. A metric with a target is checked on both sides, so a covariance that becomes too small also fails. If the
/// new results are not worse, the probability that any test of the gate fails is at most `risk` (Bonferroni).
///
/// The check of the median over all scenarios of a method detects shifts that are too small for one scenario.
///
/// The check of the worst run requires that no value is worse than `worst` times the accepted worst value. The tests of
/// the median cannot detect a single bad run.
namespace tumble::scenarios {

/// MethodRun contains the results of one method, in the order of `GateRun::seeds`.
struct MethodRun {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method;
  std::vector<std::optional<OutcomeStatus>> status;   ///< empty: no outcome for this run
  std::map<std::string, std::vector<double>> values;  ///< by gate metric; NaN: no value
};

struct GateRun {
  std::vector<std::uint64_t> seeds;  ///< ascending
  std::vector<MethodRun> methods;
  const MethodRun* find(const std::string& scenario, Kind kind, const std::string& method) const;
};

/// Returns the gate metrics of unmodified outcomes for the seeds `first` to `last`.
GateRun gate_run(std::span<const Outcome> outcomes, std::uint64_t first, std::uint64_t last);
GateRun gate_run(const Results& results, std::uint64_t first, std::uint64_t last);

struct GatePolicy {
  double risk = 0.05;           ///< probability that an equally good run fails any test; (0, 0.5]
  double margin = 0.02;         ///< tolerated shift of ratios; [0, 10]
  double share_margin = 0.005;  ///< tolerated shift of shares; [0, 1]
  double time_margin_s = 5e-5;  ///< tolerated shift of time offsets; [0, 1]
  double worst = 2.0;           ///< allowed factor on the accepted worst draw; at least 1
};

/// Gate contains the accepted results of a suite, and the limits for new results. The file scenarios/gates/SUITE.yaml
/// contains the limits, and SUITE.csv contains the results. The two files of a gate are kept in git.
struct Gate {
  std::string suite;
  GatePolicy policy;
  GateRun accepted;
};

std::vector<std::string> gate_names(const DataRoot& data);
/// Loads the gate of a suite by its name, or from a file if `name` ends in ".yaml". The accepted results are in a
/// ".csv" file with the same name. The list `described` contains external methods (external_method.hpp) that may occur
/// in the gate. Throws BadInput with file and line for an unknown gate, another suite, or empty results; the message
/// for an unknown gate suggests the nearest name. Throws BadInput for an unknown key, kind, method, metric or status, a
/// wrong row length, or a number out of bounds.
Gate load_gate(const DataRoot& data, const std::string& name, std::span<const MethodPointer> described = {});
/// Returns the limits or the accepted results of a gate as text that `load_gate` can read. Reading restores all numbers
/// exactly.
std::string to_yaml(const Gate& gate);
std::string to_csv(const GateRun& run);
GateRun parse_gate_run(const std::string& text, const std::string& file, std::span<const MethodPointer> described = {});

/// GateResult is the result of one check of the gate, for one scenario or all scenarios. A GateResult belongs to one
/// metric, or to the outcomes of a method (no metric).
struct GateResult {
  std::string scenario;  ///< empty: all scenarios that have the metric
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;                   ///< compared pairs
  double accepted = 0.0;                   ///< accepted median, or fraction of runs that were not ok
  double value = 0.0;                      ///< current median, or fraction of runs that are not ok
  double change = 0.0;                     ///< median of the pairs: ratio minus one, or difference
  double chance = 1.0;                     ///< p-value of no degradation, times the number of tests
  bool better = false;                     ///< significantly better; accept the new run
  std::string fault = {};                  ///< description of the fault; empty if none
  std::optional<std::uint64_t> seed = {};  ///< seed of the fault
  bool passes() const { return fault.empty(); }
};

/// Compares new results with the accepted results of the gate. Throws BadInput if the seeds differ or the accepted
/// results are empty.
std::vector<GateResult> hold_to_gate(const GateRun& run, const Gate& gate);

/// Throws BadInput if a simulated run has no outcome, or if no outcome of a method is ok. Results without an ok outcome
/// must not become accepted results.
void require_acceptable(const GateRun& run);

}  // namespace tumble::scenarios
