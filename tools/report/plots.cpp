// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/plots.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "tools/report/pictures.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::Kind;

/// Five significant digits are more than a plot can show, and keep the page small.
double rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 4 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  return std::round(value * scale) / scale;
}

json axis(const std::string& title) {
  return {{"title", {{"text", title}}}};
}

json box(const std::string& name, const char* colour) {
  return {{"type", "box"},
          {"name", name},
          {"boxpoints", "all"},
          {"jitter", 0.5},
          {"pointpos", 0},
          {"whiskerwidth", 0.4},
          {"marker", {{"color", colour}, {"size", 6}, {"opacity", 0.7}}},
          {"fillcolor", "rgba(0,0,0,0)"},
          {"line", {{"color", colour}, {"width", 1.5}}},
          {"x", json::array()},
          {"y", json::array()}};
}

void add_values(json& trace, const std::string& group, const MetricSummary& metric, double factor) {
  for (const double value : metric.values) {
    trace["x"].push_back(group);
    trace["y"].push_back(rounded(value * factor));
  }
}

bool wants_log(const json& traces) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const json& trace : traces) {
    for (const json& value : trace["y"]) {
      low = std::min(low, value.get<double>());
      high = std::max(high, value.get<double>());
    }
  }
  return low > 0.0 && high > 10.0 * low;
}

json line(const std::string& name, const char* colour, double width, const char* dash = "solid") {
  return {{"type", "scatter"},  {"mode", "lines"},
          {"name", name},       {"line", {{"color", colour}, {"width", width}, {"dash", dash}}},
          {"x", json::array()}, {"y", json::array()}};
}

/// The gyro axis with most clipped samples by the estimates' own flags; -1 when none has any.
int most_clipped_axis(const std::vector<RateState>& rates) {
  std::array<int, 3> count = {0, 0, 0};
  for (const RateState& rate : rates) {
    for (int axis = 0; axis < 3; ++axis) count[static_cast<std::size_t>(axis)] += (rate.clipped_axes >> axis) & 1;
  }
  const auto most = std::max_element(count.begin(), count.end());
  return *most == 0 ? -1 : static_cast<int>(most - count.begin());
}

int most_clipped_axis(const Example& example) {
  for (std::size_t i = 0; i < example.run.methods.size(); ++i) {
    if (example.run.methods[i]->info.kind != Kind::rate) continue;
    const int found = most_clipped_axis(example.run.estimates[i].rates);
    if (found >= 0) return found;
  }
  return -1;
}

void add_path(json& trace, const Path& path, std::size_t points_max) {
  const std::size_t stride = path.points_W_m.size() / points_max + 1;
  for (std::size_t k = 0; k < path.points_W_m.size(); k += stride) {
    trace["x"].push_back(rounded(path.points_W_m[k].x()));
    trace["y"].push_back(rounded(path.points_W_m[k].y()));
  }
}

}  // namespace

Figure box_figure(const Summary& summary, Kind kind, const std::string& metric, const std::string& caption) {
  Figure figure;
  figure.id = std::string(to_string(kind)) + "-" + metric;
  figure.caption = caption;
  const MetricStyle style = metric_style(metric);
  std::vector<std::pair<std::string, json>> traces;
  for (const Section& section : summary.sections) {
    if (section.kind != kind) continue;
    for (const MethodSummary& method : section.methods) {
      const MetricSummary* values = method.find(metric);
      if (values == nullptr || values->values.empty()) continue;
      auto trace = std::find_if(traces.begin(), traces.end(), [&](const auto& t) { return t.first == method.method; });
      if (trace == traces.end()) {
        traces.emplace_back(method.method, box(method.method, method_colour(traces.size()).hex));
        trace = traces.end() - 1;
      }
      add_values(trace->second, section.scenario, *values, style.factor);
    }
  }
  for (auto& [name, trace] : traces) figure.data.push_back(std::move(trace));
  figure.layout = {{"boxmode", "group"},
                   {"xaxis", {{"type", "category"}}},
                   {"yaxis", axis(metric + (style.unit.empty() ? "" : " [" + style.unit + "]"))}};
  if (wants_log(figure.data)) {
    figure.layout["yaxis"]["type"] = "log";
  } else {
    figure.layout["yaxis"]["rangemode"] = "tozero";
  }
  return figure;
}

Figure cost_figure(const Summary& summary) {
  Figure figure;
  figure.id = "cost";
  figure.caption = "CPU time of one estimate. One point per draw.";
  std::vector<std::pair<std::string, json>> traces;
  for (const Section& section : summary.sections) {
    for (const MethodSummary& method : section.methods) {
      const MetricSummary* values = method.find("estimate_cpu_s");
      if (values == nullptr || values->values.empty()) continue;
      const std::string name = std::string(to_string(section.kind)) + "/" + method.method;
      auto trace = std::find_if(traces.begin(), traces.end(), [&](const auto& t) { return t.first == name; });
      if (trace == traces.end()) {
        traces.emplace_back(name, box(name, method_colour(traces.size()).hex));
        trace = traces.end() - 1;
      }
      add_values(trace->second, section.scenario, *values, 1.0);
    }
  }
  for (auto& [name, trace] : traces) figure.data.push_back(std::move(trace));
  figure.layout = {{"boxmode", "group"}, {"xaxis", {{"type", "category"}}}, {"yaxis", axis("estimate_cpu_s [s]")}};
  if (wants_log(figure.data)) figure.layout["yaxis"]["type"] = "log";
  return figure;
}

Figure rate_figure(const Example& example) {
  Figure figure;
  figure.id = "rate-" + example.run.situation.scenario;
  const int axis_index = most_clipped_axis(example);
  const sim::Recording& recording = example.run.recording;
  if (axis_index < 0 || recording.truth.imus.empty()) return figure;
  const char* axis_name = std::array<const char*, 3>{"x", "y", "z"}[static_cast<std::size_t>(axis_index)];
  const Span span = moving_span(recording.truth, 0.3);

  const sim::ImuRecord& imu = recording.sensors.imus.front();
  const sim::ImuTruth& truth = recording.truth.imus.front();
  json true_rate = line("truth", truth_colour().hex, 3.5);
  for (std::size_t k = 0; k < imu.time_ns.size() && k < truth.rate_rad_s.size(); ++k) {
    if (imu.time_ns[k] < span.begin_ns || imu.time_ns[k] > span.end_ns) continue;
    true_rate["x"].push_back(rounded(seconds(imu.time_ns[k])));
    true_rate["y"].push_back(rounded(truth.rate_rad_s[k][axis_index]));
  }
  figure.data.push_back(std::move(true_rate));
  std::size_t index = 0;
  for (std::size_t i = 0; i < example.run.methods.size(); ++i) {
    const scenarios::MethodInfo& info = example.run.methods[i]->info;
    if (info.kind != Kind::rate) continue;
    json trace = line(info.name == "raw" ? "raw (what the gyro says)" : info.name, method_colour(index++).hex, 1.6,
                      info.needs_truth ? "dot" : "solid");
    if (info.needs_truth) trace["visible"] = "legendonly";
    for (const RateState& rate : example.run.estimates[i].rates) {
      if (rate.time_ns < span.begin_ns || rate.time_ns > span.end_ns) continue;
      trace["x"].push_back(rounded(seconds(rate.time_ns)));
      const double value = rate.w_WI_I_rad_s[axis_index];
      trace["y"].push_back(std::isfinite(value) ? json(rounded(value)) : json());
    }
    figure.data.push_back(std::move(trace));
  }
  figure.caption =
      std::string("Angular velocity about the sensor's ") + axis_name +
      " axis, the one that clips most. Where the gyro is flat it is at its rail; drag to zoom, double-click to return.";
  figure.layout = {{"xaxis", axis("time [s]")}, {"yaxis", axis("rate [rad/s]")}, {"hovermode", "x unified"}};
  return figure;
}

Figure path_figure(const Example& example) {
  Figure figure;
  figure.id = "path-" + example.run.situation.scenario;
  const sim::Recording& recording = example.run.recording;
  if (recording.truth.p_WB_m.empty()) return figure;
  const Path way = true_path(recording.sensors, recording.truth, 1);
  json truth = line("truth", truth_colour().hex, 3.5);
  add_path(truth, way, 600);
  figure.data.push_back(std::move(truth));
  bool cut = false;
  for (std::size_t i = 0; i < example.paths.size(); ++i) {
    json trace = line(example.path_methods[i], method_colour(i).hex, 1.8);
    const Path shown = near_truth(example.paths[i], way);
    cut = cut || shown.points_W_m.size() < example.paths[i].points_W_m.size();
    add_path(trace, shown, 600);
    figure.data.push_back(std::move(trace));
  }
  figure.caption = "The way seen from above, at equal scales. Estimates start where the truth does.";
  if (cut) figure.caption += " A path that runs away from the truth ends where it leaves the picture.";
  figure.layout = {{"xaxis", axis("x [m]")}, {"yaxis", axis("y [m]")}};
  figure.layout["yaxis"]["scaleanchor"] = "x";
  return figure;
}

}  // namespace tumble::tools
