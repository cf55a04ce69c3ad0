// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"

/// slam_settings.hpp declares the parameters of the lidar-inertial mapping chain (run_slam_chain).
namespace tumble::scenarios {

/// SlamParams contains the library's parameters for the rig, and options for the use of the calibration.
struct SlamParams {
  LidarInertialOdometry::Params odometry = on_the_rig();
  bool flight_arc = false;  ///< odometry.body comes from the robot's calibration

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

/// Returns `params` with the typical calibration uncertainties of a hand-assembled rig.
SlamParams with_calibration(SlamParams params);
/// Returns `params` that accept a registration with few matches if its pose agrees with the prediction. Baseline
/// methods reject such registrations, because a clipped gyro makes the prediction wrong (`hill` seed 8: 272 m of
/// error).
SlamParams with_few_matches(SlamParams params);
/// Returns the settings of a method with the lidar-inertial mapping chain. Users cannot set the parameters in `fixed`.
/// Values in the recording are used unless the user sets them.
Settings<SlamParams> slam_settings(const SlamParams& defaults, std::vector<std::string> fixed = {});

/// SlamStage contains the parameters of the mapping chain as one stage of a method. The referenced objects must outlive
/// the run.
struct SlamStage {
  const Settings<SlamParams>& settings;
  const sim::Values& parameters;
};

}  // namespace tumble::scenarios
