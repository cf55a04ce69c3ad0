// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// Declares the parameters of the lidar-inertial chain (run_slam_chain).
namespace tumble::scenarios {

/// SlamParams contains the library's parameters for the rig, and options that select how the chain uses the
/// calibration.
struct SlamParams {
  LidarInertialOdometry::Params odometry = on_the_rig();
  bool flight_arc = false;  ///< odometry.body is taken from the robot's calibration

  static LidarInertialOdometry::Params on_the_rig();

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.odometry);
    visit(p.flight_arc,
          switch_field("flight_arc",
                       "1: in flight, the position follows the ballistic arc of the calibrated centre of mass; "
                       "0: the position follows the accelerometer",
                       FieldRank::basic));
  }
};

/// Returns `params` with the calibration uncertainties of a hand-assembled rig.
SlamParams with_calibration(SlamParams params);
/// Returns `params` so that registrations with few matches are accepted if the registered pose agrees with the prior.
/// Baselines reject registrations with few matches, because a clipped gyro makes the prior wrong (`hill` seed 8: 272 m
/// of error).
SlamParams with_few_matches(SlamParams params);
/// Returns the parameters of a method that uses the chain. Users cannot set the values that the recording states or the
/// parameters in `fixed`.
Settings<SlamParams> slam_settings(const SlamParams& defaults, std::vector<std::string> fixed = {});

/// SlamStage contains the parameters of the chain as part of the parameters of a method. The referenced objects must
/// outlive the run.
struct SlamStage {
  const Settings<SlamParams>& settings;
  const sim::Values& parameters;
};

}  // namespace tumble::scenarios
