// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/results.hpp"

/// A metric against what was varied, or against what the draws happened to be like.
namespace tumble::scenarios {

/// One method at one place of a curve, over its draws. An outcome that failed ranks as the worst value of all, so a
/// quantile may be infinite; NaN when no draw has a value.
struct CurvePoint {
  double x = 0.0;
  std::string label;  ///< of a bin: "0.5 – 1"; empty for a number that was set
  std::int64_t draws = 0, failed = 0;
  Interval failed_share{};  ///< Clopper and Pearson, 95 %
  double quantile_25 = 0.0, median = 0.0, quantile_75 = 0.0;
  double worst_5 = 0.0;  ///< 95 % quantile, of what is better large the 5 % one
};

struct CurveLine {
  std::string method;
  std::vector<CurvePoint> points;  ///< x rising
};

struct Curve {
  /// What x is: a number that the suite set, a measure by which samples were sorted into bins, or one of whole draws.
  enum class Source { set, samples, draws };
  Source source = Source::set;
  std::string axis;  ///< key of what was varied, or name of the measure; ends in its unit
  std::string scenario;
  Kind kind = Kind::rate;
  std::string metric;
  std::vector<CurveLine> lines;  ///< in the order of the registry
};

/// Every curve that the results hold: for each number varied, scenario and headline metric of a kind; for each measure
/// with binned metrics (scenarios/scoring/binned_metric.hpp); and for each measure of clipping of the draws, in bins of
/// equally many draws, when there are draws for three bins at least. A run has failed when it did not end `ok` or its
/// map has failed. O(number of scores * log).
std::vector<Curve> find_curves(const Results& results);
/// The same, where the results' draws are at hand; `summary` becomes theirs by the way, so that they are read once.
std::vector<Curve> find_curves(const Results& results, std::span<const DrawValues> draws, Summary& summary);

}  // namespace tumble::scenarios
