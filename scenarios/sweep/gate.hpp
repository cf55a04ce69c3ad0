// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/data_root.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// Which figure of the draws is held to a bound.
enum class Statistic { median, quantile_05, quantile_95, share_not_ok };
const char* to_string(Statistic statistic);

/// One accepted bound: a statistic of one metric of one method over the draws of one scenario.
struct GateBound {
  std::string scenario;
  Kind kind = Kind::rate;
  std::string method;
  Statistic statistic = Statistic::median;
  std::string metric;     ///< empty for share_not_ok
  double accepted = 0.0;  ///< the value of the run that the bound was set from
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// The accepted bounds of a suite, scenarios/gates/SUITE.yaml, kept in git.
struct Gate {
  std::string suite;
  double margin = 0.0;  ///< relative, that the bounds were set with
  std::vector<GateBound> bounds;
};

std::vector<std::string> gate_names(const DataRoot& data);
/// The gate of a suite, or a file when `name` ends in ".yaml". Throws BadInput with file and line: no such gate
/// (nearest named), unknown key, kind, statistic or method, no bound, an empty range.
Gate load_gate(const DataRoot& data, const std::string& name);
/// As `load_gate` reads it; numbers read back exactly.
std::string to_yaml(const Gate& gate);

/// A bound beside what was measured.
struct GateResult {
  GateBound bound;
  double value = 0.0;     ///< NaN when no draw has a value
  std::size_t draws = 0;  ///< that count
  bool passes() const { return value >= bound.low && value <= bound.high; }
};

/// The statistic over the outcomes of the seeds `first` to `last`. An outcome that is not ok ranks as the worst value
/// (infinite, or minus infinite where more is better) and does not count for a metric without sense, as one that is ok
/// but has no such metric does not. NaN without outcomes, which passes no bound.
std::vector<GateResult> hold_to_gate(const Results& results, const Gate& gate, std::uint64_t first, std::uint64_t last);

/// Bounds with the values of `results` as accepted, `margin` of their size away: above for what is better small (high),
/// below for what is better large (low), both for what has a target. A share of failures may rise by the margin, but
/// where there was none there may be none. A value that is not finite throws BadInput: such a run cannot be accepted.
Gate accept(const Gate& gate, const std::vector<GateResult>& results, double margin);

/// A gate to begin with, without bounds' values: for each scenario and kind in the results, the method `tumble` and
/// what is most often looked at, errors and whether the reported covariance holds them.
Gate proposed_gate(const Results& results, const std::string& suite);

}  // namespace tumble::scenarios
