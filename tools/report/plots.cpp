// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>

#include "scenarios/scoring/metric.hpp"
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

class Boxes {
 public:
  Boxes(const std::string& metric, const Palette& palette)
      : metric_(metric), style_(scenarios::metric_style(metric)), palette_(palette) {}

  void add(const Section& section, const std::string& group, bool with_failed) {
    for (const MethodSummary& method : section.methods) {
      const MetricSummary* values = method.find(metric_);
      if (values == nullptr) continue;
      const std::size_t failed = with_failed ? values->failed.size() : 0;
      if (values->values.empty() && failed == 0) continue;
      auto trace =
          std::find_if(traces_.begin(), traces_.end(), [&](const auto& t) { return t.first == method.method; });
      if (trace == traces_.end()) {
        traces_.emplace_back(method.method, box(method.method, palette_.index(method.method, traces_.size())));
        trace = traces_.end() - 1;
      }
      add_values(trace->second, group, values->values, failed);
    }
  }

  void put_into(Figure& figure, bool from_zero) {
    json data = json::array();
    for (const auto& [name, trace] : traces_) data.push_back(trace);
    json layout = {{"boxmode", "group"},
                   {"xaxis", {{"type", "category"}}},
                   {"yaxis", {{"title", {{"text", plot_text(axis_title(metric_))}}}}}};
    const bool log = wants_log(data);
    if (log)
      layout["yaxis"]["type"] = "log";
    else if (from_zero)
      layout["yaxis"]["rangemode"] = "tozero";
    if (!failures_.empty()) add_failed(log, data, layout);
    set_plot(data, layout, figure);
  }

 private:
  struct Failures {
    std::string method, group;
    std::size_t count;
  };

  void add_values(json& trace, const std::string& group, const std::vector<double>& values, std::size_t failed) {
    const std::size_t all = values.size() + failed;
    const std::size_t shown_failed = all <= kBoxPoints ? failed : (failed * kBoxPoints + all - 1) / all;
    for (const double value : at_most(values, std::max<std::size_t>(2, std::min(all, kBoxPoints) - shown_failed))) {
      trace["x"].push_back(plot_text(group));
      trace["y"].push_back(five_digits(value * style_.factor));
    }
    if (shown_failed > 0) failures_.push_back({trace["name"], plot_text(group), shown_failed});
  }

  void add_failed(bool log, json& data, json& layout) const {
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const json& trace : data) {
      for (const json& value : trace["y"]) {
        low = std::min(low, value.get<double>());
        high = std::max(high, value.get<double>());
      }
    }
    if (low > high) low = high = 1.0;  // every run failed
    const bool higher = scenarios::metric_info(metric_).sense == scenarios::Sense::higher;
    const double span = high > low ? high - low : std::max(std::abs(high), 1.0);
    const double level = five_digits(log      ? (higher ? low / 2.0 : high * 2.0)
                                     : higher ? low - 0.15 * span
                                              : high + 0.15 * span);
    for (const Failures& failed : failures_) {
      const auto trace =
          std::find_if(data.begin(), data.end(), [&](const json& each) { return each["name"] == failed.method; });
      for (std::size_t k = 0; k < failed.count; ++k) {
        (*trace)["x"].push_back(failed.group);
        (*trace)["y"].push_back(level);
      }
    }
    layout["shapes"] = json::array({{{"type", "line"},
                                     {"xref", "paper"},
                                     {"x0", 0},
                                     {"x1", 1},
                                     {"y0", level},
                                     {"y1", level},
                                     {"layer", "below"},
                                     {"line", {{"width", 1}, {"dash", "dot"}, {"color", "#888888"}}}}});
    layout["annotations"] = json::array({{{"xref", "paper"},
                                          {"x", 0},
                                          {"xanchor", "left"},
                                          {"y", log ? std::log10(level) : level},
                                          {"yanchor", "bottom"},
                                          {"showarrow", false},
                                          {"text", "failed"}}});
  }

  std::string metric_;
  MetricStyle style_;
  const Palette& palette_;
  std::vector<std::pair<std::string, json>> traces_;
  std::vector<Failures> failures_;
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

void Palette::add(const std::string& method, std::optional<std::size_t> wanted) {
  const std::string name = method.substr(method.rfind('/') + 1);
  if (indices_.contains(name)) return;
  const auto is_occupied = [&](std::size_t index) {
    return std::any_of(indices_.begin(), indices_.end(), [&](const auto& each) { return each.second == index; });
  };
  std::size_t index = wanted.value_or(0);
  if (is_occupied(index)) {
    for (index = 0; is_occupied(index); ++index) continue;
  }
  indices_.emplace(name, index);
}

std::size_t Palette::index(const std::string& method, std::size_t otherwise) const {
  const auto found = indices_.find(method.substr(method.rfind('/') + 1));
  return found == indices_.end() ? otherwise : found->second;
}

std::string axis_title(const std::string& metric) {
  std::string name = metric;
  const std::string unit = scenarios::metric_style(metric).unit;
  const std::string in_unit = unit.empty() ? "" : " [" + unit + "]";
  if (name.find('.') != std::string::npos) return name + in_unit;  // a scenario parameter
  std::string suffix = std::string("_") + scenarios::symbol(scenarios::metric_info(metric).unit);
  std::replace(suffix.begin(), suffix.end(), '/', '_');
  if (name.ends_with(suffix)) name.resize(name.size() - suffix.size());
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + in_unit;
}

double filling_of_round(std::size_t round) {
  static constexpr std::array kShares = {0.0, 0.45, 0.9};
  return kShares[round % kShares.size()];
}

Figure box_figure(const Summary& summary, Kind kind, const std::string& metric, const std::string& caption,
                  const Palette& palette) {
  Figure figure;
  figure.id = std::string(to_string(kind)) + "-" + metric;
  figure.caption = caption;
  if (holds_more_than_shown(summary, kind, metric))
    figure.caption += fmt::format(
        " A box of more than {0} simulated runs shows the points of {0} runs, evenly spaced in the sorted values.",
        kBoxPoints);
  Boxes boxes(metric, palette);
  for (const Section& section : summary.sections) {
    if (section.kind == kind) boxes.add(section, section.scenario, true);
  }
  boxes.put_into(figure, true);
  return figure;
}

Figure cost_figure(const Summary& summary, const Palette& palette) {
  Figure figure;
  figure.id = "cost";
  figure.caption = fmt::format(
      "The plot shows the CPU time that one estimate needs. Each point is one simulated run, and each box shows at "
      "most {} points.",
      kBoxPoints);
  std::set<Kind> kinds;
  for (const Section& section : summary.sections) kinds.insert(section.kind);
  Boxes boxes(scenarios::estimate_cost().name, palette);
  for (const Section& section : summary.sections)
    boxes.add(section, kinds.size() == 1 ? section.scenario : section.scenario + ", " + to_string(section.kind), false);
  boxes.put_into(figure, false);
  return figure;
}

Figure figure_of(const Plot& plot, const std::string& id, const Palette& palette) {
  Figure figure;
  figure.id = id;
  figure.caption = plot.caption;
  json data = json::array();
  for (PlotLine line : plot.lines) {
    if (line.colour != kTruthColour)
      line.colour = static_cast<int>(palette.index(line.name, static_cast<std::size_t>(line.colour)));
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
