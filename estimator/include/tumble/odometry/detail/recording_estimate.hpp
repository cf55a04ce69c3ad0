// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/lidar_scale.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"
#include "tumble/odometry/detail/mapping_passes.hpp"

namespace tumble {

/// Results of TumblingOdometry for a whole recording, in addition to the sweeps of take().
struct WholeRecordingEstimate {
  explicit WholeRecordingEstimate(const LidarInertialOdometry::Params& mapping) : mapped_recording(mapping) {}

  std::vector<TimeNs>
      stamps_ns;  ///< received time stamps of the used samples; `rates` contains the times that SampleClock estimated
  std::vector<AngularRateState>
      rates;  ///< one per used sample; covariances include `suspected_error_covariance_rad2_s2`
  std::vector<Eigen::Matrix3d> suspected_error_covariance_rad2_s2;
  MotionRegimeSmoother::Report report;  ///< report of the rate estimation, with the rig constants
  SaturationLevels saturation_levels;
  ImuHealthReport findings;
  SensorHealth health;
  MappedRecording mapped_recording;  ///< without the sweeps, which TumblingOdometry::take() returns
  LidarScale scale;
  double corrected_jitter_s = 0.0;
};

}  // namespace tumble
