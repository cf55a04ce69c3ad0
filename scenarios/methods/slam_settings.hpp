// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// Parameters of the lidar-inertial chain (run_slam_chain).
namespace tumble::scenarios {

/// Those of the library, on the rig, and what the chain makes of the calibration.
struct SlamParams {
  LidarInertialOdometry::Params odometry = on_the_rig();
  bool flight_arc = false;  ///< odometry.body is the robot's, from the calibration

  static LidarInertialOdometry::Params on_the_rig();

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.odometry);
    visit(p.flight_arc, on_off("flight_arc",
                               "1: in flight, the position follows the ballistic arc of the calibrated centre of mass; "
                               "0: it follows the accelerometer",
                               Rank::first));
  }
};

/// With what calibrations of a rig that was put together by hand may be off by.
SlamParams with_calibration(SlamParams params);
/// Few matches are believed where they agree with the prior: baselines do not, and stay what they were. Read as it
/// stands a clipped gyro is led astray by them (`hill` 8, 272 m off).
SlamParams with_few_matches(SlamParams params);
/// With the saturation deficit of clipped axes estimated in the registration.
SlamParams with_saturation_deficit(SlamParams params);

/// The parameters of a method on the chain; what the recording states, and of `fixed` nothing.
Settings<SlamParams> slam_settings(const SlamParams& defaults, std::vector<std::string> fixed = {});

/// The chain's part of a method's parameters. Both outlive the run.
struct SlamStage {
  const Settings<SlamParams>& settings;
  const sim::Values& parameters;
};

}  // namespace tumble::scenarios
