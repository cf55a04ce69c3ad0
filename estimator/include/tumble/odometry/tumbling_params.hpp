// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <vector>

#include "tumble/common/indirect.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/mapping/calibration.hpp"
#include "tumble/odometry/sensor_sheets.hpp"

namespace tumble {

struct TumblingExpertParams;
extern template class HeapValue<TumblingExpertParams>;

/// FurtherLidar is a lidar in addition to the lidar of TumblingParams. The mounting relative to the first lidar and the
/// clock offset must be exact, because TumblingOdometry estimates only the mounting of the first lidar.
struct FurtherLidar {
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  LidarDataSheet data_sheet;
  Eigen::AlignedBox3d own_body_L;  ///< see TumblingParams::own_body_L, in axes of this lidar
  double time_offset_s = 0.0;      ///< clock of the first lidar minus clock of this lidar
};

struct TumblingParams {
  static constexpr double kWholeRecording = 1e9;  ///< value of `lag_s`; see TumblingOdometry

  ImuDataSheet imu;
  /// Lever arm from the body's centre of mass to the IMU, in IMU axes, and its standard deviation per axis. In free
  /// flight, the lever arm relates the angular rate to the measured specific force. TumblingOdometry estimates the
  /// error of the stated lever arm. The lever arm has no default, because zero would mean an IMU at the centre of mass.
  Eigen::Vector3d lever_arm_I_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  double lever_arm_sigma_m = 0.01;
  Eigen::Isometry3d T_IL = Eigen::Isometry3d::Identity();  ///< pose of the lidar in IMU axes
  /// Standard deviations of T_IL and of the lidar's time offset. Both are estimated; 0: exact, not estimated.
  double mount_sigma_rad = 0.01;
  double mount_sigma_m = 0.006;
  double time_offset_sigma_s = 0.003;
  LidarDataSheet lidar;
  /// Box in lidar axes that contains the robot; lidar returns inside the box are dropped. The default, an empty Eigen
  /// box, keeps all returns. A box with swapped corners is rejected.
  Eigen::AlignedBox3d own_body_L;
  std::vector<FurtherLidar> further_lidars;  ///< lidars in addition to the first; see TumblingOdometry::add_sweep()
  /// Delay of reported rates and sweeps: at least two samples and at most 10 s, or kWholeRecording.
  double lag_s = 0.2;

  using Expert = TumblingExpertParams;
  HeapValue<Expert> expert;  ///< rarely changed parameters, odometry/tumbling_expert_params.hpp

  LidarImuCalibrationPrior calibration_prior() const {
    LidarImuCalibrationPrior out{{}, mount_sigma_rad, mount_sigma_m, time_offset_sigma_s};
    out.calibration.T_IL = T_IL;
    return out;
  }

  /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning. A caller needs
  /// odometry/tumbling_expert_params.hpp.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("imu_", p.imu);
    visit(p.lever_arm_I_m, {"lever_arm_m", "m", -10.0, 10.0, "lever arm from the centre of mass to the IMU, IMU axes",
                            ParameterRank::common_use});
    visit(p.lever_arm_sigma_m,
          {"lever_arm_sigma_m", "m", 1e-9, 10.0, "standard deviation of the lever arm", ParameterRank::common_use});
    visit(p.mount_sigma_rad, calibration_fields::kMountSigma_rad);
    visit(p.mount_sigma_m, calibration_fields::kMountSigma_m);
    visit(p.time_offset_sigma_s, calibration_fields::kTimeOffsetSigma_s);
    visit.group("", p.lidar);
    visit(p.lag_s, {"lag_s", "s", 0.0, kWholeRecording,
                    "maximum time for which a sweep waits for later data, at most 10 s; a longer time adds delay and "
                    "makes poses more accurate; 1e9: the whole recording",
                    ParameterRank::common_use});
    visit.group("", *p.expert);
  }
};

}  // namespace tumble
