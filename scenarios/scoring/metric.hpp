// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"

/// What there is to know of a metric apart from its value: one description per metric, given where it is registered.
/// Table, report, gate and triage ask it and know no metric by name.
namespace tumble::scenarios {

/// Whether lower is better (errors), higher is (overlap), a target lies between (coverage of an interval, normalised
/// errors), or there is no contest (costs, counts, properties of the reference).
enum class Sense { lower, higher, two_sided, none };

/// Unit of the stored values. `share` lies in [0, 1]; `verdict` is 0 or 1 on each draw, 1 the bad one: its share over
/// the draws says something, its median does not. `time_offset` is in seconds, has a sign and is small: shown in
/// milliseconds.
enum class Unit { number, share, verdict, rad, rad_s, m, m_s, m_s2, s, time_offset, mib };
/// As metrics' names end: "1", "rad", "rad/s" ...
const char* symbol(Unit unit);

/// What two values of a metric on one draw differ by, for the gate: by their ratio (errors, normalised errors), or by
/// their difference (shares of a whole, and what has a sign).
enum class Compared { by_ratio, by_difference };

/// Whether a metric is shown first, is held by the gate besides, or stands in the long table alone.
enum class Place { detail, held, headline };

/// Of a metric whose sense is not two-sided.
inline constexpr double kNoTarget = std::numeric_limits<double>::quiet_NaN();

/// A metric, or another quantity of a draw that is shown as metrics are, self-describing.
struct MetricInfo {
  std::string name;  ///< ends in its unit
  Unit unit = Unit::number;
  std::string doc;
  Sense sense = Sense::none;
  Place place = Place::detail;
  double target = kNoTarget;  ///< of a two-sided one
  Compared compared = Compared::by_ratio;
};

/// The description of what is called `name`: a metric, its base when it is of a bin, a cost, a value of the motion.
/// What nobody registered (a database of another version) is a number without sense.
const MetricInfo& metric_info(const std::string& name);

/// How to show values: SI values times `factor` in `unit`. Degrees and percent are for people and appear only where
/// results are shown.
struct MetricStyle {
  std::string unit;
  double factor = 1.0;
};
MetricStyle style_of(Unit unit);

/// "lower is better", "higher is better", "best near 1", "no contest".
std::string sense_text(const MetricInfo& metric);

/// Whether `a` is better than `b`; never where there is no contest, nor where either is NaN. With a target, what lies
/// nearer to it, as a ratio where both are positive.
bool is_better(const MetricInfo& metric, double a, double b);

/// How bad a value is, for differences of pairs: the value itself where lower is better, its negative where higher is,
/// the distance from the target (of the logarithms where both are positive), NaN where there is no contest.
double how_bad(const MetricInfo& metric, double value);

/// The value that a run without one ranks as: infinite, or minus infinite where higher is better. NaN, which no
/// statistic counts, where there is no worst: two-sided and none.
double worst_value(const MetricInfo& metric);

/// The metrics that say most about a kind, in the order of registration; and those that the gate holds, these included.
std::vector<std::string> headline_metrics(Kind kind);
std::vector<std::string> held_metrics(Kind kind);

}  // namespace tumble::scenarios
