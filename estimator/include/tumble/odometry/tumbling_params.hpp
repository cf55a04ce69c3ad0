// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "tumble/attitude/regime_stream.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/sample_clock.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/mapping/detail/calibration_fields.hpp"
#include "tumble/mapping/odometry_params.hpp"
#include "tumble/odometry/detail/further_lidars.hpp"
#include "tumble/odometry/detail/second_pass.hpp"
#include "tumble/odometry/imu_sheet.hpp"
#include "tumble/odometry/lidar_sheet.hpp"

namespace tumble {

/// If TumblingParams contains the same parameter, the value in TumblingParams applies. gravity_m_s2 applies to the
/// estimation of rates and of the map.
struct TumblingExpertParams {
  double gravity_m_s2 = 9.80665;
  /// Maximum number of sweeps that wait for IMU samples, in addition to the sweeps within the lag. At most sweeps_max
  /// sweeps wait for take(); then the oldest sweep is dropped.
  std::size_t sweeps_max = 16;
  /// The default `uncalibrated` = 0.003 assumes the device's data sheet until readings contradict the data sheet. The
  /// covariance of each rate includes the uncertainty of the calibration.
  RegimeStream::Params rate = rate_defaults();
  /// By default, gravity's direction and the saturation deficit (true rate minus clipped reading) are unknowns of the
  /// registration.
  OdometryParams mapping = mapping_defaults();
  SampleClock::Params stamps;
  SecondPass::Params second_pass;
  static OdometryParams mapping_defaults();
  static RegimeStream::Params rate_defaults();
  /// Names of parameters that are computed from other parameters; a name that ends in '*' stands for all names with
  /// that prefix. User values of computed parameters are ignored.
  static std::span<const char* const> derived_fields();

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.0, 100.0, "strength of gravity", FieldRank::basic});
    visit(p.sweeps_max, {"sweeps_max", "1", 1, 1e6, "maximum number of sweeps that wait for IMU data"});
    visit.group("rate_", p.rate);
    visit.group("mapping_", p.mapping);
    visit.group("stamps_", p.stamps);
    visit.group("second_pass_", p.second_pass);
  }
};

struct TumblingParams {
  static constexpr double kWholeRecording = 1e9;  ///< value of `lag_s`; see TumblingOdometry

  ImuSheet imu;
  /// Lever arm from the body's centre of mass to the IMU, in IMU axes, and its standard deviation per axis. The lever
  /// arm relates rates to forces; its error is estimated. The lever arm has no default, because zero would mean an IMU
  /// at the centre of mass.
  Eigen::Vector3d lever_arm_I_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double lever_arm_sigma_m = 0.01;
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  /// Standard deviations of T_IL and of the lidar's time offset, which are estimated; 0: exact.
  double mount_sigma_rad = 0.01;
  double mount_sigma_m = 0.006;
  double time_offset_sigma_s = 0.003;
  LidarSheet lidar;
  /// Box in lidar axes that contains the robot; lidar returns inside the box are dropped. The default, an empty Eigen
  /// box, keeps all returns. A box with swapped corners is rejected.
  Eigen::AlignedBox3d own_body_L;
  std::vector<FurtherLidar> further_lidars;  ///< lidars in addition to the first; see TumblingOdometry::add_sweep()
  /// Delay of reported rates and sweeps: at least two samples and at most 10 s, or kWholeRecording.
  double lag_s = 0.2;

  using Expert = TumblingExpertParams;
  Expert expert;  ///< rarely changed parameters

  StatedCalibration stated_calibration() const {
    StatedCalibration out{{}, mount_sigma_rad, mount_sigma_m, time_offset_sigma_s};
    out.calibration.T_IL = T_IL;
    return out;
  }

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("imu_", p.imu);
    visit(p.lever_arm_I_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre of mass to the IMU, IMU axes",
                            FieldRank::basic});
    visit(p.lever_arm_sigma_m,
          {"lever_arm_sigma_m", "m", 1e-9, 10.0, "standard deviation of the lever arm", FieldRank::basic});
    visit(p.mount_sigma_rad, calibration_fields::kMountSigma_rad);
    visit(p.mount_sigma_m, calibration_fields::kMountSigma_m);
    visit(p.time_offset_sigma_s, calibration_fields::kTimeOffsetSigma_s);
    visit.group("", p.lidar);
    visit(p.lag_s, {"lag_s", "s", 0.0, kWholeRecording,
                    "maximum time for which a sweep waits for later data, at most 10 s; a longer time adds delay and "
                    "makes poses more accurate; 1e9: the whole recording",
                    FieldRank::basic});
    visit.group("", p.expert);
  }
};

}  // namespace tumble
