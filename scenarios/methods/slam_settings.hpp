// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble::scenarios {

struct SlamParams {
  LidarInertialOdometry::Params odometry = on_the_rig();

  static LidarInertialOdometry::Params on_the_rig();

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.odometry);
  }
};

/// Sets the prior uncertainties of lidar mounting and clock offset to typical values of a hand-assembled rig.
SlamParams with_calibration(SlamParams params);
/// The odometry accepts a registration with few matches if its pose agrees with the prediction. Baseline methods reject
/// registrations with few matches, because a clipped gyro makes their prediction wrong.
SlamParams with_few_matches(SlamParams params);
Settings<SlamParams> slam_settings(const SlamParams& defaults, std::vector<std::string> fixed = {});

struct SlamStage {
  const Settings<SlamParams>& settings;
  const sim::Values& parameters;
};

}  // namespace tumble::scenarios
