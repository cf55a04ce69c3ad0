// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <optional>

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/rolling/detail/rolling_floor_params.hpp"
#include "tumble/rolling/detail/rolling_imu_params.hpp"
#include "tumble/rolling/detail/rolling_model.hpp"

namespace tumble {

struct RollingExpertParams {
  static constexpr double kNode_s = 0.02;  ///< time between two measurement updates (nodes)
  /// The rest detector processes the mean reading of each time step `kNode_s`. A larger limit of the rate would
  /// increase the drift of a sphere that comes to rest.
  RestDetector::Params rest_detector = {.rate_max_rad_s = 0.0115,
                                        .rate_spread_rad_s = 0.016,
                                        .force_spread_m_s2 = 0.15,
                                        .rest_s = 0.4,
                                        .caller_settings = {.memory_s = 0.1}};
  RollingPriorParams prior = {};
  RollingImuNoiseParams noise = {};
  RollingSaturationParams saturation = {};
  ContactModeParams modes = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("rest_", p.rest_detector);
    visit.group("", p.prior);
    visit.group("", p.noise);
    visit.group("", p.saturation);
    visit.group("", p.modes);
  }
};

struct RollingParams {
  double radius_m = 0.0;        ///< required
  double radius_sigma_m = 0.0;  ///< 0: the radius is exact
  Eigen::Vector3d lever_arm_m =
      Eigen::Vector3d::Zero();  ///< lever arm from the sphere's centre to the IMU, in sensor axes
  double lever_arm_sigma_m = 2e-3;
  std::optional<Eigen::Quaterniond> q_WI_start = {};  ///< attitude at the first sample; empty: tilt from gravity
  double gravity_m_s2 = 9.80665;
  /// readings at or above the range count as clipped, in addition to readings with clip flags
  double gyro_range_rad_s = 1e3;
  double accel_range_m_s2 = 1e5;
  /// Calibration from an earlier run, which replaces the prior of the sensor errors, the lever arm and the radius. The
  /// variances of the biases are increased by their prior variances, because biases change at every switch-on.
  std::shared_ptr<const RollingCalibration> calibration = {};

  using Expert = RollingExpertParams;
  Expert expert = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.radius_m, {"radius_m", "m", 1e-12, 10.0, "radius of the sphere"});
    visit(p.radius_sigma_m, {"radius_sigma_m", "m", 0.0, 1e3, "prior standard deviation of the radius; 0: exact",
                             ParameterAudience::common_use});
    visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre to the IMU, sensor axes"});
    visit(p.lever_arm_sigma_m, {"lever_arm_sigma_m", "m", 0.0, 1e3, "prior standard deviation of the lever arm",
                                ParameterAudience::common_use});
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
    visit(p.gyro_range_rad_s, {"gyro_range_rad_s", "rad/s", 1e-12, 1e3,
                               "measuring range of the gyro; readings at or above this value count as saturated"});
    visit(p.accel_range_m_s2,
          {"accel_range_m_s2", "m/s^2", 1e-12, 1e5,
           "measuring range of the accelerometer; readings at or above this value count as saturated"});
    visit.group("", p.expert);
  }
};

/// Throws InvalidParams if a parameter is out of bounds.
void require_valid(const RollingParams& params);

}  // namespace tumble
