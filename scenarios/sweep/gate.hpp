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

/// The gate: a run over a suite's fixed seeds against the accepted one, draw by draw.
///
/// A draw is the same bits in both runs, so that what the draws differ in cancels out of each pair. Held are, of each
/// scenario and method that the accepted run has:
/// - outcomes: a draw that was ok has to be ok again, and no verdict (`map_failed`) may turn against it;
/// - presence: an ok outcome has every metric that it had;
/// - the middle, of each held metric (metric.hpp, `held_metrics`): no shift of the pairs for the worse beyond the
/// margin.
///   Pairs differ by the logarithm of their ratio or by their difference, as the metric says (`Compared`). The exact
///   signed-rank test
///   (statistics/paired.hpp) of the differences less the margin; metrics with a target are held on both sides, a
///   covariance that becomes smaller fails as one that becomes larger does. A run that is no worse fails any of all
///   tests of a gate with at most `risk` (Bonferroni);
/// - the middle of a metric over the draws of all scenarios of a method, where several have it: a shift that is too
///   small for the draws of one;
/// - the worst draw, which a test of the middle does not see: it may be `worst` times the accepted worst.
namespace tumble::scenarios {

/// What one method reached on the draws, in the order of `GateRun::seeds`.
struct MethodRun {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method;
  std::vector<std::optional<OutcomeStatus>> status;   ///< none: no outcome of this draw
  std::map<std::string, std::vector<double>> values;  ///< by held metric; NaN: none
};

struct GateRun {
  std::vector<std::uint64_t> seeds;  ///< rising
  std::vector<MethodRun> methods;
  const MethodRun* find(const std::string& scenario, Kind kind, const std::string& method) const;
};

/// The held metrics of plain outcomes over the seeds `first` to `last`.
GateRun gate_run(std::span<const Outcome> outcomes, std::uint64_t first, std::uint64_t last);
GateRun gate_run(const Results& results, std::uint64_t first, std::uint64_t last);

struct GatePolicy {
  double risk = 0.05;           ///< chance that a run which is no worse fails, over all tests; (0, 0.5]
  double margin = 0.02;         ///< shift of the pairs that does not matter, of ratios; [0, 10]
  double share_margin = 0.005;  ///< the same, of differences of shares; [0, 1]
  double time_margin_s = 5e-5;  ///< the same, of differences of offsets in time; [0, 1]
  double worst = 2.0;           ///< how many times the accepted worst draw a draw may be; at least 1
};

/// The accepted run of a suite: scenarios/gates/SUITE.yaml says how it is held, SUITE.csv beside it what it reached.
/// Both are kept in git.
struct Gate {
  std::string suite;
  GatePolicy policy;
  GateRun accepted;
};

std::vector<std::string> gate_names(const DataRoot& data);
/// The gate of a suite, or a file when `name` ends in ".yaml" (the run beside it, in ".csv"). Throws BadInput with file
/// and line: no such gate (nearest named), of another suite, unknown key, kind, method, metric or status, a row of
/// another length, a number out of its bound, nothing accepted. `described` are methods of files (external_method.hpp)
/// that it may hold beside those of this build.
Gate load_gate(const DataRoot& data, const std::string& name, std::span<const MethodPointer> described = {});
/// The policy and the run as `load_gate` reads them; numbers read back exactly.
std::string to_yaml(const Gate& gate);
std::string to_csv(const GateRun& run);
GateRun parse_gate_run(const std::string& text, const std::string& file, std::span<const MethodPointer> described = {});

/// One line of the gate: the outcomes of a method (no metric), or one metric, of a scenario or of all together.
struct GateResult {
  std::string scenario;  ///< empty: all that hold the metric
  Kind kind = Kind::rate;
  std::string method, metric;
  std::size_t draws = 0;                   ///< pairs that count
  double accepted = 0.0;                   ///< median, or the share of draws that were not ok
  double value = 0.0;                      ///< the same now
  double change = 0.0;                     ///< median of the pairs': of ratios less one, or of differences
  double chance = 1.0;                     ///< of pairs as bad, were the run no worse; times the number of tests
  bool better = false;                     ///< by the same test the other way: accept it, and it is held
  std::string fault = {};                  ///< what is wrong, with a seed; empty when nothing is
  std::optional<std::uint64_t> seed = {};  ///< that the fault names
  bool passes() const { return fault.empty(); }
};

/// Throws BadInput when the runs are of other seeds or nothing was accepted.
std::vector<GateResult> hold_to_gate(const GateRun& run, const Gate& gate);

/// Throws BadInput where a draw has no outcome, or a method has no ok one: such a run cannot be accepted.
void require_acceptable(const GateRun& run);

}  // namespace tumble::scenarios
