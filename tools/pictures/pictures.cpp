// SPDX-License-Identifier: BSD-3-Clause
#include "tools/pictures/pictures.hpp"

#include <span>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/replace_file.hpp"
#include "scenarios/scoring/truth_track.hpp"
#include "sim/simulate.hpp"
#include "tools/pictures/staging.hpp"

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

}  // namespace tumble::tools
