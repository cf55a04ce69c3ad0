// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/curves.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "scenarios/summary/summary.hpp"
#include "tools/html/html.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

Table curve_table(const Curve& curve) {
  Table table(fmt::format("{}: {} against {}", curve.scenario, curve.metric, curve.axis),
              {"method", curve.axis, "draws", "failed", "at most (95 %)", "25 %", "median", "75 %", "worst 5 %"});
  table.align_right_from(1);
  for (const CurveLine& line : curve.lines) {
    bool first = true;
    for (const CurvePoint& point : line.points) {
      table.add_row({first ? line.method : "", point.label.empty() ? number_text(point.x) : point.label,
                     std::to_string(point.draws), std::to_string(point.failed),
                     fmt::format("{:.1f} %", 100.0 * point.failed_share.high), number_text(point.quantile_25),
                     number_text(point.median), number_text(point.quantile_75), number_text(point.worst_5)});
      first = false;
    }
  }
  return table;
}

nlohmann::json curves_json(std::span<const Curve> curves) {
  const auto finite = [](double value) { return std::isfinite(value) ? nlohmann::json(value) : nlohmann::json(); };
  nlohmann::json rows = nlohmann::json::array();
  constexpr std::array kSources = {"set", "samples", "draws"};
  for (const Curve& curve : curves) {
    for (const CurveLine& line : curve.lines) {
      for (const CurvePoint& point : line.points) {
        rows.push_back({{"source", kSources[static_cast<std::size_t>(curve.source)]},
                        {"axis", curve.axis},
                        {"scenario", curve.scenario},
                        {"kind", to_string(curve.kind)},
                        {"metric", curve.metric},
                        {"method", line.method},
                        {"x", finite(point.x)},
                        {"bin", point.label},
                        {"draws", point.draws},
                        {"failed", point.failed},
                        {"failed_share_high", finite(point.failed_share.high)},
                        {"quantile_25", finite(point.quantile_25)},
                        {"median", finite(point.median)},
                        {"quantile_75", finite(point.quantile_75)},
                        {"worst_5", finite(point.worst_5)}});
      }
    }
  }
  return rows;
}

namespace {

using nlohmann::json;
using scenarios::metric_style;
using scenarios::MetricStyle;

constexpr double kMetricDomainLow = 0.36, kFailureDomainHigh = 0.24;

json shown(double value) {
  return std::isfinite(value) ? json(five_digits(value)) : json();
}

std::string transparent(const char* hex) {
  const auto colour = Colour{hex}.rgba();
  return fmt::format("rgba({:.0f},{:.0f},{:.0f},0.14)", 255 * colour[0], 255 * colour[1], 255 * colour[2]);
}

json trace(const std::string& method, bool in_legend) {
  return {
      {"type", "scatter"}, {"name", plot_text(method)}, {"legendgroup", plot_text(method)}, {"showlegend", in_legend}};
}

void add_bands(const CurveLine& line, double x_factor, double y_factor, const char* colour, json& data) {
  const auto finite = [](const CurvePoint& p) { return std::isfinite(p.quantile_25) && std::isfinite(p.quantile_75); };
  for (auto begin = line.points.begin(); begin != line.points.end();) {
    begin = std::find_if(begin, line.points.end(), finite);
    const auto end = std::find_if_not(begin, line.points.end(), finite);
    if (begin == end) break;
    json band = trace(line.method, false);
    band.update({{"mode", "lines"},
                 {"fill", "toself"},
                 {"fillcolor", transparent(colour)},
                 {"line", {{"width", 0}}},
                 {"hoverinfo", "skip"},
                 {"x", json::array()},
                 {"y", json::array()}});
    for (auto point = begin; point != end; ++point) {
      band["x"].push_back(shown(point->x * x_factor));
      band["y"].push_back(shown(point->quantile_25 * y_factor));
    }
    for (auto point = end; point != begin;) {
      --point;
      band["x"].push_back(shown(point->x * x_factor));
      band["y"].push_back(shown(point->quantile_75 * y_factor));
    }
    data.push_back(std::move(band));
    begin = end;
  }
}

json line_trace(const CurveLine& line, double x_factor, double y_factor, double CurvePoint::*value, bool in_legend) {
  json out = trace(line.method, in_legend);
  out["x"] = json::array();
  out["y"] = json::array();
  for (const CurvePoint& point : line.points) {
    out["x"].push_back(shown(point.x * x_factor));
    out["y"].push_back(shown(point.*value * y_factor));
  }
  return out;
}

json failures_trace(const CurveLine& line, double x_factor, const char* colour) {
  json out = trace(line.method, false);
  json above = json::array(), below = json::array();
  out.update({{"mode", "lines+markers"},
              {"yaxis", "y2"},
              {"line", {{"color", colour}, {"width", 1.5}}},
              {"marker", {{"color", colour}, {"size", 5}}},
              {"x", json::array()},
              {"y", json::array()}});
  for (const CurvePoint& point : line.points) {
    out["x"].push_back(shown(point.x * x_factor));
    out["y"].push_back(shown(100.0 * point.failed_share.value));
    above.push_back(shown(100.0 * (point.failed_share.high - point.failed_share.value)));
    below.push_back(shown(100.0 * (point.failed_share.value - point.failed_share.low)));
  }
  out["error_y"] = {{"type", "data"}, {"array", above},  {"arrayminus", below}, {"thickness", 0.8},
                    {"width", 2},     {"color", colour}, {"symmetric", false}};
  return out;
}

bool wants_log(const Curve& curve) {
  double low = std::numeric_limits<double>::infinity(), high = 0.0;
  for (const CurveLine& line : curve.lines) {
    for (const CurvePoint& point : line.points) {
      for (const double value : {point.quantile_25, point.median, point.worst_5}) {
        if (!std::isfinite(value)) continue;
        low = std::min(low, value);
        high = std::max(high, value);
      }
    }
  }
  return low > 0.0 && high > 10.0 * low;
}

json x_axis(const Curve& curve, const std::string& title) {
  json axis = {{"title", {{"text", title}}}, {"anchor", "y2"}};
  if (curve.source != Curve::Source::samples) return axis;
  axis["tickvals"] = json::array();
  axis["ticktext"] = json::array();
  for (std::size_t k = 0; k < curve.bins.size(); ++k) {
    axis["tickvals"].push_back(k + 1);
    axis["ticktext"].push_back(plot_text(curve.bins[k]));
  }
  axis["range"] = {0.5, static_cast<double>(curve.bins.size()) + 0.5};
  // Plotly's automatic rotation of labels would omit the last label.
  if (curve.bins.size() > 4) axis["tickangle"] = -30;
  return axis;
}

CurveLine with_gaps(const CurveLine& line, const std::vector<std::string>& bins) {
  constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
  CurveLine out{line.method, {}};
  auto point = line.points.begin();
  for (std::size_t k = 0; k < bins.size(); ++k) {
    const double x = static_cast<double>(k + 1);
    if (point != line.points.end() && point->x == x) {
      out.points.push_back(*point++);
      continue;
    }
    CurvePoint none;
    none.x = x;
    none.failed_share = {kNone, kNone, kNone};
    none.quantile_25 = none.median = none.quantile_75 = none.worst_5 = kNone;
    out.points.push_back(none);
  }
  return out;
}

std::string caption_of(const Curve& curve) {
  const std::string what = fmt::format("{}, {}: ", curve.scenario, to_string(curve.kind));
  const std::string& doc = scenarios::metric_info(curve.axis).doc;
  const std::string axis = curve.axis + (doc.empty() ? "" : " (" + doc + ")");
  switch (curve.source) {
    case Curve::Source::set:
      return fmt::format(
          "{}the plot shows {} against {}. Every simulated run was repeated with each value of the x axis.", what,
          curve.metric, axis);
    case Curve::Source::samples:
      return fmt::format(
          "{}the plot shows {} of a simulated run. The clipped samples of the run are divided into bins of {}.", what,
          curve.metric, axis);
    case Curve::Source::draws:
      return fmt::format("{}the plot shows {} against {} of the simulated run. All bins have equal numbers of runs.",
                         what, curve.metric, axis);
  }
  return what;
}

}  // namespace

Figure curve_figure(const Curve& curve, const Palette& palette) {
  Figure figure;
  figure.id = "curve-" + curve.scenario + "-" + to_string(curve.kind) + "-" + curve.axis + "-" + curve.metric;
  figure.caption = caption_of(curve);
  const MetricStyle x_style = metric_style(curve.axis), y_style = metric_style(curve.metric);
  const double x_factor = curve.source == Curve::Source::samples ? 1.0 : x_style.factor;
  json data = json::array(), lines = json::array();
  for (std::size_t i = 0; i < curve.lines.size(); ++i) {
    const CurveLine line = curve.bins.empty() ? curve.lines[i] : with_gaps(curve.lines[i], curve.bins);
    const std::size_t index = palette.index(line.method, i);
    const char* colour = method_colour(index).hex;
    add_bands(line, x_factor, y_style.factor, colour, data);
    json median = line_trace(line, x_factor, y_style.factor, &CurvePoint::median, true);
    median.update({{"mode", "lines+markers"},
                   {"line", {{"color", colour}, {"width", 2.2}, {"dash", dash_of_round(colour_round(index))}}},
                   {"marker", {{"color", colour}, {"size", 6}, {"symbol", symbol_of_round(colour_round(index))}}}});
    json worst = line_trace(line, x_factor, y_style.factor, &CurvePoint::worst_5, false);
    worst.update({{"mode", "lines"}, {"line", {{"color", colour}, {"width", 1.2}, {"dash", "dot"}}}});
    lines.push_back(std::move(median));
    lines.push_back(std::move(worst));
    lines.push_back(failures_trace(line, x_factor, colour));
  }
  for (json& each : lines) data.push_back(std::move(each));
  json layout = {
      {"xaxis", x_axis(curve, axis_title(curve.axis))},
      {"yaxis",
       {{"title", {{"text", y_style.unit.empty() ? axis_title(curve.metric) : y_style.unit}}},
        {"domain", {kMetricDomainLow, 1.0}}}},
      {"yaxis2", {{"title", {{"text", "failed [%]"}}}, {"domain", {0.0, kFailureDomainHigh}}, {"range", {-4, 104}}}}};
  if (wants_log(curve))
    layout["yaxis"]["type"] = "log";
  else
    layout["yaxis"]["rangemode"] = "tozero";
  set_plot(data, layout, figure);
  return figure;
}

std::string curves_html(std::span<const Curve> curves, std::vector<Figure>& figures, const Palette& palette) {
  if (curves.empty()) return "";
  std::string out =
      "<h3>Curves</h3>\n<p>The line shows the median over the simulated runs, the band the quartiles, and the dotted "
      "line the limit of the worst 5 %. A failed run ranks as the worst of all, so a line ends where half of the runs "
      "fail. The lower plot shows the share of failed runs (status other than <i>ok</i>, or a failed map) with its 95 "
      "% Clopper–Pearson interval.</p>\n";
  for (auto curve = curves.begin(); curve != curves.end();) {
    const Curve& first = *curve;
    out += fmt::format("<details{}><summary>{} · {}</summary><div class=\"pair\">",
                       curve == curves.begin() ? " open" : "", html::escaped(first.scenario), to_string(first.kind));
    for (; curve != curves.end() && curve->scenario == first.scenario && curve->kind == first.kind; ++curve) {
      Figure figure = curve_figure(*curve, palette);
      out += "<figure><div class=\"plot\" id=\"" + html::escaped(figure.id) + "\"></div><figcaption>" +
             html::escaped(figure.caption) + "</figcaption></figure>\n";
      figures.push_back(std::move(figure));
    }
    out += "</div></details>\n";
  }
  return out;
}

}  // namespace tumble::tools
