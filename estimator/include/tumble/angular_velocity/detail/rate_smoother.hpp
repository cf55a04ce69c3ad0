// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/rate_smoother_expert_params.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_limit_detector.hpp"
#include "tumble/angular_velocity/detail/saturation_plane.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

struct AngularRateSmootherParams {
  AngularRateModelParams model = {};
  SaturationLimitDetector::Params saturation_detector = {};
  /// Maximum Mahalanobis distance of the estimated rig constants from their prior. If the distance is larger, the rig
  /// constants are fixed at the prior.
  double calibration_mahalanobis_max = 1.5;
  /// Scale, misalignment, g-sensitivity and delay errors from an earlier run (AngularRateReport::sensor_errors). They
  /// are used only if `error_rounds_max` is above 1.
  std::optional<KnownSensorErrors> calibrated_errors = std::nullopt;
  static constexpr double kGapMax_s = 1.0;

  using Expert = AngularRateSmootherExpertParams;
  Expert expert = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.model);
    visit(p.calibration_mahalanobis_max, {"calibration_mahalanobis_max", "1", 0.1, 1e6,
                                          "maximum Mahalanobis distance between the estimated rig constants and their "
                                          "prior; a larger distance fixes the constants at the prior",
                                          ParameterAudience::common_use});
    visit.group("", p.expert);
  }
};

struct AngularRateReport {
  int iterations = 0;
  bool converged = false;
  int restarts = 0;  ///< restarts with other initial values, because a solution contained no free flight
  double last_step_rad_s = 0.0;
  BodyImuCalibration calibration;
  /// Mahalanobis distance of the estimated rig constants from their prior, in standard deviations. A distance far above
  /// 1 indicates a wrong prior, or contact that was classified as free flight.
  double calibration_mahalanobis = 0.0;
  bool calibration_at_prior = false;                       ///< the rig constants were fixed at their prior
  std::array<std::optional<double>, 6> saturation_limits;  ///< gyro [rad/s], accelerometer [m/s^2]; empty: unknown
  std::array<bool, 6> saturation_limit_observed{};         ///< false: inferred from another axis
  SaturationPlanes gyro_planes;
  SaturationPlanes accel_saturation_planes;
  KnownSensorErrors sensor_errors;
  double data_sheet_probability = 1.0, synchronous_triads_probability = 1.0;  ///< see SensorErrorFit
  /// Standard deviation of the common delay of gyro and accelerometer [s]; 0 if the IMU agrees with its data sheet.
  double common_delay_sigma_s = 0.0;
  double gyro_update_interval_s = 0.0,
         accel_update_interval_s = 0.0;   ///< update period of a sensor slower than the log; 0: no repeated readings
  int correction_iterations = 0;          ///< number of optimisations with readings corrected for sensor errors
  bool clips_after_compensation = false;  ///< the gyro clips each output axis, after its misalignment compensation
  std::array<bool, 6> contradicts_stated_range{};  ///< in the order of saturation_limits
  std::size_t samples = 0, clipped_sample_count = 0, recovered_in_flight = 0, recovered_in_contact = 0,
              lower_bound_only = 0;
  std::size_t missing_readings = 0;  ///< samples in which a gyro axis overflowed and changed its sign
  double flight_fraction = 0.0;
  /// Gyro axes that may be saturated at an unknown limit. One byte per sample; bit j stands for axis j.
  std::vector<std::uint8_t> suspected_saturation_axes;
};

/// Estimates the angular velocity of a tumbling body through gyro saturation, by tightly coupled smoothing over a whole
/// recording.
///
/// AngularRateSmoother estimates the rate and angular acceleration of each sample, and the rig constants of the run
/// (BodyImuConstants). Unclipped gyro readings measure the rate, and clipped readings give a lower bound on the rate.
/// In free flight, the specific force at the lever arm and Euler's equation determine the rate on clipped axes. During
/// contact, both have lower weights. Between samples, the angular jerk is white noise, whose density increases with the
/// contact force. The equations are in docs/maths/rate_smoother.md.
///
/// A Gauss-Newton solver starts from the rates of SaturationAwareRateEstimator. An iteration over N samples costs O(N),
/// including the covariance.
///
/// AngularRateSmoother also estimates scale, misalignment, g-sensitivity and delay of gyro and accelerometer
/// (SensorErrors), and repeats the optimisation with corrected readings. The covariances of rates and rig constants
/// include the remaining uncertainty of the sensor errors.
///
/// While a sensing element clips, AngularRateSmoother processes the gyro element by element. The reason is the
/// misalignment compensation in the gyro, which spreads the error of the clipped element over all output axes.
///
/// The estimated rates are means over the averaging windows of the gyro readings. AngularRateSmoother does not model a
/// persistent contact point, or a common delay of gyro and accelerometer.
class AngularRateSmoother {
 public:
  using Params = AngularRateSmootherParams;

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit AngularRateSmoother(const Params& params);

  /// Returns `ok`, `empty`, `insufficient_data` (less than two samples), `non_finite`, `time_order` or `diverged`. On
  /// error, the outputs are unchanged. A gap between two samples separates the rates before and after, but the
  /// calibration is common.
  Status estimate(std::span<const ImuSample> samples, std::vector<AngularRateState>& out,
                  AngularRateReport& report) const {
    return estimate(samples, {}, out, report);
  }
  /// Estimates the rates with additional IMUs on the body. `auxiliary_imus` contains one list of readings (from
  /// align()) per entry of AngularRateModelParams::auxiliary_imus. Returns `insufficient_data` if the number of lists
  /// or of readings is wrong.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<AngularRateState>& out, AngularRateReport& report) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
  ClippingFinder clipping_finder_;
  RestDetector rest_detector_;
};

struct AuxiliaryRecording {
  AuxiliaryImu imu;  ///< the sensing directions are ignored and estimated by align()
  SaturationLimitDetector::Params stated_saturation_limits;
  std::vector<ImuSample> samples;
};

/// Interpolates the readings of additional IMUs at the time stamps of the primary IMU. Appends each additional IMU,
/// with estimated sensing directions, to `model.auxiliary_imus`, and the interpolated readings to `out`. Recordings
/// beyond the first kAuxiliaryImusMax are ignored. Returns `ok`, or the first error of align() for a single IMU. Cost:
/// O(N), plus ClippingFinder::find().
Status align(std::span<const AuxiliaryRecording> recordings, std::span<const ImuSample> primary, double gap_max_s,
             AngularRateModelParams& model, std::vector<std::vector<AuxiliaryReading>>& out);

}  // namespace tumble
