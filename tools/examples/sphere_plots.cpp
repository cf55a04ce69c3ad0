// SPDX-License-Identifier: BSD-3-Clause
#include "tools/examples/sphere_plots.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "scenarios/scoring/truth_track.hpp"
#include "tools/pictures/paths.hpp"

namespace tumble::tools {

namespace {

using scenarios::Kind;

constexpr std::int64_t kSpeedHalf_ns = 25'000'000;
constexpr std::size_t kPointsMax = 700;
constexpr std::int64_t kBridge_ns = 20'000'000;  // shorter gaps are shaded

double five_decimals(double value) {
  return std::round(value * 1e5) / 1e5;
}

PlotLine line_of(const std::string& name, int colour, double width) {
  PlotLine line;
  line.name = name;
  line.colour = colour;
  line.width = width;
  return line;
}

struct ShownPath {
  std::string name;
  int colour;
  double width;
  Path path;
};

std::vector<ShownPath> shown_paths(const scenarios::RunResult& run) {
  const sim::Recording& recording = run.recording;
  std::vector<ShownPath> all = {{"truth", kTruthColour, 3.5, true_path(recording.sensors, recording.truth, 4)}};
  std::set<std::string> origins;
  int colour = 0;
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    const scenarios::MethodInfo& info = run.methods[i]->info;
    if (info.kind != Kind::position || info.needs_truth || !origins.insert(info.source).second) continue;
    Path path = near_truth(estimated_path(run.estimates[i], recording.sensors, recording.truth), all.front().path);
    if (!path.empty()) all.push_back({info.name, colour, 1.8, std::move(path)});
    ++colour;
  }
  return all;
}

std::size_t stride_of(const Path& path) {
  return path.points_W_m.size() / kPointsMax + 1;
}

std::vector<std::pair<double, double>> slip_spells(const sim::Truth& truth) {
  std::vector<std::pair<double, double>> spells;
  std::int64_t begin_ns = -1, end_ns = -1;
  const auto close = [&] {
    if (begin_ns >= 0) spells.emplace_back(five_decimals(seconds(begin_ns)), five_decimals(seconds(end_ns)));
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
  return spells;
}

Plot plot_of(const char* name, const char* caption, const char* x_title, const char* y_title) {
  Plot plot;
  plot.name = name;
  plot.caption = caption;
  plot.x_title = x_title;
  plot.y_title = y_title;
  plot.wide = false;
  return plot;
}

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

Eigen::Vector3d liveliest(const std::vector<std::pair<std::int64_t, Eigen::Vector3d>>& up,
                          const Eigen::Vector3d& mean) {
  Eigen::Matrix3d spread = Eigen::Matrix3d::Zero();
  for (const auto& [time_ns, direction] : up) {
    const Eigen::Vector3d off = direction - mean;
    spread += off * off.transpose();
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(spread).eigenvectors().col(2);
}

void add_tilt(const std::vector<AttitudeState>& attitudes, const Span& span, PlotLine& line) {
  std::vector<std::pair<std::int64_t, Eigen::Vector3d>> up;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const AttitudeState& attitude : attitudes) {
    if (attitude.time_ns < span.begin_ns || attitude.time_ns > span.end_ns) continue;
    up.emplace_back(attitude.time_ns, attitude.orientation_W.conjugate() * Eigen::Vector3d::UnitZ());
    mean += up.back().second;
  }
  if (up.empty()) return;
  mean.normalize();
  const Eigen::Vector3d across = liveliest(up, mean);
  for (const auto& [time_ns, direction] : up) {
    line.x.push_back(five_decimals(seconds(time_ns)));
    line.y.push_back(
        five_decimals(std::asin(std::clamp(across.dot(direction - mean), -1.0, 1.0)) * 180.0 / std::numbers::pi));
  }
}

std::vector<AttitudeState> true_attitudes(const scenarios::TruthTrack& track, const Span& span, std::int64_t step_ns) {
  std::vector<AttitudeState> all;
  for (std::int64_t time_ns = span.begin_ns; time_ns <= span.end_ns; time_ns += step_ns)
    all.push_back({time_ns, track.pose(time_ns).orientation_W, Eigen::Matrix3d::Zero()});
  return all;
}

}  // namespace

Plot sphere_track_plot(const scenarios::RunResult& run) {
  Plot plot = plot_of("track", "The plot shows the path of the centre from above, with equal scales on both axes.",
                      "x [m]", "y [m]");
  plot.equal_scales = true;
  for (const ShownPath& shown : shown_paths(run)) {
    PlotLine line = line_of(shown.name, shown.colour, shown.width);
    for (std::size_t k = 0; k < shown.path.points_W_m.size(); k += stride_of(shown.path)) {
      line.x.push_back(five_decimals(shown.path.points_W_m[k].x()));
      line.y.push_back(five_decimals(shown.path.points_W_m[k].y()));
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

Plot sphere_speed_plot(const scenarios::RunResult& run) {
  Plot plot =
      plot_of("speed", "The plot shows the speed of the centre. The sphere slips or slides in the shaded intervals.",
              "time [s]", "speed [m/s]");
  plot.from_zero = plot.over_time = true;
  plot.shaded = slip_spells(run.recording.truth);
  for (const ShownPath& shown : shown_paths(run)) {
    PlotLine line = line_of(shown.name, shown.colour, shown.width);
    const Path& path = shown.path;
    std::size_t before = 0, after = 0;
    for (std::size_t k = 0; k < path.time_ns.size(); k += stride_of(path)) {
      while (path.time_ns[before] < path.time_ns[k] - kSpeedHalf_ns) ++before;
      while (after + 1 < path.time_ns.size() && path.time_ns[after] < path.time_ns[k] + kSpeedHalf_ns) ++after;
      if (after <= before) continue;
      const double distance_m = (path.points_W_m[after] - path.points_W_m[before]).head<2>().norm();
      line.x.push_back(five_decimals(seconds(path.time_ns[k])));
      line.y.push_back(five_decimals(distance_m / seconds(path.time_ns[after] - path.time_ns[before])));
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

Plot sphere_height_plot(const scenarios::RunResult& run) {
  Plot plot = plot_of("height", "The plot shows the height of the centre above its start.", "time [s]", "height [mm]");
  plot.over_time = true;
  for (const ShownPath& shown : shown_paths(run)) {
    PlotLine line = line_of(shown.name, shown.colour, shown.width);
    const Path& path = shown.path;
    for (std::size_t k = 0; k < path.points_W_m.size(); k += stride_of(path)) {
      line.x.push_back(five_decimals(seconds(path.time_ns[k])));
      line.y.push_back(five_decimals(1e3 * (path.points_W_m[k].z() - path.points_W_m.front().z())));
    }
    plot.lines.push_back(std::move(line));
  }
  return plot;
}

Plot sphere_standstill_plot(const scenarios::RunResult& run) {
  Plot plot = plot_of(
      "standstill",
      "The plot shows the tilt at standstill relative to the mean of each method. The tilt reveals jitter and drift.",
      "time [s]", "tilt [°]");
  plot.over_time = true;
  const sim::Recording& recording = run.recording;
  if (recording.sensors.imus.empty() || recording.truth.imus.empty()) return plot;
  const scenarios::TruthTrack track(recording.truth, scenarios::Frame::imu);
  const std::int64_t step_ns = recording.sensors.imus.front().period_ns;
  const std::optional<Span> rest = step_ns > 0 ? longest_rest(track, step_ns) : std::nullopt;
  if (!rest) return plot;
  int colour = 0;
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    const scenarios::MethodInfo& info = run.methods[i]->info;
    if (info.kind != Kind::attitude) continue;
    PlotLine line = line_of(info.name, colour++, 1.4);
    add_tilt(run.estimates[i].attitudes, *rest, line);
    if (!line.x.empty()) plot.lines.push_back(std::move(line));
  }
  if (plot.lines.empty()) return plot;
  PlotLine truth = line_of("truth", kTruthColour, 3.0);
  add_tilt(true_attitudes(track, *rest, step_ns), *rest, truth);
  plot.lines.insert(plot.lines.begin(), std::move(truth));
  return plot;
}

}  // namespace tumble::tools
