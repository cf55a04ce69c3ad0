// SPDX-License-Identifier: BSD-3-Clause
#include "tools/examples/make_example.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/sweep/evaluate.hpp"
#include "sim/render/renderer.hpp"
#include "tools/examples/draw_plots.hpp"
#include "tools/pictures/map_pictures.hpp"
#include "tools/pictures/moving.hpp"
#include "tools/pictures/pictures.hpp"
#include "tools/replay/page.hpp"
#include "tools/replay/run_replay.hpp"

namespace tumble::tools {

namespace {

bool is_sphere(const scenarios::RunResult& run) {
  return run.recording.sensors.sphere_radius_m > 0.0;
}

void add_map(const scenarios::RunResult& run, const sim::Surface& surface, bool (*wanted)(const scenarios::MethodInfo&),
             std::vector<ErrorMap>& maps) {
  for (std::size_t i = 0; i < run.methods.size(); ++i) {
    const scenarios::MethodInfo& info = run.methods[i]->info;
    if (info.kind != scenarios::Kind::slam || info.needs_truth || !wanted(info)) continue;
    ErrorMap map = map_by_error("slam/" + info.name, run.estimates[i], run.recording.truth, surface);
    if (map.points_W_m.empty()) continue;
    maps.push_back(std::move(map));
    return;
  }
}

void add_maps(const scenarios::RunResult& run, Example& example) {
  if (!run.surface) return;
  std::vector<ErrorMap> maps;
  add_map(
      run, *run.surface, [](const scenarios::MethodInfo& info) { return info.baseline; }, maps);
  add_map(
      run, *run.surface, [](const scenarios::MethodInfo& info) { return info.ours; }, maps);
  if (maps.empty()) return;
  std::string names;
  for (const ErrorMap& map : maps) {
    names += fmt::format("{}{} ({:.1f} % of the map points are within 0.1 m of the true surface)",
                         names.empty() ? "" : ", ", map.name, 100.0 * map.share_within(0.1f));
  }
  example.pictures.push_back(
      {"maps",
       "maps next to each other, coloured by error",
       fmt::format("The picture shows these maps, from left to right: {}. The colour of each point shows its distance "
                   "to the true surface, from 0 (blue) to 1 m or more (red).",
                   names),
       {},
       sim::png_bytes(map_picture(maps, run.recording.truth, 640, 480))});
}

constexpr double kMoving_s = 2.0;

void add_moving(const Scene& scene, Example& example) {
  MovingOptions options;
  options.width = 400;
  options.height = 250;
  options.frames_per_s = 12.5;
  options.quality = 45.0f;
  const Span span = liveliest_span(*scene.truth, kMoving_s);
  example.moving = moving_picture(scene, span, options);
  example.moving_caption =
      fmt::format("the fastest rotation of the robot in the simulated run ({:.1f} s), at half speed",
                  1e-9 * static_cast<double>(span.end_ns - span.begin_ns));
}

Scene scene_of(const scenarios::RunResult& run, const RunPaths& paths) {
  return {&run.built.value(), &run.recording.sensors, &run.recording.truth, paths.paths};
}

void add_path(const scenarios::RunResult& run, const RunPaths& paths, int width, int height, Example& example) {
  ExamplePicture picture{
      "scene",
      "the robot along its path, with true and estimated paths",
      fmt::format("The picture shows the robot at equal distances along its path.{}", paths.left_out_text()),
      {{"truth", kTruthColour}},
      {}};
  for (std::size_t i = 0; i < paths.methods.size(); ++i)
    picture.legend.emplace_back(paths.methods[i], static_cast<int>(i));
  picture.png = sim::png_bytes(scene_picture(scene_of(run, paths), is_sphere(run) ? 3 : 8, width, height));
  example.pictures.push_back(std::move(picture));
}

void add_pictures(const scenarios::RunResult& run, const RunPaths& paths, Moving moving, Example& example) {
  const Scene scene = scene_of(run, paths);
  add_path(run, paths, 1280, 640, example);
  example.pictures.push_back({"film",
                              "film strip of the same motion",
                              "The film strip shows the same motion from close up, in rows from left to right.",
                              {},
                              sim::png_bytes(film_picture(scene, 8, 4, 400, 300))});
  if (moving == Moving::drawn) add_moving(scene, example);
  add_maps(run, example);
}

void add_plot(Plot plot, Example& example) {
  if (!plot.lines.empty()) example.plots.push_back(std::move(plot));
}

Example replayed(const scenarios::RunResult& run) {
  Example example;
  example.scenario = run.scenario;
  example.seed = run.seed;
  example.motion = is_sphere(run) ? "roll" : "tumble";
  example.recording_digest = run.recording_digest;
  example.digest_without_lidars = scenarios::digest_without_lidars(run.recording);
  example.replay_page = replay_page(replay_of_run(run));
  example.replay = replay_file(example);
  return example;
}

}  // namespace

Example example_of(const scenarios::RunResult& run, Moving moving) {
  Example example = replayed(run);
  const RunPaths paths = paths_of(run);
  add_pictures(run, paths, moving, example);
  add_plot(rate_plot(run), example);
  add_plot(path_plot(run, paths), example);
  if (is_sphere(run)) {
    add_plot(sphere_track_plot(run), example);
    add_plot(sphere_speed_plot(run), example);
    add_plot(sphere_height_plot(run), example);
    add_plot(sphere_standstill_plot(run), example);
  }
  return example;
}

Example failure_example_of(const scenarios::RunResult& run) {
  Example example = replayed(run);
  example.of_failure = true;
  add_path(run, paths_of(run), 800, 400, example);
  return example;
}

}  // namespace tumble::tools
