// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/distributions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "tools/html/html.hpp"
#include "tools/pictures/colours.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;

std::string thinned_text(std::span<const Spread> spreads) {
  const auto is_thinned = [](const Spread& spread) { return spread.of_draws && spread.values.size() > kBoxPoints; };
  if (std::none_of(spreads.begin(), spreads.end(), is_thinned)) return "";
  return fmt::format(" The plot shows at most {} simulated runs per scenario, evenly spaced in the sorted values.",
                     kBoxPoints);
}

json shaded(const Spread& spread) {
  const bool is_line = spread.published_low == spread.published_high;
  return {{"type", is_line ? "line" : "rect"},
          {"xref", "x"},
          {"yref", "paper"},
          {"x0", spread.published_low},
          {"x1", spread.published_high},
          {"y0", 0},
          {"y1", 1},
          {"layer", "below"},
          {"fillcolor", "rgba(128,128,128,0.15)"},
          {"line", {{"width", is_line ? 2 : 0}, {"color", "rgba(128,128,128,0.8)"}, {"dash", "dash"}}}};
}

json layout_of(const Spread& spread) {
  json layout = {{"barmode", "overlay"},
                 {"xaxis", {{"title", {{"text", spread.quantity + " [" + spread.unit + "]"}}}}},
                 {"yaxis", {{"title", {{"text", "share of the simulated runs [%]"}}}}}};
  if (!std::isnan(spread.published_low)) layout["shapes"] = json::array({shaded(spread)});
  return layout;
}

std::string caption_of(std::span<const Spread> spreads) {
  const Spread& spread = spreads.front();
  std::string out = fmt::format("The histogram shows the distribution over the simulated runs: {}.", spread.quantity);
  if (!spread.published.empty())
    out += fmt::format(" Published value for the rig: {} {}.", spread.published, spread.unit);
  return out + thinned_text(spreads);
}

double four_decimals(double value) {
  return std::round(value * 1e4) / 1e4;
}

std::string text(const Spread& spread, double value) {
  return number_text(value * spread.factor);
}

constexpr std::array kHatchings = {"", "/", "x", "."};

Figure histograms(std::span<const Spread> spreads) {
  Figure figure;
  json traces = json::array();
  for (const Spread& spread : spreads) {
    if (!spread.of_draws) continue;
    json x = json::array();
    for (const double value : at_most(spread.values, kBoxPoints)) x.push_back(four_decimals(value * spread.factor));
    traces.push_back({{"type", "histogram"},
                      {"name", plot_text(spread.scenario)},
                      {"histnorm", "percent"},
                      {"opacity", 0.6},
                      {"nbinsx", 30},
                      {"marker",
                       {{"color", method_colour(traces.size()).hex},
                        {"pattern", {{"shape", kHatchings[colour_round(traces.size()) % kHatchings.size()]}}}}},
                      {"x", std::move(x)}});
  }
  figure.id = "distribution-" + spreads.front().metric;
  figure.caption = caption_of(spreads);
  set_plot(traces, layout_of(spreads.front()), figure);
  return figure;
}

}  // namespace

std::vector<Figure> distribution_figures(std::span<const Spread> spreads) {
  std::vector<Figure> figures;
  const auto differs = [](const Spread& a, const Spread& b) { return a.quantity != b.quantity; };
  for (auto first = spreads.begin(); first != spreads.end();) {
    const auto last = std::adjacent_find(first, spreads.end(), differs);
    const auto end = last == spreads.end() ? last : last + 1;
    Figure figure = histograms({first, end});
    if (!figure.empty()) figures.push_back(std::move(figure));
    first = end;
  }
  return figures;
}

std::string distributions_html(std::span<const Spread> spreads, std::span<const Figure> figures) {
  if (spreads.empty()) return "";
  std::string out =
      "<p>The table shows distributions of the simulated motions, which are computed from the truth. For comparison, "
      "the table contains values of " +
      html::escaped(scenarios::kPublishedMotion) +
      ". Brackets contain the middle 90 % of the simulated runs. For a share of runs or of all samples, the brackets "
      "contain the 95 % interval.</p>\n<details><summary>Table of the motions</summary><div "
      "class=\"scroll\"><table><thead><tr><th>quantity</th><th>scenario</th><th class=\"number\">simulated "
      "runs</th><th class=\"number\">median</th><th>unit</th><th>published, for the rig</th></tr></thead><tbody>\n";
  for (const Spread& spread : spreads) {
    out += "<tr>" + html::cell(spread.quantity) + html::cell(spread.scenario) +
           html::cell(std::to_string(spread.values.size()), "number") +
           html::cell(text(spread, spread.median) + " [" + text(spread, spread.quantile_05) + ", " +
                          text(spread, spread.quantile_95) + "]",
                      "number") +
           html::cell(spread.unit, "unit") + html::cell(spread.published) + "</tr>\n";
  }
  out += "</tbody></table></div></details>\n<details><summary>Histograms</summary><div class=\"pair\">";
  for (const Figure& figure : figures) {
    out += "<figure><div class=\"plot\" id=\"" + html::escaped(figure.id) + "\"></div><figcaption>" +
           html::escaped(figure.caption) + "</figcaption></figure>\n";
  }
  return out + "</div></details>\n";
}

Table distribution_table(std::span<const Spread> spreads) {
  Table table("motions", {"quantity", "scenario", "draws", "median", "5 %", "95 %", "unit"});
  for (const Spread& spread : spreads) {
    table.add_row({spread.quantity, spread.scenario, std::to_string(spread.values.size()), text(spread, spread.median),
                   text(spread, spread.quantile_05), text(spread, spread.quantile_95), spread.unit});
  }
  return table;
}

json distributions_json(std::span<const Spread> spreads) {
  json rows = json::array();
  for (const Spread& spread : spreads) {
    rows.push_back({{"scenario", spread.scenario},
                    {"metric", spread.metric},
                    {"quantity", spread.quantity},
                    {"draws", spread.values.size()},
                    {"median", spread.median},
                    {"quantile_05", spread.quantile_05},
                    {"quantile_95", spread.quantile_95}});
  }
  return rows;
}

}  // namespace tumble::tools
