// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/metric.hpp"

#include <fmt/format.h>

#include <algorithm>
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

std::vector<MetricInfo> cost_quantities() {
  return {
      {"estimate_cpu_s", Unit::s, "CPU time of the estimation, without the time for reading and scoring"},
      {"simulate_cpu_s", Unit::s, "CPU time of the simulation"},
      {"estimate_peak_mib", Unit::mib, "peak memory of the estimation, in addition to the memory of the recording"},
  };
}

const MetricInfo& estimate_cost() {
  static const MetricInfo cost = cost_quantities().front();
  return cost;
}

bool is_cost(std::string_view name) {
  static const std::vector<MetricInfo> costs = cost_quantities();
  return std::any_of(costs.begin(), costs.end(), [&](const MetricInfo& cost) { return cost.name == name; });
}

std::vector<MetricInfo> motion_quantities() {
  return {
      {"motion_duration_s", Unit::s, "duration of the recording"},
      {"motion_moving_s", Unit::s, "time between first and last motion"},
      {"motion_path_m", Unit::m, "path length of the centre of mass"},
      {"motion_peak_rate_rad_s", Unit::rad_s, "largest angular velocity"},
      {"motion_peak_accel_m_s2", Unit::m_s2, "maximum true specific force at the IMU"},
      {"motion_flight_share", Unit::share, "share of the motion time without contact"},
      {"motion_impacts", Unit::number, "number of impacts"},
      {"motion_clips", Unit::verdict, "1 if any sample of the primary gyro is clipped, otherwise 0"},
      {"motion_clipped_share", Unit::share, "share of the samples in motion with a clipped gyro axis"},
      {"motion_clipped_samples", Unit::number, "number of samples in motion with a clipped gyro axis"},
      {"motion_clip_depth_max_rad_s", Unit::rad_s,
       "maximum saturation deficit of a gyro axis (true rate minus clipped reading)"},
      {"motion_clip_length_max_s", Unit::s, "duration of the longest segment of clipped samples"},
      {"motion_several_axes_share", Unit::share, "share of the clipped samples with at least two clipped axes"},
      {"motion_cross_axis_share", Unit::share,
       "share of the clipped samples in which the clipping of one axis causes an error on an unclipped axis "
       "(cross-axis error)"},
      {"motion_accel_clipped_share", Unit::share, "share of the samples in motion with a clipped accelerometer axis"},
  };
}

}  // namespace tumble::scenarios
