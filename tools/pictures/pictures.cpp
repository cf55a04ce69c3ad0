// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/pictures.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "sim/simulate.hpp"
#include "tools/pictures/colours.hpp"

namespace tumble::tools {

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

void show_start(const Scene& scene, sim::View& view) {
  const Isometry3d T_WB = sim::start_pose(*scene.built);
  view.robots_T_WB = {T_WB};
  if (scene.built->situation()->robot.type == "sphere") {
    view.look_at_W_m = Vector3d::Zero();
    view.distance_m = 25.0;
    return;
  }
  view.look_at_W_m = T_WB.translation() + Vector3d(1.5, 0.0, -0.5);
  view.distance_m = 6.8;
  view.azimuth_rad = 2.85;
  view.elevation_rad = -0.5;
}

}  // namespace

sim::Picture scene_picture(const Scene& scene, int robots, int width, int height) {
  sim::View view;
  view.width = width;
  view.height = height;
  view.paths = drawn_paths(scene);
  if (scene.truth != nullptr && !scene.truth->p_WB_m.empty()) {
    const scenarios::TruthTrack track(*scene.truth, scenarios::Frame::body);
    for (const std::int64_t time_ns : instants_along(*scene.truth, robots))
      view.robots_T_WB.push_back(robot_pose(track, time_ns));
    view.azimuth_rad = azimuth_across_rad(*scene.truth);
    if (is_sphere(scene)) view.elevation_rad = -0.85;
  } else {
    show_start(scene, view);
  }
  return sim::Renderer(*scene.built).draw(view);
}

sim::Picture film_picture(const Scene& scene, int frames, int columns, int width, int height) {
  if (scene.truth == nullptr || scene.truth->p_WB_m.empty()) {
    throw scenarios::BadInput("a film strip needs a recording with truth, which gives the position of the robot");
  }
  const scenarios::TruthTrack track(*scene.truth, scenarios::Frame::body);
  sim::Renderer renderer(*scene.built);
  sim::View view;
  view.width = width;
  view.height = height;
  view.paths = drawn_paths(scene);
  view.azimuth_rad = azimuth_across_rad(*scene.truth);
  view.distance_m = is_sphere(scene) ? 8.0 * scene.sensors->sphere_radius_m : 3.5;
  std::vector<sim::Picture> pictures;
  for (const std::int64_t time_ns : instants_along(*scene.truth, frames)) {
    const Isometry3d T_WB = robot_pose(track, time_ns);
    view.robots_T_WB = {T_WB};
    view.look_at_W_m = T_WB.translation();
    pictures.push_back(renderer.draw(view));
  }
  return sim::film_strip(pictures, columns);
}

void save_picture(const std::filesystem::path& path, const sim::Picture& picture) {
  try {
    const std::vector<std::uint8_t> bytes = sim::png_bytes(picture);
    scenarios::replace_file(path, std::as_bytes(std::span(bytes)));
  } catch (const std::runtime_error& error) {
    throw scenarios::BadInput(error.what());
  }
}

namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

double line_width_m(const Scene& scene) {
  return is_sphere(scene) ? 0.012 : 0.03;
}

std::vector<Vector3d> thinned(const std::vector<Vector3d>& points, double spacing_m) {
  std::vector<Vector3d> out;
  for (const Vector3d& point : points) {
    if (out.empty() || (point - out.back()).norm() >= spacing_m) out.push_back(point);
  }
  if (!points.empty() && out.back() != points.back()) out.push_back(points.back());
  return out;
}

}  // namespace

bool is_sphere(const Scene& scene) {
  return scene.sensors != nullptr && scene.sensors->sphere_radius_m > 0.0;
}

std::vector<std::int64_t> instants_along(const sim::Truth& truth, int count) {
  const Span span = moving_span(truth, 0.0);
  const auto begin = static_cast<std::size_t>(span.begin_ns / truth.period_ns);
  const auto end = static_cast<std::size_t>(span.end_ns / truth.period_ns);
  std::vector<double> length = {0.0};
  for (std::size_t k = begin + 1; k <= end; ++k) {
    const double turn = truth.w_WB_B_rad_s[k].norm() * static_cast<double>(truth.period_ns) * 1e-9;
    length.push_back(length.back() + (truth.p_WB_m[k] - truth.p_WB_m[k - 1]).norm() + 0.02 * turn);
  }
  std::vector<std::int64_t> out;
  for (int i = 0; i < count; ++i) {
    const double goal = count == 1 ? 0.5 * length.back() : length.back() * i / (count - 1);
    const auto at = std::lower_bound(length.begin(), length.end(), goal) - length.begin();
    out.push_back(static_cast<std::int64_t>(begin + static_cast<std::size_t>(at)) * truth.period_ns);
  }
  return out;
}

std::vector<sim::DrawnPath> drawn_paths(const Scene& scene) {
  const double width_m = line_width_m(scene);
  std::vector<sim::DrawnPath> paths;
  const auto add = [&](const Path& path, Colour colour, double width) {
    if (path.points_W_m.size() > 1)
      paths.push_back({thinned(path.points_W_m, 1.5 * width_m), colour.rgba(), width, path.name});
  };
  Path truth = scene.truth == nullptr ? Path() : true_path(*scene.sensors, *scene.truth, 10);
  truth.name = "truth";
  add(truth, truth_colour(), 1.5 * width_m);
  for (std::size_t i = 0; i < scene.estimates.size(); ++i) {
    add(near_truth(scene.estimates[i], truth), method_colour(i), width_m);
  }
  return paths;
}

double azimuth_across_rad(const sim::Truth& truth) {
  const Vector3d moved = truth.p_WB_m.back() - truth.p_WB_m.front();
  if (moved.head<2>().norm() < 0.2) return sim::View().azimuth_rad;
  return std::atan2(moved.y(), moved.x()) + 2.0;
}

Isometry3d robot_pose(const scenarios::TruthTrack& track, std::int64_t time_ns) {
  const PoseState state = track.pose(time_ns);
  Isometry3d T_WB = Isometry3d::Identity();
  T_WB.linear() = state.orientation_W.toRotationMatrix();
  T_WB.translation() = state.position_W_m;
  return T_WB;
}

}  // namespace tumble::tools
