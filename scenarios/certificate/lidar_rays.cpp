// SPDX-License-Identifier: BSD-3-Clause
#include <map>
#include <string>

#include "scenarios/certificate/rows.hpp"
#include "scenarios/draw/scenario.hpp"
#include "sim/trial/ray_trial.hpp"

namespace tumble::scenarios {

namespace {

std::map<std::string, std::string> scenario_of_each_world(const DataRoot& data) {
  std::map<std::string, std::string> chosen;
  for (const std::string& name : scenario_names(data)) {
    const std::string type = load_scenario(data, name).world.type;
    const bool known = !chosen.emplace(type, name).second;
    if (known && name == type) chosen[type] = name;
  }
  return chosen;
}

}  // namespace

std::vector<CertificateEntry> certify_lidar_rays(const CertificateInput& input, const LidarRaysSetup& setup) {
  // A ray at an edge may hit either adjacent surface, so this fraction of the rays may differ from the closed form.
  constexpr double kOtherSurface = 1e-3;
  std::vector<CertificateEntry> entries;
  for (const auto& [world, name] : scenario_of_each_world(input.data)) {
    const Scenario scenario = load_scenario(input.data, name);
    const sim::BuiltSituation built(draw(input.data, scenario, 1), input.data.models());
    const sim::RayDisagreement d = sim::compare_rays(built, {setup.rays, 1, setup.mirror_shift_m, setup.surface_shift});
    entries.push_back({"lidar_range_engine", name, "lidar ranges equal the ranges of mj_ray: maximum difference", "m",
                       d.largest_difference_m, 0.0, 1e-3,
                       d.hits > 0 ? "" : "this comparison has no value, because no ray hit a surface"});
    entries.push_back({"lidar_surface_engine", name,
                       "each lidar return belongs to an existing surface: share of rays without a surface", "1",
                       static_cast<double>(d.other_surface) / static_cast<double>(d.rays), 0.0, kOtherSurface, ""});
  }
  return entries;
}

}  // namespace tumble::scenarios
