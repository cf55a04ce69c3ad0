// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/scoring/cost.hpp"
#include "tools/pictures/colours.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::Kind;
using scenarios::MethodSummary;
using scenarios::MetricStyle;
using scenarios::MetricSummary;
using scenarios::Section;
using scenarios::Summary;

json axis(const std::string& title) {
  return {{"title", {{"text", title}}}};
}

std::string transparent(Colour colour, double opacity) {
  const auto rgba = colour.rgba();
  return fmt::format("rgba({:.0f},{:.0f},{:.0f},{})", 255.0f * rgba[0], 255.0f * rgba[1], 255.0f * rgba[2], opacity);
}

json box(const std::string& name, std::size_t index) {
  const Colour own = method_colour(index);
  const std::size_t round = colour_round(index);
  return {{"type", "box"},
          {"name", plot_text(name)},
          {"boxpoints", "all"},
          {"jitter", 0.5},
          {"pointpos", 0},
          {"whiskerwidth", 0.4},
          {"marker", {{"color", own.hex}, {"size", 6}, {"opacity", 0.7}, {"symbol", symbol_of_round(round)}}},
          {"fillcolor", transparent(own, filling_of_round(round))},
          {"line", {{"color", own.hex}, {"width", 1.5}}},
          {"x", json::array()},
          {"y", json::array()}};
}

void add_values(json& trace, const std::string& group, const MetricSummary& metric, double factor) {
  for (const double value : at_most(metric.values, kBoxPoints)) {
    trace["x"].push_back(plot_text(group));
    trace["y"].push_back(five_digits(value * factor));
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

/// Box plots of one metric: one box per method, grouped by scenario.
class Boxes {
 public:
  explicit Boxes(const std::string& metric) : metric_(metric), style_(scenarios::metric_style(metric)) {}

  void add(const Section& section, const std::string& prefix) {
    for (const MethodSummary& method : section.methods) {
      const MetricSummary* values = method.find(metric_);
      if (values == nullptr || values->values.empty()) continue;
      const std::string name = prefix + method.method;
      auto trace = std::find_if(traces_.begin(), traces_.end(), [&](const auto& t) { return t.first == name; });
      if (trace == traces_.end()) {
        traces_.emplace_back(name, box(name, traces_.size()));
        trace = traces_.end() - 1;
      }
      add_values(trace->second, section.scenario, *values, style_.factor);
    }
  }

  /// Uses a logarithmic axis if values are positive and span more than a decade. Otherwise the axis starts at 0 if
  /// `from_zero` is set, or at the smallest value.
  void put_into(Figure& figure, bool from_zero) const {
    json data = json::array();
    for (const auto& [name, trace] : traces_) data.push_back(trace);
    json layout = {{"boxmode", "group"},
                   {"xaxis", {{"type", "category"}}},
                   {"yaxis", axis(plot_text(metric_) + (style_.unit.empty() ? "" : " [" + style_.unit + "]"))}};
    if (wants_log(data))
      layout["yaxis"]["type"] = "log";
    else if (from_zero)
      layout["yaxis"]["rangemode"] = "tozero";
    set_plot(data, layout, figure);
  }

 private:
  std::string metric_;
  MetricStyle style_;
  std::vector<std::pair<std::string, json>> traces_;
};

bool holds_more_than_shown(const Summary& summary, Kind kind, const std::string& metric) {
  for (const Section& section : summary.sections) {
    if (section.kind != kind) continue;
    for (const MethodSummary& method : section.methods) {
      const MetricSummary* values = method.find(metric);
      if (values != nullptr && values->values.size() > kBoxPoints) return true;
    }
  }
  return false;
}

/// Shades an interval of x over the whole height, behind the lines.
json shaded(double begin, double end) {
  return {{"type", "rect"},
          {"xref", "x"},
          {"yref", "paper"},
          {"x0", begin},
          {"x1", end},
          {"y0", 0},
          {"y1", 1},
          {"layer", "below"},
          {"fillcolor", "rgba(213,94,0,0.15)"},
          {"line", {{"width", 0}}}};
}

const char* dash_of(const PlotLine& line) {
  if (line.dotted) return "dot";
  return dash_of_round(line.colour < 0 ? 0 : colour_round(static_cast<std::size_t>(line.colour)));
}

/// NaN marks a gap.
json coordinates(const std::vector<double>& values) {
  json out = json::array();
  for (const double value : values) out.push_back(std::isfinite(value) ? json(value) : json());
  return out;
}

}  // namespace

void set_plot(const json& traces, const json& layout, Figure& figure) {
  const auto text = [](const json& value) { return value.dump(-1, ' ', false, json::error_handler_t::replace); };
  figure.traces = traces.empty() ? "" : text(traces);
  figure.layout = text(layout);
}

double five_digits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 4 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  return std::round(value * scale) / scale;
}

std::string plot_text(const std::string& text) {
  std::string out;
  for (const char c : text) out += c == '&' ? "&amp;" : c == '<' ? "&lt;" : c == '>' ? "&gt;" : std::string(1, c);
  return out;
}

std::vector<double> at_most(std::vector<double> values, std::size_t most) {
  if (values.size() <= most) return values;
  std::sort(values.begin(), values.end());
  std::vector<double> out;
  for (std::size_t i = 0; i < most; ++i) out.push_back(values[i * (values.size() - 1) / (most - 1)]);
  return out;
}

Colour colour_of(int colour) {
  return colour < 0 ? truth_colour() : method_colour(static_cast<std::size_t>(colour));
}

const char* symbol_of_round(std::size_t round) {
  static constexpr std::array kShapes = {"circle", "diamond", "cross", "triangle-up", "square", "x", "star"};
  return kShapes[round % kShapes.size()];
}

const char* dash_of_round(std::size_t round) {
  static constexpr std::array kDashes = {"solid", "dash", "dashdot", "longdash"};
  return kDashes[round % kDashes.size()];
}

double filling_of_round(std::size_t round) {
  static constexpr std::array kShares = {0.0, 0.45, 0.9};
  return kShares[round % kShares.size()];
}

Figure box_figure(const Summary& summary, Kind kind, const std::string& metric, const std::string& caption) {
  Figure figure;
  figure.id = std::string(to_string(kind)) + "-" + metric;
  figure.caption = caption;
  if (holds_more_than_shown(summary, kind, metric))
    figure.caption +=
        fmt::format(" For a box with more draws, {} points are drawn, at equal steps of rank.", kBoxPoints);
  Boxes boxes(metric);
  for (const Section& section : summary.sections) {
    if (section.kind == kind) boxes.add(section, "");
  }
  boxes.put_into(figure, true);
  return figure;
}

Figure cost_figure(const Summary& summary) {
  Figure figure;
  figure.id = "cost";
  figure.caption =
      "CPU time of one estimate. Each draw is one point; a box has at most " + std::to_string(kBoxPoints) + " points.";
  Boxes boxes(scenarios::estimate_cost().name);
  for (const Section& section : summary.sections) boxes.add(section, std::string(to_string(section.kind)) + "/");
  boxes.put_into(figure, false);
  return figure;
}

Figure figure_of(const Plot& plot, const std::string& id) {
  Figure figure;
  figure.id = id;
  figure.caption = plot.caption;
  json data = json::array();
  for (const PlotLine& line : plot.lines) {
    json trace = {{"type", "scatter"},
                  {"mode", "lines"},
                  {"name", plot_text(line.name)},
                  {"line", {{"color", colour_of(line.colour).hex}, {"width", line.width}, {"dash", dash_of(line)}}},
                  {"x", coordinates(line.x)},
                  {"y", coordinates(line.y)}};
    if (line.hidden) trace["visible"] = "legendonly";
    data.push_back(std::move(trace));
  }
  json layout = {{"xaxis", axis(plot_text(plot.x_title))}, {"yaxis", axis(plot_text(plot.y_title))}};
  if (plot.equal_scales) layout["yaxis"]["scaleanchor"] = "x";
  if (plot.from_zero) layout["yaxis"]["rangemode"] = "tozero";
  if (plot.over_time) layout["hovermode"] = "x unified";
  for (const auto& [begin, end] : plot.shaded) layout["shapes"].push_back(shaded(begin, end));
  set_plot(data, layout, figure);
  return figure;
}

}  // namespace tumble::tools
