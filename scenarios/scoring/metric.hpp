// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

/// metric.hpp defines the description of a metric. Tables, reports, gates and triage use only this description.
namespace tumble::scenarios {

/// Sense states which values of a metric are better: lower (errors), higher (overlap), or closer to a target
/// (`two_sided`: coverage, normalised errors). Metrics with the sense `none` are not ranked (costs, counts, properties
/// of the reference).
enum class Sense { lower, higher, two_sided, none };

/// Unit is the unit in which the values of a metric are stored. A `share` is in [0, 1]. A `verdict` is 0, or 1 for a
/// failure; only the fraction of failures over many runs is meaningful. A `time_offset` is signed, stored in seconds
/// and displayed in milliseconds.
enum class Unit { number, share, verdict, rad, rad_s, m, m_s, m_s2, s, time_offset, mib };
/// Returns the unit at the end of metric names: "1", "rad", "rad/s", …
const char* symbol(Unit unit);

/// Compared states how a gate compares two values on one simulated run: by ratio (errors, normalised errors) or by
/// difference (fractions, signed values).
enum class Compared { by_ratio, by_difference };

/// Place states where a metric appears: only in the full table, also in gates, or also first in the report.
enum class Place { detail, held, headline };

/// Target of a metric that is not two-sided.
inline constexpr double kNoTarget = std::numeric_limits<double>::quiet_NaN();

/// MetricInfo describes a metric or a similar quantity of a simulated run.
struct MetricInfo {
  std::string name;  ///< name, which ends in the unit
  Unit unit = Unit::number;
  std::string doc;
  Sense sense = Sense::none;
  Place place = Place::detail;
  double target = kNoTarget;  ///< target of a two-sided metric
  Compared compared = Compared::by_ratio;
};

/// Returns the description of a metric, a cost or a motion value. For a binned metric, returns that of the unbinned
/// metric. For an unknown name, for example from a database of another version, returns a description with Sense::none.
const MetricInfo& metric_info(const std::string& name);

/// MetricStyle states how a metric is displayed: the SI value times `factor`, with `unit`. Degrees and percent are only
/// for display.
struct MetricStyle {
  std::string unit;
  double factor = 1.0;
};
MetricStyle style_of(Unit unit);

/// Describes which values are better: "lower is better", "higher is better", "best near 1" or "no contest".
std::string sense_text(const MetricInfo& metric);

/// Returns true if `a` is better than `b`; false for unranked metrics and NaN. For a metric with a target, the closer
/// value is better; closeness is a ratio if both values are positive.
bool is_better(const MetricInfo& metric, double a, double b);

/// Returns the badness of a value, for paired differences: the value if lower is better, the negative value if higher
/// is better, or the distance from the target. If value and target are positive, the distance is a difference of
/// logarithms. For an unranked metric, the badness is NaN.
double how_bad(const MetricInfo& metric, double value);

/// Returns the value of a failed run: infinity, or minus infinity if higher is better. For two-sided and unranked
/// metrics, it is NaN, which statistics ignore.
double worst_value(const MetricInfo& metric);

/// headline_metrics returns the most important metrics of a kind; held_metrics returns all metrics that gates compare.
/// Both functions return metrics in order of registration.
std::vector<std::string> headline_metrics(Kind kind);
std::vector<std::string> held_metrics(Kind kind);

}  // namespace tumble::scenarios
