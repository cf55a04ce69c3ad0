// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/estimates/method.hpp"

namespace tumble::scenarios {

/// Sense states which values of a metric are better: lower (errors), higher (overlap), or closer to a target
/// (`two_sided`: coverage, normalised errors). Metrics with the sense `none` are not ranked (costs, counts, properties
/// of the reference).
enum class Sense { lower, higher, two_sided, none };

/// The unit `verdict` means 1 for a failure, otherwise 0. The unit `time_offset` means a signed time that is stored in
/// seconds and displayed in milliseconds.
enum class Unit { number, share, verdict, rad, rad_s, m, m_s, m_s2, s, time_offset, mib };
const char* symbol(Unit unit);

/// Compared states how the metric values of two methods on one simulated run are compared: by ratio (errors, normalised
/// errors) or by difference (fractions, signed values).
enum class Compared { by_ratio, by_difference };

/// Place states where a metric is used:
/// - `detail`: `tumble report --all` prints the metric.
/// - `held`: a regression gate (sweep/gate.hpp) also compares new values of the metric with accepted values.
/// - `headline`: the report page also shows the metric at its start.
enum class Place { detail, held, headline };

inline constexpr double kNoTarget = std::numeric_limits<double>::quiet_NaN();

struct MetricInfo {
  std::string name;  ///< ends in the unit
  Unit unit = Unit::number;
  std::string doc;
  Sense sense = Sense::none;
  Place place = Place::detail;
  double target = kNoTarget;  ///< target of a two-sided metric
  Compared compared = Compared::by_ratio;
  /// The status `diverged`, by which a method reports a wrong estimate, is no failure for this metric.
  bool excuses_reported_runs = false;

  /// Returns true if the value 1 of this metric marks a failed run. Verdicts on the health report have the sense
  /// `none`, because a wrong estimate is not a failed run.
  bool marks_failure() const { return unit == Unit::verdict && sense == Sense::lower; }
};

const MetricInfo& metric_info(const std::string& name);

struct MetricStyle {
  std::string unit;
  double factor = 1.0;
};
MetricStyle style_of(Unit unit);

std::string sense_text(const MetricInfo& metric);

bool is_better(const MetricInfo& metric, double a, double b);

/// Returns a number that is larger for a worse value of a metric. If lower values are better, the result is the value.
/// If higher values are better, the result is the negative value. For a metric with a target, the result is the
/// distance from the target; if value and target are positive, the distance is a difference of logarithms. For an
/// unranked metric, the result is NaN.
double how_bad(const MetricInfo& metric, double value);

/// Returns the value that a failed run gets: infinity if lower values are better, minus infinity if higher values are
/// better, and NaN for two-sided and unranked metrics.
double worst_value(const MetricInfo& metric);

std::vector<std::string> headline_metrics(Kind kind);
std::vector<std::string> held_metrics(Kind kind);

const MetricInfo& estimate_cost();

bool is_cost(std::string_view name);

}  // namespace tumble::scenarios
