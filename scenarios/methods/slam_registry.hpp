// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/registry.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/mapping/prior_map.hpp"

namespace tumble::scenarios {

Method slam_published();
Method slam_constant_velocity();
Method slam_tumble_lag();
Method slam_tumble_live();

/// Returns a copy of slam/tumble_lag or slam/tumble_live that localises in a prior map (TumblingOdometry::use_map), or
/// nothing for other methods. The health value `prior_map_sweep` is the number of the sweep at which the run was
/// localised in the prior map, or 0. The poses of sweeps before the localisation in the prior map are in a local frame.
std::optional<Method> localised_in(const Method& method, std::shared_ptr<const PriorMap> map);

struct RigSlam {
  std::string name, doc;
  bool ours = false;
  std::string source = {};  ///< paper; empty for our methods
  std::vector<const SettingsTable*> settings;
  bool needs_truth = false;
  bool baseline = false;
};
Method rig_slam(RigSlam what, RunCore run);

Estimate begin_with_rates(const sim::Sensors& sensors, std::vector<ImuSample>& samples,
                          const std::function<Status(Estimate&)>& rates);

}  // namespace tumble::scenarios
