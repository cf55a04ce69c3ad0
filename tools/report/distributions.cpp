// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/distributions.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <tuple>

#include "scenarios/statistics/statistics.hpp"
#include "tools/report/html.hpp"
#include "tools/report/pictures.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;

/// Whose spread a quantity shows: the draws' own values; the share of draws that have it; all clipped samples of all
/// draws as one heap.
enum class Over { draws, share_of_draws, clipped_samples };

/// A quantity and what the campaign of the tumbling rig (32 tumbles down a hill, ICRA 2024) and the project's own aim
/// say of it. `low` and `high` shade the plot; equal: a line.
struct Quantity {
  const char* metric;
  const char* name;
  const char* unit;
  double factor;
  const char* published;
  double low, high;  ///< in `unit`
  Over over = Over::draws;
};
constexpr double kNone = -1.0;

constexpr std::array kQuantities = {
    Quantity{"motion_peak_rate_rad_s", "largest rate", "rad/s", 1.0, "up to 18.6; aim: 8 to 25, median 13 to 16", 8.0,
             25.0},
    Quantity{"motion_clipped_share", "share of the moving samples with a clipped gyro axis", "%", 100.0, "", kNone,
             kNone},
    Quantity{"motion_several_axes_share", "two axes or more clipped, of the clipped samples of a draw", "%", 100.0, "",
             kNone, kNone},
    Quantity{"motion_several_axes_share", "two axes or more clipped, of the clipped samples of all draws", "%", 100.0,
             "aim: 10 to 40", kNone, kNone, Over::clipped_samples},
    Quantity{"motion_path_m", "path", "m", 1.0, "5 to 10", 5.0, 10.0},
    Quantity{"motion_peak_accel_m_s2", "largest specific force", "m/s²", 1.0,
             "up to 157.8; a part of 16 g ends at 156.9", 157.8, 157.8},
    Quantity{"motion_clips", "draws that clip the gyro", "%", 100.0, "aim: 90", kNone, kNone, Over::share_of_draws},
};

double value_of(const scenarios::DrawValues& draw, const std::string& metric) {
  for (const scenarios::Score& score : draw.values) {
    if (score.metric == metric) return score.value;
  }
  return std::nan("");
}

/// Mean weighted by each draw's clipped samples, with its 95 % interval: the ratio estimator of a cluster sample
/// (Cochran, Sampling Techniques, 1977, section 9A.2), since samples of one draw belong together.
scenarios::Interval pooled(std::span<const scenarios::DrawValues> draws, const std::string& scenario,
                           const std::string& metric) {
  std::vector<std::pair<double, double>> weighted;  // number of samples, share of them
  double samples = 0.0, hits = 0.0, square = 0.0;
  for (const scenarios::DrawValues& draw : draws) {
    const double weight = value_of(draw, "motion_clipped_samples"), share = value_of(draw, metric);
    if (draw.scenario != scenario || !(weight > 0.0) || !std::isfinite(share)) continue;
    weighted.emplace_back(weight, share);
    samples += weight;
    hits += weight * share;
  }
  const double mean = hits / samples, count = static_cast<double>(weighted.size());
  for (const auto& [weight, share] : weighted) square += std::pow(weight * (share - mean), 2);
  if (weighted.size() < 2) return {mean, 0.0, 1.0};
  const double half = 1.96 * std::sqrt(square * count / (count - 1.0)) / samples;
  return {mean, std::max(0.0, mean - half), std::min(1.0, mean + half)};
}

json shaded(const Quantity& quantity) {
  return {{"type", quantity.low == quantity.high ? "line" : "rect"},
          {"xref", "x"},
          {"yref", "paper"},
          {"x0", quantity.low},
          {"x1", quantity.high},
          {"y0", 0},
          {"y1", 1},
          {"layer", "below"},
          {"fillcolor", "rgba(128,128,128,0.15)"},
          {"line",
           {{"width", quantity.low == quantity.high ? 2 : 0}, {"color", "rgba(128,128,128,0.8)"}, {"dash", "dash"}}}};
}

double rounded(double value) {
  return std::round(value * 1e4) / 1e4;
}

std::string text(const Spread& spread, double value) {
  return number_text(value * spread.factor);
}

}  // namespace

std::vector<Spread> motion_spreads(std::span<const scenarios::DrawValues> draws) {
  std::vector<std::string> names;
  for (const scenarios::DrawValues& draw : draws) {
    if (std::find(names.begin(), names.end(), draw.scenario) == names.end()) names.push_back(draw.scenario);
  }
  std::vector<Spread> spreads;
  for (const Quantity& quantity : kQuantities) {
    for (const std::string& name : names) {
      Spread spread{name, quantity.metric, quantity.name, quantity.unit, quantity.published, quantity.factor, {}, 0, 0,
                    0};
      for (const scenarios::DrawValues& draw : draws) {
        const double value = value_of(draw, quantity.metric);
        if (draw.scenario == name && std::isfinite(value)) spread.values.push_back(value);
      }
      if (spread.values.empty()) continue;
      if (quantity.over == Over::clipped_samples) {
        const scenarios::Interval share = pooled(draws, name, quantity.metric);
        std::tie(spread.median, spread.quantile_05, spread.quantile_95) =
            std::tuple(share.value, share.low, share.high);
      } else if (quantity.over == Over::share_of_draws) {
        const auto count = std::count_if(spread.values.begin(), spread.values.end(), [](double v) { return v != 0.0; });
        const scenarios::Interval share =
            scenarios::share_interval(count, static_cast<std::int64_t>(spread.values.size()));
        std::tie(spread.median, spread.quantile_05, spread.quantile_95) =
            std::tuple(share.value, share.low, share.high);
      } else {
        spread.median = scenarios::quantile(spread.values, 0.5);
        spread.quantile_05 = scenarios::quantile(spread.values, 0.05);
        spread.quantile_95 = scenarios::quantile(spread.values, 0.95);
      }
      spreads.push_back(std::move(spread));
    }
  }
  return spreads;
}

std::vector<Figure> distribution_figures(std::span<const Spread> spreads) {
  std::vector<Figure> figures;
  for (const Quantity& quantity : kQuantities) {
    if (quantity.over != Over::draws) continue;
    Figure figure;
    figure.id = std::string("distribution-") + quantity.metric;
    figure.caption = std::string("Over the draws: ") + quantity.name + ".";
    if (*quantity.published != '\0')
      figure.caption += std::string(" Published for the rig: ") + quantity.published + " " + quantity.unit + ".";
    for (const Spread& spread : spreads) {
      if (spread.quantity != quantity.name) continue;
      json x = json::array();
      for (const double value : spread.values) x.push_back(rounded(value * spread.factor));
      figure.data.push_back({{"type", "histogram"},
                             {"name", spread.scenario},
                             {"histnorm", "percent"},
                             {"opacity", 0.6},
                             {"nbinsx", 30},
                             {"marker", {{"color", method_colour(figure.data.size()).hex}}},
                             {"x", std::move(x)}});
    }
    if (figure.empty()) continue;
    figure.layout = {{"barmode", "overlay"},
                     {"xaxis", {{"title", {{"text", std::string(quantity.name) + " [" + quantity.unit + "]"}}}}},
                     {"yaxis", {{"title", {{"text", "share of the draws [%]"}}}}}};
    if (quantity.low != kNone) figure.layout["shapes"] = json::array({shaded(quantity)});
    figures.push_back(std::move(figure));
  }
  return figures;
}

std::string distributions_html(std::span<const Spread> spreads, std::span<const Figure> figures) {
  if (spreads.empty()) return "";
  std::string out =
      "<h2 id=\"distributions\">Distributions</h2>\n<p>What the simulated motions were like, from the truth alone, "
      "beside "
      "the published campaign of the rig (32 tumbles down a hill) and the aim of the scenario <code>hill</code>. "
      "In brackets the middle 90 % of the draws; of a share of draws or of all samples its 95 % interval.</p>\n"
      "<div class=\"scroll\"><table><thead><tr><th>quantity</th><th>scenario</th><th class=\"number\">draws</th>"
      "<th class=\"number\">median</th><th>unit</th><th>published, for the rig</th></tr></thead><tbody>\n";
  for (const Spread& spread : spreads) {
    out += "<tr>" + html::cell(spread.quantity) + html::cell(spread.scenario) +
           html::cell(std::to_string(spread.values.size()), "number") +
           html::cell(text(spread, spread.median) + " [" + text(spread, spread.quantile_05) + ", " +
                          text(spread, spread.quantile_95) + "]",
                      "number") +
           html::cell(spread.unit, "unit") + html::cell(spread.published) + "</tr>\n";
  }
  out += "</tbody></table></div>\n<div class=\"pair\">";
  for (const Figure& figure : figures) {
    out += "<figure><div class=\"plot\" id=\"" + html::escaped(figure.id) + "\"></div><figcaption>" +
           html::escaped(figure.caption) + "</figcaption></figure>\n";
  }
  return out + "</div>\n";
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
