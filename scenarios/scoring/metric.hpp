// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

/// metric.hpp describes each metric once, where the metric is registered. Tables, reports, gates and triage use only
/// this description.
namespace tumble::scenarios {

/// Sense states which values of a metric are better. Lower values are better for errors; higher values are better for
/// overlap. A two-sided metric has a best value, the target (coverage of an interval, normalised errors). Metrics with
/// the sense `none` are not ranked (costs, counts, properties of the reference).
enum class Sense { lower, higher, two_sided, none };

/// Unit is the unit of the stored values of a metric. A metric of unit `share` is in [0, 1]. A metric of unit `verdict`
/// is 0, or 1 for a failure; only the fraction of failures over many runs is meaningful. A metric of unit `time_offset`
/// is signed, stored in seconds and shown in milliseconds.
enum class Unit { number, share, verdict, rad, rad_s, m, m_s, m_s2, s, time_offset, mib };
/// Returns the unit at the end of metric names: "1", "rad", "rad/s", …
const char* symbol(Unit unit);

/// Compared states how the gate compares two values on one simulated run: by ratio (errors, normalised errors) or by
/// difference (fractions and signed values).
enum class Compared { by_ratio, by_difference };

/// Place states where a metric appears: first in the report, also in the gate, or only in the full table.
enum class Place { detail, held, headline };

/// kNoTarget is the target value of a metric that is not two-sided.
inline constexpr double kNoTarget = std::numeric_limits<double>::quiet_NaN();

/// MetricInfo is the description of a metric or of a similar quantity of a simulated run.
struct MetricInfo {
  std::string name;  ///< ends in its unit
  Unit unit = Unit::number;
  std::string doc;
  Sense sense = Sense::none;
  Place place = Place::detail;
  double target = kNoTarget;  ///< target of a two-sided metric
  Compared compared = Compared::by_ratio;
};

/// Returns the description of a metric, cost or motion value. For a binned metric, returns the description of the
/// unbinned metric. An unknown name, from a database of another version, gets a description with Sense::none.
const MetricInfo& metric_info(const std::string& name);

/// MetricStyle is the display style of a metric: SI values are multiplied by `factor` and shown in `unit`. Degrees and
/// percent are used only for display.
struct MetricStyle {
  std::string unit;
  double factor = 1.0;
};
MetricStyle style_of(Unit unit);

/// Returns "lower is better", "higher is better", "best near 1" or "no contest".
std::string sense_text(const MetricInfo& metric);

/// Returns whether `a` is better than `b`; always false for unranked metrics and NaN. For a metric with a target, the
/// value closer to the target is better. If both values are positive, closeness is measured by ratio.
bool is_better(const MetricInfo& metric, double a, double b);

/// Returns a badness for paired differences: the value if lower is better, and the negative value if higher is better.
/// For a metric with a target, the badness is the distance from the target. The distance is between logarithms if value
/// and target are positive. For unranked metrics, the function returns NaN.
double how_bad(const MetricInfo& metric, double value);

/// Returns the value assigned to failed runs: infinity, or minus infinity if higher is better. For two-sided and
/// unranked metrics, the function returns NaN, which statistics ignore.
double worst_value(const MetricInfo& metric);

/// headline_metrics returns the headline metrics of a kind; held_metrics returns all gate metrics of a kind, including
/// the headline metrics. The metrics are in order of registration.
std::vector<std::string> headline_metrics(Kind kind);
std::vector<std::string> held_metrics(Kind kind);

}  // namespace tumble::scenarios
