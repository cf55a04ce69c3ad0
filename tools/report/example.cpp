// SPDX-License-Identifier: BSD-3-Clause
#include "tools/report/example.hpp"

#include <algorithm>
#include <cmath>

#include "scenarios/sweep/evaluate.hpp"
#include "sim/render/renderer.hpp"
#include "tools/report/pictures.hpp"

namespace tumble::tools {

namespace {

/// Every method of the summary's sections of a scenario that this build still knows.
std::vector<scenarios::MethodPointer> methods_of(const Summary& summary, const std::string& scenario) {
  std::vector<scenarios::MethodPointer> methods;
  for (const scenarios::Method& method : scenarios::methods()) {
    for (const Section& section : summary.sections) {
      if (section.scenario == scenario && section.kind == method.info.kind &&
          section.find(method.info.name) != nullptr) {
        methods.push_back(scenarios::unowned(method));
      }
    }
  }
  return methods;
}

std::string stored_digest(const scenarios::Results& results, const std::string& scenario, std::uint64_t seed) {
  for (const scenarios::Outcome& outcome : results.outcomes()) {
    if (outcome.scenario == scenario && outcome.seed == seed) return outcome.recording_digest;
  }
  return "";
}

/// What the clipped gyro makes of the map, beside what ours makes of it.
void add_maps(const scenarios::DataRoot& data, Example& example) {
  const sim::Surface surface(example.run.situation, data.models());
  for (const char* wanted : {"icp_raw", "tumble"}) {
    for (std::size_t i = 0; i < example.run.methods.size(); ++i) {
      const scenarios::MethodInfo& info = example.run.methods[i]->info;
      if (info.kind != scenarios::Kind::slam || info.name != wanted) continue;
      ErrorMap map = map_by_error("slam/" + info.name, example.run.estimates[i], example.run.recording.truth, surface);
      if (!map.points_W_m.empty()) example.maps.push_back(std::move(map));
    }
  }
  if (!example.maps.empty())
    example.map_png = sim::png_bytes(map_picture(example.maps, example.run.recording.truth, 640, 480));
}

}  // namespace

bool typical_seed(const Summary& summary, const std::string& scenario, std::uint64_t& seed) {
  for (const Section& section : summary.sections) {
    if (section.scenario != scenario) continue;
    // attitude says least about the motion; the rate of a rig and the position of a sphere choose
    if (section.kind == scenarios::Kind::attitude) continue;
    const MethodSummary* base = section.find(section.baseline);
    for (const std::string& name : headline_metrics(section.kind)) {
      const MetricSummary* metric = base->find(name);
      if (metric == nullptr || metric->values.empty()) continue;
      const auto nearest = std::min_element(metric->values.begin(), metric->values.end(), [&](double a, double b) {
        return std::abs(a - metric->centre.value) < std::abs(b - metric->centre.value);
      });
      seed = metric->seeds[static_cast<std::size_t>(nearest - metric->values.begin())];
      return true;
    }
  }
  return false;
}

Example make_example(const scenarios::DataRoot& data, const scenarios::Results& results, const Summary& summary,
                     const std::string& scenario, std::uint64_t seed, int threads) {
  Example example;
  const auto methods = methods_of(summary, scenario);
  example.run = scenarios::run_situation(data, scenarios::load_scenario(data, scenario), seed, methods, threads);
  const sim::Recording& recording = example.run.recording;
  example.is_sphere = recording.sensors.sphere_radius_m > 0.0;
  const std::string stored = stored_digest(results, scenario, seed);
  // a sweep of rate methods alone leaves the lidars out
  example.same_as_stored =
      example.run.recording_digest == stored || scenarios::digest_without_lidars(recording) == stored;
  for (std::size_t i = 0; i < example.run.estimates.size(); ++i) {
    const scenarios::MethodInfo& info = example.run.methods[i]->info;
    // what was given the truth lies on it and would hide it
    if (info.needs_truth) continue;
    Path path = estimated_path(example.run.estimates[i], recording.sensors, recording.truth);
    if (path.empty()) continue;
    example.path_methods.push_back(std::string(to_string(info.kind)) + "/" + info.name);
    example.paths.push_back(std::move(path));
  }
  const Scene scene{&example.run.situation, data.models(), &recording.sensors, &recording.truth, example.paths};
  // spheres that stand close together hide their path
  const int robots = example.is_sphere ? 3 : 8;
  example.scene_png = sim::png_bytes(scene_picture(scene, robots, 1280, 640));
  example.film_png = sim::png_bytes(film_picture(scene, 8, 4, 400, 300));
  add_maps(data, example);
  return example;
}

}  // namespace tumble::tools
