// SPDX-License-Identifier: BSD-3-Clause
#include "tools/examples/draw_plots.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/pictures/colours.hpp"

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
                       : fmt::format(" There are too few colours for {} more estimates, which are left out.", left_out);
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
      "where its line is flat. Drag to zoom; double-click to reset.",
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

}  // namespace tumble::tools
