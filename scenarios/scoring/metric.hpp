// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

/// The header metric.hpp defines the description that each metric has. Tables, reports, gates and triage use only the
/// description of a metric.
namespace tumble::scenarios {

/// Sense states which values of a metric are better. Lower values are better for errors; higher values are better for
/// overlap. A two-sided metric has a best value, the target: coverage of an interval, normalised errors. A metric with
/// the sense `none` is not ranked (costs, counts, properties of the reference).
enum class Sense { lower, higher, two_sided, none };

/// Unit is the unit in which the values of a metric are stored. A metric in the unit `share` is in [0, 1]. A metric in
/// the unit `verdict` is 0, or 1 for a failure; only the fraction of failures over many runs is meaningful. A metric in
/// the unit `time_offset` is signed, stored in seconds and displayed in milliseconds.
enum class Unit { number, share, verdict, rad, rad_s, m, m_s, m_s2, s, time_offset, mib };
/// Returns the unit at the end of metric names: "1", "rad", "rad/s", …
const char* symbol(Unit unit);

/// Compared states how a gate compares two values of one simulated run: by ratio (errors, normalised errors) or by
/// difference (fractions and signed values).
enum class Compared { by_ratio, by_difference };

/// Place states where a metric appears: first in the report, also in gates, or only in the full table.
enum class Place { detail, held, headline };

/// kNoTarget is the target value of a metric that is not two-sided.
inline constexpr double kNoTarget = std::numeric_limits<double>::quiet_NaN();

/// MetricInfo describes a metric or a similar quantity of a simulated run.
struct MetricInfo {
  std::string name;  ///< ends in its unit
  Unit unit = Unit::number;
  std::string doc;
  Sense sense = Sense::none;
  Place place = Place::detail;
  double target = kNoTarget;  ///< target of a two-sided metric
  Compared compared = Compared::by_ratio;
};

/// Returns the description of a metric, a cost or a motion value. For a binned metric, the function returns the
/// description of the unbinned metric. An unknown name, for example from a database of another version, gets a
/// description with Sense::none.
const MetricInfo& metric_info(const std::string& name);

/// MetricStyle describes how a metric is displayed: the SI value is multiplied by `factor` and displayed in `unit`.
/// Degrees and percent are used only for display.
struct MetricStyle {
  std::string unit;
  double factor = 1.0;
};
MetricStyle style_of(Unit unit);

/// Describes which values are better: "lower is better", "higher is better", "best near 1" or "no contest".
std::string sense_text(const MetricInfo& metric);

/// Returns whether the value `a` is better than `b`; always false for unranked metrics and NaN. For a metric with a
/// target, the value closer to the target is better. If both values are positive, ratios measure the closeness.
bool is_better(const MetricInfo& metric, double a, double b);

/// Converts a value to a badness, for paired differences: the value if lower is better, and the negative value if
/// higher is better. For a metric with a target, the badness is the distance from the target. The badness is a
/// difference of logarithms if value and target are positive. For an unranked metric, the badness is NaN.
double how_bad(const MetricInfo& metric, double value);

/// Returns the value that a failed run gets: infinity, or minus infinity if higher is better. For two-sided and
/// unranked metrics, a failed run gets NaN, which statistics ignore.
double worst_value(const MetricInfo& metric);

/// The function headline_metrics returns the most important metrics of a kind; held_metrics returns all metrics of a
/// kind that gates compare. Both functions return the metrics in order of registration.
std::vector<std::string> headline_metrics(Kind kind);
std::vector<std::string> held_metrics(Kind kind);

}  // namespace tumble::scenarios
