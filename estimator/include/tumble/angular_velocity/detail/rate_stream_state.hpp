// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"
#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Accelerometer reading at the time stamp of a sample, before the correction of the delay between gyro and
/// accelerometer.
struct AngularRateStreamForce {
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();
  std::uint8_t device_clip_flags = 0;  ///< accelerometer bits of ImuSample::device_clip_flags
  std::uint8_t clipped_axes = 0;
  bool operator==(const AngularRateStreamForce&) const = default;
};

struct AngularRateStreamKnot {
  AngularRateObservation observation;  ///< with the specific force at the time of the gyro reading
  AngularRateStreamForce received_force;
  Clipping clipping_at_axis_limits;  ///< clipping from clip flags and equal readings, without saturation planes
  AngularRateEstimate estimate;
  Eigen::Matrix3d covariance_rad2_s2 = Eigen::Matrix3d::Zero();
  /// The smaller of the last two increases of the reading's magnitude per sample, for each gyro axis.
  Eigen::Vector3d plateau_growth_rad_s = Eigen::Vector3d::Zero();
  int knot_age_samples = 0;
  bool repeats_reading = false;
  RepeatedReading repeated;  ///< age of the gyro reading in a log that repeats readings
  std::uint8_t possibly_clipped_axes =
      0;  ///< gyro axes that may be saturated during a part of the averaging window: rails.md (R76)
};

/// Estimate of the delay between gyro and accelerometer: rate_stream.md (R104) to (R107).
struct AngularRateStreamDelay {
  ImpactDelayCorrelation impacts;
  double applied_delay_s = 0.0;  ///< delay that corrects the readings; the prior until `delay_found`
  double estimated_s = 0.0;      ///< latest estimate from impacts and free flight
  bool delay_found = false;      ///< true if the readings contradict the prior delay
  TriadDelay impact_delay;
  std::optional<TimeNs> updated_ns;
  bool operator==(const AngularRateStreamDelay&) const = default;
};

/// Information about scale, misalignment, g-sensitivity and delay errors from all samples that have left the window:
/// rate_stream.md (R100).
struct AngularRateStreamSensorErrors {
  struct WorkMatrices {
    arrow::BorderErrors border_errors, calibration_error_jacobian;
    SensorErrorInformation window_error_evidence;
    SensorErrorUncertainty::WorkMatrices posterior_workspace;
  };
  arrow::ErrorMatrix prior =
      arrow::ErrorMatrix::Zero();  ///< derivative of the gradient of the oldest sample with respect to the errors
  arrow::BorderErrors border_errors =
      arrow::BorderErrors::Zero();  ///< derivative of the gradient of the rig constants with respect to the errors
  SensorErrorInformation sensor_error_evidence;
  SensorErrorUncertainty::Posterior posterior;
  std::optional<TimeNs> updated_ns;
  AngularRateStreamDelay accel_delay_state;
  std::vector<arrow::ErrorMatrix> sample_jacobian;  ///< buffer
  WorkMatrices work_matrices;                       ///< buffer
};

struct AngularRateStreamState {
  StreamingClippingFinder::State clipping_state;
  RestDetector::State stationary_state;
  RepeatDetector::State repetition_state;
  FrozenAxes::State frozen_axes;
  FlightSignCheck::State flight_sign_check;
  std::vector<AngularRateStreamKnot> window;  ///< oldest first
  BodyImuConstants rig;
  BodyImuConstants::Matrix rig_covariance;
  // Gaussian prior on the oldest sample and the rig constants, from all earlier samples.
  arrow::Block prior;
  arrow::Corner prior_border_block;
  /// A vector with one element keeps this large state on the heap, for threads with a small stack.
  std::vector<AngularRateStreamSensorErrors> sensor_errors = std::vector<AngularRateStreamSensorErrors>(1);
  std::array<Eigen::Vector3d, 2> reading_extremes_rad_s{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  MinSaturationLevels min_saturation_levels;
  /// For each gyro axis: slope of the readings before a possible saturation, and number of possibly saturated samples
  /// that have left the window.
  Eigen::Vector3d slope_before_clipping_rad_s = Eigen::Vector3d::Zero(),
                  samples_since_clipping_start = Eigen::Vector3d::Zero();
  std::optional<AngularRateKnot> last_marginalised;
  TimeNs last_marginalised_ns = 0;
  AngularRateKnot prior_knot;
  BodyImuConstants prior_rig;
  std::size_t samples = 0;
  std::size_t samples_since_step = 0;
  std::size_t calibration_samples = 0;         ///< number of flight samples that have updated the rig constants
  std::size_t consecutive_flight_samples = 0;  ///< length of the current flight, in samples that have left the window
  std::size_t calibration_reset_count = 0;
  std::size_t failures = 0;  ///< Gauss-Newton steps skipped because the normal equations were not positive definite
  std::vector<arrow::Block> work_blocks;  ///< buffer
};

}  // namespace tumble
