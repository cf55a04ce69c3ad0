// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/sphere_figures.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "scenarios/scoring/truth_track.hpp"
#include "tools/report/html.hpp"
#include "tools/report/paths.hpp"
#include "tools/report/pictures.hpp"

namespace tumble::tools {

namespace {

using nlohmann::json;
using scenarios::Kind;

constexpr std::array kPositionMethods = {"rolling", "autogain_fusion", "tumble"};
constexpr std::int64_t kSpeedHalf_ns = 25'000'000;
constexpr std::size_t kPointsMax = 700;
constexpr std::int64_t kBridge_ns = 20'000'000;  // spells closer than this are shaded as one

double rounded(double value) {
  return std::round(value * 1e5) / 1e5;
}

json curve(const std::string& name, const char* colour, double width) {
  return {{"type", "scatter"},  {"mode", "lines"},   {"name", name}, {"line", {{"color", colour}, {"width", width}}},
          {"x", json::array()}, {"y", json::array()}};
}

/// A path of the truth or of a method, with its trace to be filled.
struct Shown {
  std::string name;
  const char* colour;
  double width;
  Path path;
};

std::vector<Shown> shown_paths(const SphereRoll& roll) {
  const sim::Recording& recording = roll.run.recording;
  std::vector<Shown> all = {{"truth", truth_colour().hex, 3.5, true_path(recording.sensors, recording.truth, 4)}};
  std::size_t index = 0;
  for (std::size_t i = 0; i < roll.run.methods.size(); ++i) {
    if (roll.run.methods[i]->info.kind != Kind::position) continue;
    Path path = estimated_path(roll.run.estimates[i], recording.sensors, recording.truth);
    const char* colour = method_colour(index++).hex;
    if (!path.empty()) all.push_back({roll.run.methods[i]->info.name, colour, 1.8, std::move(path)});
  }
  return all;
}

std::size_t stride_of(const Path& path) {
  return path.points_W_m.size() / kPointsMax + 1;
}

/// Spells of slip and slide of the truth as shaded rectangles.
json slip_shapes(const sim::Truth& truth) {
  json shapes = json::array();
  std::int64_t begin_ns = -1, end_ns = -1;
  const auto close = [&] {
    if (begin_ns >= 0) {
      shapes.push_back({{"type", "rect"},
                        {"xref", "x"},
                        {"yref", "paper"},
                        {"x0", rounded(seconds(begin_ns))},
                        {"x1", rounded(seconds(end_ns))},
                        {"y0", 0},
                        {"y1", 1},
                        {"layer", "below"},
                        {"fillcolor", "rgba(213,94,0,0.15)"},
                        {"line", {{"width", 0}}}});
    }
    begin_ns = -1;
  };
  for (std::size_t k = 0; k < truth.label.size(); ++k) {
    if (truth.label[k] != sim::ContactLabel::slip && truth.label[k] != sim::ContactLabel::slide) continue;
    const auto time_ns = static_cast<std::int64_t>(k) * truth.period_ns;
    if (begin_ns >= 0 && time_ns - end_ns > kBridge_ns) close();
    if (begin_ns < 0) begin_ns = time_ns;
    end_ns = time_ns + truth.period_ns;
  }
  close();
  return shapes;
}

json axis(const std::string& title) {
  return {{"title", {{"text", title}}}};
}

Figure figure_of(const SphereRoll& roll, const char* what, const std::string& caption) {
  Figure figure;
  figure.id = std::string("sphere-") + what + "-" + roll.run.situation.scenario;
  figure.caption = caption;
  return figure;
}

/// The longest spell in which the body stands still.
std::optional<Span> longest_rest(const scenarios::TruthTrack& track, std::int64_t step_ns) {
  std::optional<Span> longest;
  std::optional<Span> now;
  for (std::int64_t time_ns = 0; time_ns <= track.last_ns(); time_ns += step_ns) {
    if (!track.covers(time_ns) || !track.at_rest(time_ns)) {
      now.reset();
      continue;
    }
    if (!now) now = Span{time_ns, time_ns};
    now->end_ns = time_ns;
    if (!longest || now->end_ns - now->begin_ns > longest->end_ns - longest->begin_ns) longest = now;
  }
  return longest;
}

/// The direction in which unit vectors vary most about their mean.
Eigen::Vector3d liveliest(const std::vector<std::pair<std::int64_t, Eigen::Vector3d>>& up,
                          const Eigen::Vector3d& mean) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& [time_ns, direction] : up) {
    const Eigen::Vector3d off = direction - mean;
    spread += off * off.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
}

/// Tilt of attitudes within a span against their mean, along the direction in which it varies most [degrees].
void add_tilt(const std::vector<AttitudeState>& attitudes, const Span& span, json& trace) {
  std::vector<std::pair<std::int64_t, Eigen::Vector3d>> up;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const AttitudeState& attitude : attitudes) {
    if (attitude.time_ns < span.begin_ns || attitude.time_ns > span.end_ns) continue;
    up.emplace_back(attitude.time_ns, attitude.q_WA.conjugate() * Eigen::Vector3d::UnitZ());
    mean += up.back().second;
  }
  if (up.empty()) return;
  mean.normalize();
  const Eigen::Vector3d across = liveliest(up, mean);
  for (const auto& [time_ns, direction] : up) {
    trace["x"].push_back(rounded(seconds(time_ns)));
    trace["y"].push_back(
        rounded(std::asin(std::clamp(across.dot(direction - mean), -1.0, 1.0)) * 180.0 / std::numbers::pi));
  }
}

std::vector<AttitudeState> true_attitudes(const scenarios::TruthTrack& track, const Span& span, std::int64_t step_ns) {
  std::vector<AttitudeState> all;
  for (std::int64_t time_ns = span.begin_ns; time_ns <= span.end_ns; time_ns += step_ns)
    all.push_back({time_ns, track.pose(time_ns).q_WA, Eigen::Matrix3d::Zero()});
  return all;
}

}  // namespace

std::vector<std::string> sphere_scenarios(const Summary& summary) {
  std::vector<std::string> found;
  for (const char* wanted : {"slip", "slide", "bump", "roll"}) {
    for (const Section& section : summary.sections) {
      if (section.scenario == wanted && section.kind == Kind::position) found.emplace_back(wanted);
    }
  }
  return found;
}

SphereRoll make_sphere_roll(const scenarios::DataRoot& data, const Summary& summary, const std::string& scenario,
                            std::uint64_t seed) {
  std::vector<scenarios::MethodPointer> methods;
  for (const scenarios::Method& method : scenarios::methods()) {
    for (const Section& section : summary.sections) {
      if (section.scenario != scenario || section.kind != method.info.kind || !section.find(method.info.name)) continue;
      const bool named =
          std::find(kPositionMethods.begin(), kPositionMethods.end(), method.info.name) != kPositionMethods.end();
      if (method.info.kind == Kind::attitude || (method.info.kind == Kind::position && named))
        methods.push_back(scenarios::unowned(method));
    }
  }
  scenarios::Scenario blind = scenarios::load_scenario(data, scenario);
  std::erase_if(blind.sensors, [](const scenarios::Scenario::Sensor& s) { return s.kind.ends_with("lidar"); });
  return {scenarios::run_situation(data, blind, seed, methods, 1)};
}

Figure sphere_track_figure(const SphereRoll& roll) {
  Figure figure = figure_of(roll, "track", "The way of the centre from above, at equal scales.");
  const std::vector<Shown> all = shown_paths(roll);
  for (const Shown& shown : all) {
    json trace = curve(shown.name, shown.colour, shown.width);
    const Path near = near_truth(shown.path, all.front().path);
    for (std::size_t k = 0; k < near.points_W_m.size(); k += stride_of(near)) {
      trace["x"].push_back(rounded(near.points_W_m[k].x()));
      trace["y"].push_back(rounded(near.points_W_m[k].y()));
    }
    figure.data.push_back(std::move(trace));
  }
  figure.layout = {{"xaxis", axis("x [m]")}, {"yaxis", axis("y [m]")}};
  figure.layout["yaxis"]["scaleanchor"] = "x";
  return figure;
}

Figure sphere_speed_figure(const SphereRoll& roll) {
  Figure figure = figure_of(roll, "speed", "Speed of the centre. Shaded: the sphere slips or slides.");
  for (const Shown& shown : shown_paths(roll)) {
    json trace = curve(shown.name, shown.colour, shown.width);
    const Path& path = shown.path;
    std::size_t before = 0, after = 0;
    for (std::size_t k = 0; k < path.time_ns.size(); k += stride_of(path)) {
      while (path.time_ns[before] < path.time_ns[k] - kSpeedHalf_ns) ++before;
      while (after + 1 < path.time_ns.size() && path.time_ns[after] < path.time_ns[k] + kSpeedHalf_ns) ++after;
      if (after <= before) continue;
      const double way_m = (path.points_W_m[after] - path.points_W_m[before]).head<2>().norm();
      trace["x"].push_back(rounded(seconds(path.time_ns[k])));
      trace["y"].push_back(rounded(way_m / seconds(path.time_ns[after] - path.time_ns[before])));
    }
    figure.data.push_back(std::move(trace));
  }
  figure.layout = {{"xaxis", axis("time [s]")},
                   {"yaxis", axis("speed [m/s]")},
                   {"shapes", slip_shapes(roll.run.recording.truth)},
                   {"hovermode", "x unified"}};
  figure.layout["yaxis"]["rangemode"] = "tozero";
  return figure;
}

Figure sphere_height_figure(const SphereRoll& roll) {
  Figure figure = figure_of(roll, "height", "Height of the centre above its start.");
  for (const Shown& shown : shown_paths(roll)) {
    json trace = curve(shown.name, shown.colour, shown.width);
    const Path& path = shown.path;
    for (std::size_t k = 0; k < path.points_W_m.size(); k += stride_of(path)) {
      trace["x"].push_back(rounded(seconds(path.time_ns[k])));
      trace["y"].push_back(rounded(1e3 * (path.points_W_m[k].z() - path.points_W_m.front().z())));
    }
    figure.data.push_back(std::move(trace));
  }
  figure.layout = {{"xaxis", axis("time [s]")}, {"yaxis", axis("height [mm]")}, {"hovermode", "x unified"}};
  return figure;
}

Figure sphere_standstill_figure(const SphereRoll& roll) {
  Figure figure = figure_of(roll, "standstill",
                            "Tilt at standstill, of each method against its own mean: how it trembles and drifts.");
  const sim::Recording& recording = roll.run.recording;
  if (recording.sensors.imus.empty() || recording.truth.imus.empty()) return figure;
  const scenarios::TruthTrack track(recording.truth, scenarios::Frame::imu);
  const std::int64_t step_ns = recording.sensors.imus.front().period_ns;
  const std::optional<Span> rest = step_ns > 0 ? longest_rest(track, step_ns) : std::nullopt;
  if (!rest) return figure;
  std::size_t index = 0;
  for (std::size_t i = 0; i < roll.run.methods.size(); ++i) {
    const scenarios::MethodInfo& info = roll.run.methods[i]->info;
    if (info.kind != Kind::attitude) continue;
    json trace = curve(info.name, method_colour(index++).hex, 1.4);
    add_tilt(roll.run.estimates[i].attitudes, *rest, trace);
    if (!trace["x"].empty()) figure.data.push_back(std::move(trace));
  }
  if (figure.empty()) return figure;
  json truth = curve("truth", truth_colour().hex, 3.0);
  add_tilt(true_attitudes(track, *rest, step_ns), *rest, truth);
  figure.data.insert(figure.data.begin(), std::move(truth));
  figure.layout = {{"xaxis", axis("time [s]")}, {"yaxis", axis("tilt [°]")}, {"hovermode", "x unified"}};
  return figure;
}

std::string sphere_html(const std::vector<SphereRoll>& rolls, std::vector<Figure>& figures) {
  if (rolls.empty()) return "";
  std::string out =
      "<h2 id=\"sphere\">The rolling sphere: slip, slide, bumps, standstill</h2>\n<p>What the published figures show, "
      "from simulated rolls, with the truth beside each estimate. Each is the draw whose score is the median one of "
      "its "
      "scenario.</p>\n";
  for (const SphereRoll& roll : rolls) {
    out += fmt::format("<h3><code>{}</code>, seed {}</h3>\n<div class=\"pair\">",
                       html::escaped(roll.run.situation.scenario), roll.run.situation.seed);
    for (const Figure& figure : std::array{sphere_track_figure(roll), sphere_speed_figure(roll),
                                           sphere_height_figure(roll), sphere_standstill_figure(roll)}) {
      if (figure.empty()) continue;
      out += "<figure><div class=\"plot\" id=\"" + html::escaped(figure.id) + "\"></div><figcaption>" +
             html::escaped(figure.caption) + "</figcaption></figure>\n";
      figures.push_back(figure);
    }
    out += "</div>\n";
  }
  return out;
}

}  // namespace tumble::tools
