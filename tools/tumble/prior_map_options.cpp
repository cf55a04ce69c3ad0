// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/prior_map_options.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <memory>
#include <optional>

#include "scenarios/errors.hpp"
#include "scenarios/estimates/map_file.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::tools {

using scenarios::BadInput;

namespace {

std::shared_ptr<const PriorMap> read_map_of(const PriorMapOptions& options) {
  constexpr std::size_t kPose = 4, kWithSigmas = 6;
  auto map = std::make_shared<PriorMap>();
  map->points = scenarios::read_map(options.map);
  map->extend = !options.frozen;
  const std::vector<double>& pose = options.pose;
  if (!pose.empty() && pose.size() != kPose && pose.size() != kWithSigmas)
    throw BadInput(fmt::format("--map-pose has {} numbers; it needs X Y Z HEADING or X Y Z HEADING SIGMA_M SIGMA_RAD",
                               pose.size()));
  if (!pose.empty()) {
    map->start_T_MI =
        Eigen::Translation3d(pose[0], pose[1], pose[2]) * Eigen::AngleAxisd(pose[3], Eigen::Vector3d::UnitZ());
    if (pose.size() == kWithSigmas) map->start_position_sigma_m = pose[4], map->start_heading_sigma_rad = pose[5];
  }
  if (const Status status = check_prior_map(*map); !status.ok())
    throw BadInput(options.map.string() + ": " + status.message());
  return map;
}

}  // namespace

void declare_prior_map(VerbOptions& verb, PriorMapOptions& options) {
  verb.add("--map", options.map,
           "estimates the poses in this prior map. The method must be 'slam/tumble_live' or 'slam/tumble_lag'. The map "
           "is the file map.tumblemap of an earlier run, or a PCD or PLY file");
  verb.add("--map-pose", options.pose,
           "states the IMU's initial pose in the map: X Y Z HEADING [m, rad], optionally followed by the standard "
           "deviations SIGMA_M SIGMA_RAD [default: 0 0]. Without --map-pose, the program searches the whole map");
  verb.add_flag("--map-frozen", options.frozen, "keeps the prior map unchanged; by default, sweeps extend the map");
}

scenarios::Method with_prior_map(const scenarios::Method& method, const PriorMapOptions& options) {
  if (options.map.empty()) {
    if (!options.pose.empty() || options.frozen) throw BadInput("--map-pose and --map-frozen need --map");
    return method;
  }
  std::optional<scenarios::Method> localised = scenarios::localised_in(method, read_map_of(options));
  if (!localised)
    throw BadInput(fmt::format(
        "--map applies only to slam/tumble_live and slam/tumble_lag; '{}' does not localise itself in a prior map",
        full_name(method.info)));
  return *localised;
}

std::string localisation_text(const PriorMapOptions& options, const scenarios::Estimate& estimate) {
  const std::string file = options.map.string();
  const auto first = std::find_if(estimate.sweeps.begin(), estimate.sweeps.end(),
                                  [](const SweepResult& sweep) { return sweep.in_prior_map; });
  if (first == estimate.sweeps.end())
    return fmt::format("{}: the recording is not localised in this map; poses are in a local frame", file);
  if (first == estimate.sweeps.begin())
    return fmt::format("{}: the recording is localised in this map; all poses are in the frame of the map", file);
  return fmt::format(
      "{}: the recording is localised in this map at sweep {} of {}. The trajectory starts there, in the frame of the "
      "map",
      file, first - estimate.sweeps.begin() + 1, estimate.sweeps.size());
}

}  // namespace tumble::tools
