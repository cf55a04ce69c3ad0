// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/arrow_solver.hpp"
#include "tumble/angular_velocity/detail/device_uncertainty.hpp"
#include "tumble/angular_velocity/detail/flight_sign_check.hpp"
#include "tumble/angular_velocity/detail/frozen_axes.hpp"
#include "tumble/angular_velocity/detail/impact_sums.hpp"
#include "tumble/angular_velocity/detail/min_saturation_levels.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"
#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// accelerometer's reading at the time stamp of a sample
struct AngularRateStreamForce {
  Eigen::Vector3d force_m_s2 = Eigen::Vector3d::Zero();
  std::uint8_t device_clip_flags = 0;  ///< flags of the accelerometer
  std::uint8_t clipped_axes = 0;       ///< clipped axes, as Clipping::accel
  bool operator==(const AngularRateStreamForce&) const = default;
};

struct AngularRateStreamKnot {
  AngularRateObservation
      observation;  ///< with the specific force at the sample's own time; `received_force` has the received force
  AngularRateStreamForce received_force;
  Clipping clipping_at_axis_limits;  ///< clipping from flags and equal readings; the observation also uses planes
  AngularRateEstimate estimate;
  Eigen::Matrix3d covariance_rad2_s2 = Eigen::Matrix3d::Zero();
  /// smaller increase of each axis' magnitude per sample, among the last two samples
  Eigen::Vector3d plateau_growth_rad_s = Eigen::Vector3d::Zero();
  int knot_age_samples = 0;
  bool repeats_reading = false;            ///< the gyro repeats the previous reading: RepeatDetector
  RepeatedReading repeated;                ///< repetition of the gyro's reading; none at rest
  std::uint8_t possibly_clipped_axes = 0;  ///< axes that may be saturated during a part of the sample: rails.md (R76)
};

/// See rate_stream.md (R104) to (R107).
struct AngularRateStreamDelay {
  ImpactDelayCorrelation impacts;
  double applied_delay_s = 0.0;      ///< delay in use; the prior until a delay is found
  double estimated_s = 0.0;          ///< latest estimate from impacts and sensor-error evidence
  bool delay_found = false;          ///< true if the delay differs from the prior
  TriadDelay impact_delay;           ///< latest estimate from impacts alone
  std::optional<TimeNs> updated_ns;  ///< time of the last estimate from impacts
  bool operator==(const AngularRateStreamDelay&) const = default;
};

/// Information about sensor errors from all samples that have left the window: rate_stream.md (R100).
struct AngularRateStreamSensorErrors {
  struct WorkMatrices {
    arrow::BorderErrors border_errors, calibration_error_jacobian;
    SensorErrorInformation window_error_evidence;
    SensorErrorUncertainty::WorkMatrices posterior_workspace;
  };
  arrow::ErrorMatrix prior = arrow::ErrorMatrix::Zero();  ///< derivative of the oldest sample's gradient by the errors
  arrow::BorderErrors border_errors =
      arrow::BorderErrors::Zero();  ///< derivative of the calibration's gradient by the errors
  SensorErrorInformation sensor_error_evidence;
  SensorErrorUncertainty::Posterior posterior;  ///< latest uncertainty from the evidence
  std::optional<TimeNs> updated_ns;             ///< time of the latest update
  AngularRateStreamDelay accel_delay_state;
  std::vector<arrow::ErrorMatrix> sample_jacobian;  ///< buffer: d(sample) / d(errors)
  WorkMatrices work_matrices;                       ///< buffer
};

struct AngularRateStreamState {
  StreamingClippingFinder::State clipping_state;
  RestDetector::State stationary_state;
  RepeatDetector::State repetition_state;
  FrozenAxes::State frozen_axes;
  FlightSignCheck::State flight_sign_check;
  std::vector<AngularRateStreamKnot> window;  ///< oldest first
  RigConstants rig;
  RigConstants::Matrix rig_covariance;
  // Gaussian prior on oldest sample and calibration, from all earlier samples
  arrow::Block prior;
  arrow::Corner prior_border_block;
  /// one element on the heap, for threads with a small stack
  std::vector<AngularRateStreamSensorErrors> sensor_errors = std::vector<AngularRateStreamSensorErrors>(1);
  std::array<Eigen::Vector3d, 2> reading_extremes_rad_s{Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
  MinSaturationLevels min_saturation_levels;  ///< lower bounds from the readings so far
  /// slope of the readings before possible saturation, and number of possibly saturated samples that have left the
  /// window
  Eigen::Vector3d slope_before_clipping_rad_s = Eigen::Vector3d::Zero(),
                  samples_since_clipping_start = Eigen::Vector3d::Zero();
  std::optional<AngularRateKnot> last_marginalised;  ///< sample that left the window last, and its time
  TimeNs last_marginalised_ns = 0;
  AngularRateKnot prior_knot;
  RigConstants prior_rig;
  std::size_t samples = 0;
  std::size_t samples_since_step = 0;          ///< number of samples since the last Gauss-Newton step
  std::size_t calibration_samples = 0;         ///< flight samples that left the window and updated the calibration
  std::size_t consecutive_flight_samples = 0;  ///< consecutive flight samples among the last samples that left
  std::size_t calibration_reset_count = 0;     ///< number of resets of the calibration
  std::size_t failures = 0;                    ///< number of steps skipped because the system was not positive definite
  std::vector<arrow::Block> work_blocks;       ///< buffer, not part of the state
};

}  // namespace tumble
