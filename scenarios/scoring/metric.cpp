// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/metric.hpp"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <numbers>

#include "scenarios/scoring/binned_metric.hpp"
#include "scenarios/scoring/families.hpp"

namespace tumble::scenarios {

namespace {

std::map<std::string, MetricInfo> all_infos() {
  std::map<std::string, MetricInfo> all;
  for (const Metric& metric : metrics()) all.emplace(metric.info.name, metric.info);
  for (const auto& family : {cost_quantities(), motion_quantities(), binned_rate_quantities()}) {
    for (const MetricInfo& info : family) all.emplace(info.name, info);
  }
  return all;
}

std::vector<std::string> metrics_from(Kind kind, Place least) {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) {
    if (metric.kind == kind && metric.info.place >= least) names.push_back(metric.info.name);
  }
  return names;
}

double distance(double value, double target) {
  return value > 0.0 && target > 0.0 ? std::abs(std::log(value / target)) : std::abs(value - target);
}

}  // namespace

const char* symbol(Unit unit) {
  switch (unit) {
    case Unit::number:
    case Unit::share:
    case Unit::verdict:
      return "1";
    case Unit::rad:
      return "rad";
    case Unit::rad_s:
      return "rad/s";
    case Unit::m:
      return "m";
    case Unit::m_s:
      return "m/s";
    case Unit::m_s2:
      return "m/s2";
    case Unit::s:
    case Unit::time_offset:
      return "s";
    case Unit::mib:
      return "mib";
  }
  return "";
}

const MetricInfo& metric_info(const std::string& name) {
  static const std::map<std::string, MetricInfo> all = all_infos();
  static const MetricInfo unknown;
  if (const auto found = all.find(name); found != all.end()) return found->second;
  const auto binned = parse_binned(name);
  return binned ? metric_info(binned->base) : unknown;
}

MetricStyle style_of(Unit unit) {
  switch (unit) {
    case Unit::number:
      return {"", 1.0};
    case Unit::share:
    case Unit::verdict:
      return {"%", 100.0};
    case Unit::rad:
      return {"°", 180.0 / std::numbers::pi};
    case Unit::m_s2:
      return {"m/s²", 1.0};
    case Unit::time_offset:
      return {"ms", 1e3};
    case Unit::mib:
      return {"MiB", 1.0};
    case Unit::rad_s:
    case Unit::m:
    case Unit::m_s:
    case Unit::s:
      break;
  }
  return {symbol(unit), 1.0};
}

std::string sense_text(const MetricInfo& metric) {
  switch (metric.sense) {
    case Sense::lower:
      return "lower is better";
    case Sense::higher:
      return "higher is better";
    case Sense::two_sided:
      return fmt::format("best near {:g}", metric.target);
    case Sense::none:
      break;
  }
  return "not compared";
}

bool is_better(const MetricInfo& metric, double a, double b) {
  switch (metric.sense) {
    case Sense::lower:
      return a < b;
    case Sense::higher:
      return a > b;
    case Sense::two_sided:
      return distance(a, metric.target) < distance(b, metric.target);
    case Sense::none:
      break;
  }
  return false;
}

double how_bad(const MetricInfo& metric, double value) {
  switch (metric.sense) {
    case Sense::lower:
      return value;
    case Sense::higher:
      return -value;
    case Sense::two_sided:
      return distance(value, metric.target);
    case Sense::none:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double worst_value(const MetricInfo& metric) {
  if (metric.sense == Sense::lower) return std::numeric_limits<double>::infinity();
  if (metric.sense == Sense::higher) return -std::numeric_limits<double>::infinity();
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<std::string> headline_metrics(Kind kind) {
  return metrics_from(kind, Place::headline);
}

std::vector<std::string> held_metrics(Kind kind) {
  return metrics_from(kind, Place::held);
}

}  // namespace tumble::scenarios
