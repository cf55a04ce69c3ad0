// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/motion_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

namespace tumble::tools {

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
      "Each point shows the largest rate of the body in one simulated run, and the largest specific force that an IMU "
      "without saturation would have measured. The shaded area shows the density of all {} runs{}. The outlines show "
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
