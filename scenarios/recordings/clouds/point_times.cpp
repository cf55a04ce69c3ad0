// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/clouds/sweep_builder.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "scenarios/text.hpp"
#include "sim/parameters.hpp"
#include "tumble_ros/point_fields.hpp"

namespace tumble::scenarios {

namespace {

/// The point times of a sweep must cover a fraction of the sweep period between 0.02 (a sector of 7 degrees) and 1.5
/// (some overlap). Time units differ by factors of 1000, so the times of a sweep fit at most one unit.
constexpr double kSpanMin = 0.02, kSpanMax = 1.5, kShortSpanMin = kSpanMax / 1000.0;
/// Times after 1973, in seconds since 1970, exceed 1e8.
constexpr double kEpochMin_s = 1e8;
/// A sweep with fewer than 100 points may cover only a short part of the sweep period. Therefore, a short time span of
/// a sweep with fewer than 100 points does not contradict the stated time unit.
constexpr double kPointsThatSpan = 100.0;

/// If two of at least five clouds have point times more than two sweep periods from zero, the point times count as
/// absolute.
constexpr std::size_t kCloudsToCompare = 5;

using tumble::ros::kTimeUnits, tumble::ros::TimeUnit, tumble::ros::stated_unit;

std::string_view name_of(const TimeUnit& unit) {
  return unit.suffix.substr(1);
}

std::string choose_field(const Cloud& cloud, const SweepReading& reading, const std::string& where) {
  if (!reading.time_field.empty()) {
    if (cloud.find(reading.time_field) != nullptr) return reading.time_field;
    std::string all;
    for (const std::string& name : cloud.names) all += " " + name;
    const std::string near = sim::did_you_mean(reading.time_field, cloud.names);
    throw WrongOption(fmt::format("{}: the points have no field '{}'{} (existing fields:{})", where, reading.time_field,
                                  near.empty() ? "" : " (" + near + ")", all));
  }
  tumble::ros::TimeFieldChoice choice;
  for (const std::string& name : cloud.names) choice.offer(name);
  if (!choice.rival.empty()) {
    throw BadInput(fmt::format("{}: the fields '{}' and '{}' may both be point times; select one with --time-field",
                               where, choice.field, choice.rival));
  }
  return choice.field;
}

/// A point time counts as damaged if its distance from the median exceeds 20 interquartile ranges.
constexpr double kDamaged = 20.0;

std::pair<double, double> reach(const Cloud& cloud, const std::string& field) {
  std::pair<double, double> out(INFINITY, -INFINITY);
  const std::vector<double>* times = cloud.find(field);
  if (times == nullptr) return out;
  std::vector<double> finite;
  std::ranges::copy_if(*times, std::back_inserter(finite), [](double time) { return std::isfinite(time); });
  if (finite.empty()) return out;
  const auto quantile = [&](std::size_t quarter) {
    const auto at = finite.begin() + static_cast<std::ptrdiff_t>((finite.size() - 1) * quarter / 4);
    std::nth_element(finite.begin(), at, finite.end());
    return *at;
  };
  const double middle = quantile(2), range = quantile(3) - quantile(1);
  for (const double time : finite) {
    if (range > 0.0 && std::abs(time - middle) > kDamaged * range) continue;
    out.first = std::min(out.first, time);
    out.second = std::max(out.second, time);
  }
  return out;
}

bool fits(double span, const TimeUnit& unit, double period_ns, double least = kSpanMin) {
  return span * unit.ns > least * period_ns && span * unit.ns <= kSpanMax * period_ns;
}

std::string share_of(double span, const TimeUnit& unit, double period_ns) {
  std::string text = fmt::format("in {} this is ", name_of(unit));
  append_number(text, static_cast<float>(100.0 * span * unit.ns / period_ns));
  return fmt::format("{} % of the sweep period", text);
}

void require_no_other_unit(const TimeUnit& stated, double span, double period_ns, const std::string& field,
                           const std::string& where) {
  if (!(period_ns > 0.0) || fits(span, stated, period_ns)) return;
  const auto* read = std::find_if(kTimeUnits.begin(), kTimeUnits.end(),
                                  [&](const TimeUnit& each) { return fits(span, each, period_ns); });
  if (read == kTimeUnits.end()) return;
  std::string range;
  append_number(range, span);
  throw BadInput(fmt::format(
      "{}: the point times in field '{}' have the stated unit {} and a range of {} in a sweep: {}, {}; check the unit",
      where, field, name_of(stated), range, share_of(span, stated, period_ns), share_of(span, *read, period_ns)));
}

double unit_by_size(double span, double largest, double period_ns, const std::string& field, const std::string& where) {
  for (const TimeUnit& unit : kTimeUnits) {
    if (period_ns > 0.0 && fits(span, unit, period_ns, kShortSpanMin)) return unit.ns;
    if (!(period_ns > 0.0) && largest >= kEpochMin_s * 1e9 / unit.ns && largest < kEpochMin_s * 1e12 / unit.ns)
      return unit.ns;
  }
  std::string range, period;
  append_number(range, span);
  append_number(period, period_ns * 1e-6);
  if (!(period_ns > 0.0)) {
    throw BadInput(
        fmt::format("{}: the unit of the point times in field '{}' is unknown: the times of a sweep have a range of "
                    "{}, and the sweep period is unknown. State the times of the sweeps (--times), or the duration of "
                    "one sweep (--sweep-period)",
                    where, field, range));
  }
  throw BadInput(fmt::format(
      "{}: the point times in field '{}' have a range of {} in a sweep, which fits none of the units s, ms, us and ns. "
      "The range must be 0.15 to 150 % of the sweep period ({} ms). State the unit (--time-unit)",
      where, field, range, period));
}

}  // namespace

PointTimeRule find_point_times(const std::vector<Cloud>& first, std::int64_t period_ns, const SweepReading& reading,
                               const std::string& where) {
  PointTimeRule rule;
  if (reading.not_skewed) return rule;
  std::vector<double> spans, points;
  double largest = 0.0;
  for (const Cloud& cloud : first) {
    if (cloud.points == 0) continue;
    if (rule.field.empty()) rule.field = choose_field(cloud, reading, where);
    const auto [begin, end] = reach(cloud, rule.field);
    if (!(end >= begin)) continue;
    spans.push_back(end - begin);
    points.push_back(static_cast<double>(cloud.points));
    largest = std::max({largest, std::abs(begin), std::abs(end)});
  }
  if (rule.field.empty() || spans.empty()) return {};
  const bool stamped = period_ns > 0 && !(reading.assumed && largest >= kEpochMin_s);
  if (stamped && std::ranges::max(spans) == 0.0 && upper_median(points) > 1.0) {
    rule.field.clear();
    rule.constant = true;
    return rule;
  }
  const std::string unit = reading.time_unit;
  const auto* named =
      std::find_if(kTimeUnits.begin(), kTimeUnits.end(), [&](const TimeUnit& each) { return unit == name_of(each); });
  const double span = upper_median(spans), period = static_cast<double>(period_ns);
  if (!unit.empty() && named == kTimeUnits.end())
    throw WrongOption(fmt::format("the unit of point times is '{}'; it must be s, ms, us or ns", unit));
  if (unit.empty()) named = stated_unit(rule.field);
  if (named != nullptr && named != kTimeUnits.end() && upper_median(points) >= kPointsThatSpan)
    require_no_other_unit(*named, span, period, rule.field, where);
  rule.unit_ns = named != nullptr && named != kTimeUnits.end() ? named->ns
                                                               : unit_by_size(span, largest, period, rule.field, where);
  rule.short_span = upper_median(points) >= kPointsThatSpan && period > 0.0 && span * rule.unit_ns <= kSpanMin * period;
  std::size_t far = 0;
  for (const Cloud& cloud : first) {
    const auto [begin, end] = reach(cloud, rule.field);
    const double bound = period_ns > 0 ? 2.0 * period : kEpochMin_s * 1e9;
    if (end >= begin && std::abs(begin) * rule.unit_ns > bound) ++far;
  }
  rule.absolute = far > (spans.size() >= kCloudsToCompare ? 1 : 0);  // a single cloud may be damaged
  return rule;
}

}  // namespace tumble::scenarios
