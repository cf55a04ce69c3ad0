// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>

#include "tumble/attitude/regime_stream.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/detail/calibration_fields.hpp"
#include "tumble/mapping/odometry_params.hpp"
#include "tumble/odometry/detail/second_pass.hpp"
#include "tumble/odometry/imu_sheet.hpp"
#include "tumble/odometry/lidar_sheet.hpp"

namespace tumble {

/// What few need of TumblingParams. Of the same numbers those of TumblingParams count, and gravity_m_s2 for all parts.
struct TumblingExpertParams {
  double gravity_m_s2 = 9.80665;
  /// Sweeps that may wait for the IMU, beside those that the lag holds back; and for take(), the oldest being
  /// dropped.
  std::size_t sweeps_max = 16;
  /// With a device that is taken for what its sheet says until the readings tell otherwise (`uncalibrated` 0.003): what
  /// is open of it widens each rate, and sweeps are placed by them before the readings have told.
  RegimeStream::Params rate = rate_defaults();
  /// With gravity's direction and what the rails hid of the rate among the unknowns.
  OdometryParams mapping = mapping_defaults();
  /// Of stamps that a host put on the IMU's samples.
  SampleClock::Params stamps;
  /// The second pass over the first seconds of motion, with what they told of rig and calibration.
  SecondPass::Params again;
  static OdometryParams mapping_defaults();
  static RegimeStream::Params rate_defaults();

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity", Rank::first});
    visit(p.sweeps_max, {"sweeps_max", "1", 1, 1e6, "largest number of sweeps waiting for IMU data"});
    visit.group("rate_", p.rate);
    visit.group("mapping_", p.mapping);
    visit.group("stamps_", p.stamps);
    visit.group("again_", p.again);
  }
};

/// Of TumblingOdometry.
struct TumblingParams {
  ImuSheet imu;
  /// From the body's centre of mass to the IMU, in IMU axes: what turns rates into forces; and how well it is known
  /// (standard deviation per axis). It is estimated. Has no default: zero is an IMU at the centre of mass.
  Eigen::Vector3d lever_arm_I_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double lever_arm_sigma_m = 0.01;
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< lidar in IMU axes
  /// Of T_IL and of the lidar's clock: standard deviations, both are estimated; 0: exact.
  double mount_sigma_rad = 0.01;
  double mount_sigma_m = 0.006;
  double time_offset_sigma_s = 0.003;
  LidarSheet lidar;
  /// Returns inside are the robot's own; Eigen's empty box, as here: none are. One whose corners are swapped is
  /// refused.
  Eigen::AlignedBox3d own_body_L;
  double lag_s =
      0.2;  ///< how old a sample is when its rate is given out; a sweep waits no longer, two samples at least

  using Expert = TumblingExpertParams;
  Expert expert;  ///< what few need

  /// T_IL and the clock, as sure as they are given.
  GivenCalibration given_calibration() const {
    GivenCalibration out{{}, mount_sigma_rad, mount_sigma_m, time_offset_sigma_s};
    out.calibration.T_IL = T_IL;
    return out;
  }

  /// Every number of it, stated once.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("imu_", p.imu);
    visit(p.lever_arm_I_m,
          {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre of mass to the IMU, IMU axes", Rank::first});
    visit(p.lever_arm_sigma_m,
          {"lever_arm_sigma_m", "m", 1e-9, 10.0, "standard deviation of the lever arm", Rank::first});
    visit(p.mount_sigma_rad, calibration_fields::kMountSigma_rad);
    visit(p.mount_sigma_m, calibration_fields::kMountSigma_m);
    visit(p.time_offset_sigma_s, calibration_fields::kTimeOffsetSigma_s);
    visit.group("", p.lidar);
    visit(p.lag_s, {"lag_s", "s", 0.0, 10.0, "longest time that a sweep waits for later data", Rank::first});
    visit.group("", p.expert);
  }
};

}  // namespace tumble
