// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/common/sensor_health.hpp"
#include "tumble/mapping/detail/lidar_scale.hpp"
#include "tumble/mapping/detail/localisation.hpp"
#include "tumble/mapping/lidar_inertial_odometry.hpp"
#include "tumble/mapping/types.hpp"
#include "tumble/odometry/detail/waiting_input.hpp"

namespace tumble {

/// Sets the clip flags of saturated accelerometer readings that the device did not flag. Returns the saturation limits
/// of the recording. Cost: O(N), plus the search of ClippingFinder.
SaturationLevels flag_saturated_forces(const SaturationLimitDetector::Params& stated, std::span<ImuSample> samples);

struct MappingInput {
  std::span<const ImuSample> samples;       ///< samples after flag_saturated_forces()
  std::span<const AngularRateState> rates;  ///< one per sample
  std::size_t sweeps = 0;
  std::function<WaitingSweep(std::size_t)> sweep;  ///< function that returns the sweep with the given index
  /// Returns the odometer reading for a sweep from `from_ns` to `to_ns`; may be empty.
  std::function<std::optional<OdometerReading>(TimeNs from_ns, TimeNs to_ns)> reading = {};
  std::optional<Eigen::Isometry3d> start = std::nullopt;  ///< see LidarInertialOdometry::set_start_pose()
  /// See LidarInertialOdometry::set_start_tilt().
  std::optional<LidarInertialOdometry::StartTilt> start_tilt = std::nullopt;
};

struct MappedSweep {
  Status status;       ///< status of LidarInertialOdometry::add_sweep()
  SweepReport report;  ///< final poses; without a pose, `report.trajectory` is empty
};

/// The map and all sweeps come from the last pass.
struct MappedRecording {
  explicit MappedRecording(const LidarInertialOdometry::Params& params);

  Status status;  ///< error of a sample or of an odometer reading that ended the pass
  std::vector<MappedSweep> sweeps;
  std::size_t unfinished_sweeps = 0;  ///< unused sweeps that end after the last sample
  LidarInertialOdometry mapper;
  Localisation localisation;  ///< tracking failures over all sweeps
  int mapping_pass_count = 1;
  /// distance between the last calibration and the stated calibration (LidarImuCalibrationPrior::distance_in_sigmas)
  double calibration_deviations = 0.0;
  bool calibration_converged = false;
  /// The stated calibration contradicts the recording, and the last pass started from the estimated calibration.
  bool calibration_replaced = false;

  /// The estimated calibration differs from the stated calibration by more than the stated uncertainty allows.
  bool calibration_is_off() const;
  /// Adds findings about the scale of the lidar's ranges, the vertical, tracking, and the calibration of the lidar.
  void add_findings(const LidarScale& scale, SensorHealth& health) const;
};

/// If the IMU covers most of the last sweep, the sweep is cut at the last sample.
MappedRecording map_in_one_pass(const MappingInput& input, const LidarInertialOdometry::Params& params);

/// Processes a recording until the lidar's calibration has converged: mapping.md, "Second pass". The first pass
/// estimates the calibration. The last pass starts from the estimated calibration and builds a consistent map. If the
/// first pass contradicts the stated calibration, further passes treat the mounting as uncertain. If the calibration
/// changes by more than its uncertainty allows, another pass starts from the new value, at most three times. Passes
/// also end if more than one sweep in five is rejected, because such a pass does not determine the calibration.
MappedRecording map_with_calibration(const MappingInput& input, const LidarInertialOdometry::Params& params);

/// Returns the largest of the changes of rotation, translation and time offset from the stated to the estimated
/// calibration, in standard deviations of a change from a correct stated value (Hausman test): mapping.md, "Second
/// pass". In slow motion, this test finds a wrong mounting before LidarImuCalibrationPrior::distance_in_sigmas() does.
double calibration_contradiction(const LidarImuCalibrationPrior& stated, const LidarInertialOdometry& mapper);

LidarScale find_sweep_scale(std::span<const ImuSample> samples, const MappedRecording& mapped, double gravity_m_s2);

}  // namespace tumble
