// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sections.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "tools/html/html.hpp"
#include "tools/report/contests.hpp"
#include "tools/report/score_html.hpp"

namespace tumble::tools {

namespace {

using html::escaped;
using scenarios::Interval;
using scenarios::Section;
using scenarios::Summary;

constexpr std::size_t kShownContests = 6;
constexpr std::size_t kNamedScenarios = 4;

std::string names_text(const std::vector<std::string>& all, const char* many) {
  if (all.size() > kNamedScenarios) return fmt::format("{} {}", all.size(), many);
  std::string names;
  for (std::size_t i = 0; i < all.size(); ++i) names += (i == 0 ? "" : i + 1 == all.size() ? " and " : ", ") + all[i];
  return names;
}

std::string draws_text(const Summary& summary) {
  std::int64_t least = 0, most = 0;
  for (const auto& [scenario, draws] : summary.draws) {
    least = least == 0 ? draws : std::min(least, draws);
    most = std::max(most, draws);
  }
  const std::string names = names_text(summary.scenarios, "scenarios");
  const std::string runs = least == most ? fmt::format("{} simulated run{}", most, most == 1 ? "" : "s")
                                         : fmt::format("{} to {} simulated runs", least, most);
  return summary.scenarios.size() > 1 ? fmt::format("{} per scenario ({})", runs, names)
                                      : fmt::format("{} of scenario {}", runs, names);
}

std::string data_text(const PageContent& content) {
  if (!content.recorded)
    return fmt::format("The data are {} with known truth. All methods received the same recordings.",
                       draws_text(content.summary));
  return fmt::format(
      "All methods received the same recordings ({}) and are scored against the truth or the reference that each "
      "recording contains.",
      names_text(content.summary.scenarios, "of them"));
}

std::string tasks_text(const std::vector<ContestResult>& results) {
  using scenarios::Kind;
  const std::pair<Kind, const char*> tasks[] = {{Kind::rate, "rate (angular velocity)"},
                                                {Kind::attitude, "attitude (orientation)"},
                                                {Kind::position, "position (trajectory)"},
                                                {Kind::slam, "slam (trajectory and map)"}};
  std::string out;
  for (const auto& [kind, text] : tasks) {
    const auto of_kind = [kind = kind](const ContestResult& result) { return result.row.contest.kind == kind; };
    if (std::ranges::any_of(results, of_kind)) out += (out.empty() ? "" : "; ") + std::string(text);
  }
  return out;
}

std::size_t method_count(const Summary& summary) {
  std::set<std::pair<scenarios::Kind, std::string>> names;
  for (const Section& section : summary.sections) {
    for (const scenarios::MethodSummary& method : section.methods) {
      if (!method.needs_truth) names.emplace(section.kind, method.method);
    }
  }
  return names.size();
}

std::string bar_html(const ContestResult& result) {
  if (!std::isfinite(result.percent)) return "<span class=\"bar none\"></span>";
  const auto at = [](double percent) { return 50.0 + 0.5 * std::clamp(percent, -100.0, 100.0); };
  const bool known = !std::isnan(result.percent_low) && !std::isnan(result.percent_high) &&
                     (std::isfinite(result.percent_low) || std::isfinite(result.percent_high));
  const double low = known ? at(result.percent_low) : 0.0, high = known ? at(result.percent_high) : 100.0;
  return fmt::format(
      "<span class=\"bar\" aria-hidden=\"true\"><i class=\"zero\"></i><i class=\"span{}\" style=\"left:{:.1f}%;"
      "width:{:.1f}%\"></i><i class=\"dot\" style=\"left:{:.1f}%\"></i></span>",
      known ? "" : " unknown", low, std::max(high - low, 1.0), at(result.percent));
}

std::string difference_text(const ContestResult& result) {
  const Interval& own = result.row.difference;
  if (!std::isfinite(own.value)) {
    const scenarios::MetricComparison& row = result.row;
    if (!std::isfinite(row.median))
      return fmt::format("{} failed on at least half of the simulated runs", row.contest.method);
    if (!std::isfinite(row.against_median))
      return fmt::format("{} failed on at least half of the simulated runs", row.contest.against);
    return "one of the two methods failed on at least half of the simulated runs";
  }
  const std::string value = styled_value(result.row.metric, own.value, true);
  const std::string sign = own.value > 0.0 ? "+" : "";
  if (!std::isfinite(own.low) && !std::isfinite(own.high)) return sign + value;
  return sign + value + " " + styled_interval(result.row.metric, own);
}

std::string baseline_text(const ContestResult& result) {
  const std::string value = styled_value(result.row.metric, result.row.against_median, true);
  if (!(result.times >= 1.5)) return value;
  return fmt::format("{} ({:.{}f} times the median of {})", value, result.times, result.times < 10.0 ? 1 : 0,
                     result.row.contest.method);
}

std::string contest_html(const ContestResult& result, std::size_t comparisons) {
  const scenarios::MetricComparison& row = result.row;
  const std::string& metric = row.metric;
  const char* state = result.won() ? "won" : result.lost() ? "lost" : "open";
  return fmt::format(
      "<li class=\"contest {}\"><div><b>{} · {}</b><small>{}</small></div>"
      "<div><b class=\"winner\">{}</b> {}<small>{} {}</small></div>{}"
      "<div><b class=\"difference\">{}</b><small>better on {} of {} simulated runs: {}</small></div></li>\n",
      state, escaped(row.contest.scenario), to_string(row.contest.kind),
      escaped(scenarios::metric_info(metric).doc.empty() ? metric : scenarios::metric_info(metric).doc),
      escaped(row.contest.method), escaped(styled_value(metric, row.median, true)), escaped(row.contest.against),
      escaped(baseline_text(result)), bar_html(result), escaped(difference_text(result)), row.better, row.pairs,
      escaped(certainty_text(result, comparisons)));
}

std::string methods_html(const std::vector<Fact>& methods) {
  if (methods.empty()) return "";
  std::string out = "<details class=\"methods\"><summary>Descriptions of the methods</summary><dl class=\"facts\">";
  for (const auto& [name, what] : methods) out += "<dt>" + escaped(name) + "</dt><dd>" + escaped(what) + "</dd>";
  return out + "</dl></details>\n";
}

std::string contests_html(const std::vector<ContestResult>& results, std::size_t comparisons) {
  if (results.empty()) return "";
  std::string shown, folded;
  for (std::size_t i = 0; i < results.size(); ++i)
    (i < kShownContests ? shown : folded) += contest_html(results[i], comparisons);
  std::string out =
      "<section class=\"contests\" id=\"contests\"><p class=\"key\">Each row compares the best method with the "
      "baseline. The row shows both medians over the simulated runs, and the median of the paired differences with its "
      "95 % interval (BCa). The bar shows the same interval as a percentage of the baseline’s median, from −100 % to "
      "+100 %.</p>\n<ul>" +
      shown + "</ul>\n";
  if (!folded.empty())
    out += fmt::format("<details><summary>{} more contests</summary><ul>{}</ul></details>\n",
                       results.size() - kShownContests, folded);
  return out + "</section>\n";
}

const ShownExample* example_to_show(const std::vector<ShownExample>& examples) {
  const ShownExample* best = nullptr;
  const auto rank = [](const ShownExample& shown) {
    return 4 * static_cast<int>(!shown.example.of_failure) + 2 * static_cast<int>(shown.of_these_results) +
           static_cast<int>(!shown.example.moving.empty());
  };
  for (const ShownExample& shown : examples) {
    if (shown.example.moving.empty() && shown.example.pictures.empty()) continue;
    if (best == nullptr || rank(shown) > rank(*best)) best = &shown;
  }
  return best;
}

}  // namespace

std::string front_html(const PageContent& content) {
  const std::vector<ContestResult> results = contests(content.summary, content.comparison);
  const ShownExample* shown = example_to_show(content.examples);
  std::string out =
      "<header class=\"front\"><div class=\"say\"><p class=\"suite\">" + escaped(content.title) + "</p>\n";
  if (!content.summary.sections.empty()) {
    out += "<h1>" + escaped(tally_text(tally(results))) + "</h1>\n";
    const std::size_t methods = method_count(content.summary);
    out +=
        fmt::format("<p class=\"lead\">This page compares {} for the motion of tumbling or rolling robots. {}",
                    methods == 1 ? "1 estimator" : fmt::format("{} estimators", methods), escaped(data_text(content)));
    if (!results.empty())
      out += fmt::format(" A contest compares methods for one task on one {}. The tasks are: {}.",
                         content.recorded ? "recording" : "scenario", tasks_text(results));
    out += "</p>\n";
  }
  out += "</div>\n";
  if (shown != nullptr) out += moving_html(*shown);
  return out + "</header>\n" + contests_html(results, content.comparison.metrics.size()) +
         methods_html(content.methods);
}

namespace {

using nlohmann::json;
using scenarios::MotionCloud;
using scenarios::MotionMap;
using scenarios::PublishedExtreme;

constexpr std::array kSymbols = {"circle", "square", "diamond", "triangle-up", "cross", "x", "star"};

json density(const MotionMap& map) {
  const double most = 100.0 * *std::max_element(map.share.begin(), map.share.end()), step = most / 8.0;
  json rows = json::array();
  for (std::size_t row = 0; row < MotionMap::kCells; ++row) {
    json each = json::array();
    for (std::size_t i = 0; i < MotionMap::kCells; ++i)
      each.push_back(five_digits(100.0 * map.share[row * MotionMap::kCells + i]));
    rows.push_back(std::move(each));
  }
  return {
      {"type", "contour"},
      {"name", "all simulated runs"},
      {"x", map.rate_rad_s},
      {"y", map.force_m_s2},
      {"z", std::move(rows)},
      {"autocontour", false},
      {"contours", {{"coloring", "fill"}, {"start", step}, {"end", most - 0.5 * step}, {"size", step}}},
      {"zmin", 0.0},
      {"zmax", most},
      {"line", {{"width", 0}}},
      {"colorscale", {{0.0, "rgba(110,130,150,0)"}, {0.07, "rgba(110,130,150,0)"}, {1.0, "rgba(110,130,150,0.75)"}}},
      {"showscale", false},
      {"hoverinfo", "skip"}};
}

json points(const MotionCloud& cloud, std::size_t index) {
  json x = json::array(), y = json::array();
  for (const scenarios::MotionPoint& point : cloud.points) {
    x.push_back(five_digits(point.rate_rad_s));
    y.push_back(five_digits(point.force_m_s2));
  }
  return {{"type", "scatter"},
          {"mode", "markers"},
          {"name", plot_text(cloud.scenario)},
          {"marker",
           {{"color", method_colour(index).hex},
            {"symbol", kSymbols[index % kSymbols.size()]},
            {"size", 8},
            {"line", {{"width", 1}, {"color", "rgba(128,128,128,0.9)"}}}}},
          {"x", std::move(x)},
          {"y", std::move(y)}};
}

json outline(const PublishedExtreme& extreme, const MotionMap& map, bool dotted) {
  const double low_rate = map.rate_rad_s.front(), low_force = map.force_m_s2.front();
  json x = json::array({low_rate}), y = json::array({extreme.force_m_s2});
  if (std::isfinite(extreme.rate_rad_s)) {
    x.push_back(extreme.rate_rad_s);
    y.push_back(extreme.force_m_s2);
    x.push_back(extreme.rate_rad_s);
    y.push_back(low_force);
  } else {
    x.push_back(std::max(map.rate_rad_s.back(), low_rate));
    y.push_back(extreme.force_m_s2);
  }
  return {{"type", "scatter"},
          {"mode", "lines"},
          {"name", plot_text("published: " + extreme.campaign)},
          {"line", {{"color", "#888888"}, {"width", 2}, {"dash", dotted ? "dot" : "dash"}}},
          {"x", std::move(x)},
          {"y", std::move(y)}};
}

std::string caption_of(const MotionMap& map) {
  std::size_t draws = 0, shown = 0;
  for (const MotionCloud& cloud : map.clouds) {
    draws += cloud.draws;
    shown += cloud.points.size();
  }
  std::string out = fmt::format(
      "Each point shows the largest rate and the largest specific force of one simulated run. The specific force is "
      "the reading of an IMU without saturation. The shaded area shows the density of all {} runs{}. The outlines show "
      "the largest values in published campaigns",
      draws, shown < draws ? fmt::format("; {} of the simulated runs are shown as points", shown) : "");
  for (const PublishedExtreme& extreme : map.extremes) out += "; " + extreme.source;
  return fmt::format("{}. Largest rate and largest specific force of a simulated run may occur at different instants.",
                     out);
}

}  // namespace

Figure motion_figure(const MotionMap& map) {
  Figure figure;
  if (map.clouds.empty()) return figure;
  figure.id = "motion-map";
  figure.caption = caption_of(map);
  json data = json::array({density(map)});
  for (std::size_t i = 0; i < map.clouds.size(); ++i) data.push_back(points(map.clouds[i], i));
  for (std::size_t i = 0; i < map.extremes.size(); ++i) data.push_back(outline(map.extremes[i], map, i > 0));
  const json layout = {{"xaxis", {{"title", {{"text", "largest rate [rad/s]"}}}, {"type", "log"}}},
                       {"yaxis", {{"title", {{"text", "largest specific force [m/s²]"}}}, {"type", "log"}}}};
  set_plot(data, layout, figure);
  return figure;
}

}  // namespace tumble::tools
