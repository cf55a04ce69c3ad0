// SPDX-License-Identifier: BSD-3-Clause
#include "tools/examples/draw_plots.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

#include "scenarios/scoring/truth_track.hpp"
#include "tools/pictures/colours.hpp"
#include "tools/pictures/paths.hpp"

namespace tumble::tools {

namespace {

using scenarios::Kind;

constexpr std::size_t kPathPointsMax = 600;

int most_clipped_axis(const std::vector<AngularRateState>& rates) {
  std::array<int, 3> count = {0, 0, 0};
  for (const AngularRateState& rate : rates) {
    for (int axis = 0; axis < 3; ++axis) count[static_cast<std::size_t>(axis)] += (rate.clipped_axes >> axis) & 1;
  }
  const auto most = std::max_element(count.begin(), count.end());
  return *most == 0 ? -1 : static_cast<int>(most - count.begin());
}

int most_clipped_axis(const scenarios::RunResult& run) {
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    if (run.methods[i]->info.kind != Kind::rate) continue;
    const int found = most_clipped_axis(run.estimates[i].rates);
    if (found >= 0) return found;
  }
  return -1;
}

PlotLine sampled_rate(const std::string& name, double width, const std::vector<TimeNs>& time_ns,
                      const std::vector<Eigen::Vector3d>& rate_rad_s, int axis, const Span& span) {
  PlotLine line;
  line.name = name;
  line.width = width;
  for (std::size_t k = 0; k < time_ns.size() && k < rate_rad_s.size(); ++k) {
    if (time_ns[k] < span.begin_ns || time_ns[k] > span.end_ns) continue;
    line.x.push_back(significant(seconds(time_ns[k])));
    line.y.push_back(significant(rate_rad_s[k][axis]));
  }
  return line;
}

PlotLine estimated_rate(const scenarios::MethodInfo& info, const std::vector<AngularRateState>& rates, int axis,
                        const Span& span) {
  PlotLine line;
  line.name = info.baseline ? info.name + " (gyro reading)" : info.name;
  line.width = 1.6;
  line.dotted = line.hidden = info.needs_truth;
  for (const AngularRateState& rate : rates) {
    if (rate.time_ns < span.begin_ns || rate.time_ns > span.end_ns) continue;
    line.x.push_back(significant(seconds(rate.time_ns)));
    line.y.push_back(significant(rate.w_WI_I_rad_s[axis]));
  }
  return line;
}

PlotLine path_line(const std::string& name, int colour, double width, const Path& path) {
  PlotLine line;
  line.name = name;
  line.colour = colour;
  line.width = width;
  const std::size_t stride = path.points_W_m.size() / kPathPointsMax + 1;
  for (std::size_t k = 0; k < path.points_W_m.size(); k += stride) {
    line.x.push_back(significant(path.points_W_m[k].x()));
    line.y.push_back(significant(path.points_W_m[k].y()));
  }
  return line;
}

}  // namespace

double significant(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double scale = std::pow(10.0, 4 - static_cast<int>(std::floor(std::log10(std::abs(value)))));
  return std::round(value * scale) / scale;
}

std::vector<std::size_t> drawn_of(const std::vector<bool>& first) {
  std::vector<std::size_t> drawn;
  for (const bool turn : {true, false}) {
    for (std::size_t i = 0; i < first.size(); ++i) {
      if (first[i] == turn && drawn.size() < kMethodColours) drawn.push_back(i);
    }
  }
  std::sort(drawn.begin(), drawn.end());
  return drawn;
}

std::string RunPaths::left_out_text() const {
  return left_out == 0 ? ""
                       : fmt::format(" {} more estimates are omitted, because there are too few colours.", left_out);
}

RunPaths paths_of(const scenarios::RunResult& run) {
  RunPaths found;
  std::vector<bool> first;
  for (std::size_t i = 0; i < run.estimates.size(); ++i) {
    const scenarios::MethodInfo& info = run.methods[i]->info;
    if (info.needs_truth) continue;
    Path path = estimated_path(run.estimates[i], run.recording.sensors, run.recording.truth);
    if (path.empty()) continue;
    found.methods.push_back(full_name(info));
    found.paths.push_back(std::move(path));
    first.push_back(info.baseline || info.ours);
  }
  const std::vector<std::size_t> drawn = drawn_of(first);
  RunPaths out;
  out.left_out = found.paths.size() - drawn.size();
  for (const std::size_t i : drawn) {
    out.methods.push_back(std::move(found.methods[i]));
    out.paths.push_back(std::move(found.paths[i]));
  }
  return out;
}

Plot rate_plot(const scenarios::RunResult& run) {
  Plot plot;
  plot.name = "rate";
  const int axis = most_clipped_axis(run);
  if (axis < 0 || run.recording.truth.imus.empty()) return plot;
  const Span span = moving_span(run.recording.truth, 0.3);
  const sim::ImuRecord& imu = run.recording.sensors.imus.front();
  plot.lines.push_back(
      sampled_rate("truth", 3.5, imu.time_ns, run.recording.truth.imus.front().rate_rad_s, axis, span));
  int colour = 0;
  bool gyro = false;
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    if (run.methods[i]->info.kind != Kind::rate) continue;
    gyro = gyro || run.methods[i]->info.baseline;
    plot.lines.push_back(estimated_rate(run.methods[i]->info, run.estimates[i].rates, axis, span));
    plot.lines.back().colour = colour++;
  }
  if (!gyro) {
    plot.lines.push_back(sampled_rate("gyro reading", 1.6, imu.time_ns, imu.gyro_rad_s, axis, span));
    plot.lines.back().colour = colour;
  }
  plot.caption = fmt::format(
      "The plot shows the angular velocity about the sensor's {} axis, which clips most often. The gyro is saturated "
      "where the line of the gyro is flat. Drag to zoom; double-click to reset.",
      "xyz"[axis]);
  plot.x_title = "time [s]";
  plot.y_title = "rate [rad/s]";
  plot.over_time = true;
  return plot;
}

Plot path_plot(const scenarios::RunResult& run, const RunPaths& paths) {
  Plot plot;
  plot.name = "path";
  if (run.recording.truth.p_WB_m.empty()) return plot;
  const Path truth = true_path(run.recording.sensors, run.recording.truth, 1);
  plot.lines.push_back(path_line("truth", kTruthColour, 3.5, truth));
  bool cut = false;
  for (std::size_t i = 0; i < paths.paths.size(); ++i) {
    const Path shown = near_truth(paths.paths[i], truth);
    cut = cut || shown.points_W_m.size() < paths.paths[i].points_W_m.size();
    plot.lines.push_back(path_line(paths.methods[i], static_cast<int>(i), 1.8, shown));
  }
  plot.caption = fmt::format(
      "The plot shows the path from above, with equal scales on both axes. Each estimate starts at the true "
      "position.{}",
      paths.left_out_text());
  if (cut) plot.caption += " A diverged path is cut at the border of the picture.";
  plot.x_title = "x [m]";
  plot.y_title = "y [m]";
  plot.equal_scales = true;
  return plot;
}

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
  Plot plot = plot_of("standstill",
                      "The plot shows the tilt at standstill. The mean of each line is subtracted, so that jitter and "
                      "drift are visible.",
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
