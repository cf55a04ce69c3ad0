// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "scenarios/statistics/statistics.hpp"
#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::scenarios {

/// CurvePoint is one point of a curve. Failed runs count as the worst values of a metric, so a quantile of the metric
/// can be infinite.
struct CurvePoint {
  double x = 0.0;
  std::string label;  ///< label of a bin: "0.5 – 1"
  std::int64_t draws = 0, failed = 0;
  Interval failed_share{};  ///< Clopper and Pearson, 95 %
  double quantile_25 = 0.0, median = 0.0, quantile_75 = 0.0;
  double worst_5 = 0.0;  ///< 95 % (or 5 %) quantile
};

struct CurveLine {
  std::string method;
  std::vector<CurvePoint> points;  ///< in ascending order of x
};

struct Curve {
  enum class Source { set, samples, draws };
  Source source = Source::set;
  std::string axis;  ///< ends in the unit
  std::string scenario;
  Kind kind = Kind::rate;
  std::string metric;
  std::vector<CurveLine> lines;  ///< in the order of the registry
  std::vector<std::string> bins = {};
};

/// A curve shows a metric as a function of one of these quantities:
///
/// - a varied parameter
/// - the bins of a binned metric
/// - a measure of the gyro clipping of a run, if the runs fill at least three bins of this measure
///
/// A run counts as failed if its status is not `ok`, or if the metric `map_failed` is 1.
std::vector<Curve> find_curves(const Results& results);
std::vector<Curve> find_curves(const Results& results, std::span<const DrawValues> draws, Summary& summary);

}  // namespace tumble::scenarios
