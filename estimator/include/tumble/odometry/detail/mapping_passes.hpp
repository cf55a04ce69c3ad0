// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"

namespace tumble {

/// Sets the clip flags of saturated accelerometer readings without clip flag. Returns the saturation limits of the
/// recording. Cost: O(N), plus the search of ClippingFinder.
SaturationLevels flag_saturated_forces(const SaturationLimitDetector::Params& stated, std::span<ImuSample> samples);

struct MappingInput {
  std::span<const ImuSample> samples;  ///< after flag_saturated_forces()
  std::span<const AngularRateState> rates;
  std::size_t sweeps = 0;
  std::function<WaitingSweep(std::size_t)> sweep;
  /// Returns the odometer reading for a sweep from `from_ns` to `to_ns`; may be empty.
  std::function<std::optional<OdometerReading>(TimeNs from_ns, TimeNs to_ns)> reading = {};
  std::optional<Eigen::Isometry3d> start = std::nullopt;  ///< see LidarInertialOdometry::set_start_pose()
  /// See LidarInertialOdometry::set_start_tilt_correction().
  std::optional<LidarInertialOdometry::StartTiltCorrection> start_tilt_correction = std::nullopt;
};

struct MappedSweep {
  Status status;       ///< status of LidarInertialOdometry::add_sweep()
  SweepResult result;  ///< final poses; without a pose, `result.trajectory` is empty
};

/// Result of the last pass over a recording.
struct MappedRecording {
  explicit MappedRecording(const LidarInertialOdometry::Params& params);

  Status status;  ///< error of the IMU sample or odometer reading that ended the pass
  std::vector<MappedSweep> sweeps;
  std::size_t unfinished_sweeps = 0;  ///< number of sweeps that end after the last IMU sample, and are not used
  LidarInertialOdometry mapper;
  Localisation localisation;
  int mapping_pass_count = 1;
  /// LidarImuCalibrationPrior::distance_in_sigmas() of the last calibration
  double calibration_deviations = 0.0;
  bool calibration_converged = false;
  /// true: the recording contradicts the stated calibration, so the last pass started from the estimated calibration
  bool calibration_replaced = false;

  /// Returns true if the estimated calibration differs from the stated calibration by more than the stated standard
  /// deviations allow.
  bool calibration_is_off() const;
  /// Adds findings about the scale of the lidar's ranges, the vertical, tracking, and the calibration of the lidar.
  void add_findings(const LidarScale& scale, SensorHealth& health) const;
};

/// Processes a recording once. If the last IMU sample is before the end of the last sweep, but covers most of it, the
/// sweep is cut.
MappedRecording map_in_one_pass(const MappingInput& input, const LidarInertialOdometry::Params& params);

/// Processes a recording until the lidar's calibration has converged: mapping.md, "Second pass". The first pass
/// estimates pose and time offset of the lidar. The last pass starts from these values and builds a consistent map. If
/// the first pass contradicts the stated lidar pose, further passes treat this pose as uncertain. If a pass changes the
/// calibration by more than five prior standard deviations, another pass follows, at most three times. Passes also end
/// if more than one sweep in five is rejected, because such a pass does not determine the calibration.
MappedRecording map_with_calibration(const MappingInput& input, const LidarInertialOdometry::Params& params);

/// Tests the stated pose and time offset of the lidar against the estimates (Hausman test): mapping.md, "Second pass".
/// Returns the largest normalised change: change of rotation, translation or time offset, divided by its standard
/// deviation for a correct stated value. In slow motion, this test detects a wrong lidar pose earlier than
/// LidarImuCalibrationPrior::distance_in_sigmas().
double calibration_contradiction(const LidarImuCalibrationPrior& stated, const LidarInertialOdometry& mapper);

LidarScale find_sweep_scale(std::span<const ImuSample> samples, const MappedRecording& mapped, double gravity_m_s2);

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
