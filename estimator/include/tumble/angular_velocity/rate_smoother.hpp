// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rate_smoother_expert_params.hpp"
#include "tumble/angular_velocity/rail_detector.hpp"
#include "tumble/angular_velocity/rail_plane.hpp"
#include "tumble/angular_velocity/rate_model_params.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/angular_velocity/sensor_errors.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Parameters of RateSmoother.
struct RateSmootherParams {
  RateModelParams model = {};
  RailDetector::Params rails = {};
  double recovered_sigma_rad_s = 0.5;  ///< clipped rates below this standard deviation count as recovered
  /// Largest accepted distance of the calibration constants from their prior (RateReport::calibration_mahalanobis). If
  /// the distance exceeds the limit, the run is estimated again with the calibration constants fixed at the prior.
  double calibration_mahalanobis_max = 1.5;
  /// Sensor errors that an earlier run estimated (RateReport::sensor_errors). The calibrated errors are used only if
  /// the estimation of sensor errors is enabled.
  std::optional<KnownSensorErrors> calibrated_errors = std::nullopt;
  double gap_max_s = 1.0;  ///< a longer time between samples separates parts of the recording

  using Expert = RateSmootherExpertParams;
  Expert expert = {};  ///< parameters that few users change

  /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.model);
    visit.group("rails_", p.rails);
    visit(p.recovered_sigma_rad_s,
          {"recovered_sigma_rad_s", "rad/s", 0.0, 1e4,
           "a clipped axis with a smaller standard deviation is reported as recovered, otherwise as bounded",
           FieldRank::basic});
    visit(p.calibration_mahalanobis_max, {"calibration_mahalanobis_max", "1", 0.1, 1e6,
                                          "maximum Mahalanobis distance between the estimated rig constants and their "
                                          "prior; a larger distance is reported as an error",
                                          FieldRank::basic});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                        "maximum time between two samples of one part; no rate is estimated across a longer gap"});
    visit.group("", p.expert);
  }
};

/// Diagnostics of a run.
struct RateReport {
  int iterations = 0;
  bool converged = false;
  int restarts = 0;              ///< restarts from other initial values, because the initial solution had no flight
  double last_step_rad_s = 0.0;  ///< largest change of a rate in the last iteration
  RigCalibration calibration;    ///< estimated calibration, which can initialise the next run
  /// Distance of the calibration constants from their prior, in standard deviations
  /// (RateModel::calibration_mahalanobis). A distance far above 1 indicates a wrong prior, or a run without flight that
  /// was classified as a run with flight.
  double calibration_mahalanobis = 0.0;
  bool calibration_at_prior = false;          ///< the constants are fixed at their prior
  std::array<std::optional<double>, 6> rail;  ///< saturation levels: gyro [rad/s], accelerometer [m/s^2]; empty: none
  std::array<bool, 6> rail_observed{};        ///< the level was observed on this axis, not inferred from another axis
  RailPlanes planes;                          ///< saturation planes of the gyro's elements, where observed
  RailPlanes accel_planes;                    ///< saturation planes of the accelerometer's elements, m/s^2
  /// Estimated sensor errors.
  KnownSensorErrors sensor_errors;
  double data_sheet_probability = 1.0, synchronous_probability = 1.0;  ///< see SensorErrorFit
  /// Standard deviation of a delay common to gyro and accelerometer [s]. The standard deviation of the common delay is
  /// above 0 only if the device deviates from its data sheet.
  double common_delay_sigma_s = 0.0;
  double gyro_update_s = 0.0, accel_update_s = 0.0;  ///< update interval of repeated readings; 0: none
  int error_rounds = 0;                              ///< number of optimisations with corrected readings
  bool clips_after_compensation = false;           ///< the gyro clips after compensation, so other axes are unaffected
  std::array<bool, 6> contradicts_stated_range{};  ///< readings contradict the stated range
  bool rate_unit_suspect = false;   ///< a reading exceeds RateModelParams::rate_max_rad_s: possibly degrees
  bool force_unit_suspect = false;  ///< the median specific force is near 1: possibly in g
  std::size_t samples = 0, clipped = 0, recovered_flight = 0, recovered_contact = 0, bounded_only = 0;
  std::size_t missing_readings = 0;  ///< samples with an overflow (flipped sign)
  double flight_share = 0.0;         ///< fraction of samples classified as free flight
  /// Axes whose reading may be saturated although no saturation was detected: one byte per sample, bit j for axis j.
  std::vector<std::uint8_t> suspect_axes;
};

/// Estimates the angular velocity of a tumbling body through gyro saturation, by tightly coupled smoothing over a whole
/// recording.
///
/// The unknowns are the rate and angular acceleration of each sample, and the RigConstants of the run. A Gauss-Newton
/// solver uses the following factors.
/// Unclipped gyro readings measure the rate, and clipped readings limit the rate from below, for any number of axes.
/// In flight, the specific force at the lever arm follows the complete rigid-body equation, and Euler's equation holds
/// without torque. During contact, the weights of the force equation and of Euler's equation are reduced.
/// Between samples, the angular jerk is white noise. The density of the jerk noise grows with the contact force. An
/// impact therefore decouples the samples before the impact from the samples after the impact.
/// At rest (RestDetector), the rate is zero, which determines the gyro's bias.
///
/// The normal equations are an arrow matrix, so an iteration costs O(N), including the covariance. The initial values
/// come from the published method (Saave), extended by the lower bounds of clipped readings.
///
/// In contact, the contact force at the centre of mass is the part of the measured force that the equations of flight
/// do not explain. A force through one point of the cage has no torque about the direction of the force. The component
/// of Euler's equation along the contact force therefore remains in use. The size of the cage determines the
/// uncertainty of the two components of Euler's equation across the contact force (RateContactParams::lever_rad_m).
/// RateSmoother does not estimate the contact point, because a cage strikes with several bars and rolls on within 10
/// ms.
/// The equations are in docs/maths/rate_smoother.md.
///
/// SensorErrors (scale, misalignment, g-sensitivity, accelerometer delay and window) are partly correlated with
/// RigConstants (lever arm, biases, inertia). Repeated optimisations with corrected readings estimate the sensor
/// errors, as far as the run determines the errors. The function fit_sensor_errors chooses the prior magnitude of the
/// sensor errors that fits the readings. The covariances of rates and calibration include the remaining uncertainty of
/// the sensor errors, as considered parameters (Schmidt, 1966). Without considered parameters, the covariance would
/// shrink as if constant sensor errors were independent noise. The function guess_triad_delay computes an initial
/// delay. If gyro and accelerometer are not synchronous, RateSmoother assumes that the later triad is delayed.
///
/// The sensing elements of a gyro clip along their own axes, which are not quite orthogonal. The compensation of the
/// device then mixes the clipped values into all output axes (RailPlaneFinder). While a sensing element clips,
/// RateSmoother therefore processes the gyro element by element (element_factor). Unsaturated sensing elements measure
/// a component of the rate, and clipped sensing elements provide a lower bound. RateSmoother corrects the readings of
/// unclipped axes for the part of the rate that saturation hides. The sensing directions are constants of the run,
/// determined by saturation planes and by flight. If the device clips its output after compensation, RateSmoother
/// processes the gyro axis by axis.
///
/// RateSmoother does not model a persistent contact point, or a delay common to gyro and accelerometer. The rates refer
/// to the time of the gyro's readings, which are means over the sample's window.
class RateSmoother {
 public:
  using Params = RateSmootherParams;

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RateSmoother(const Params& params);

  /// Computes one RateState per sample, and the diagnostics of the run. On error nothing is written. The returned
  /// status contains field, value and bound. The kind of error is `empty`, `too_few` (less than two samples),
  /// `non_finite`, `time_order` or `diverged`. After a gap in the samples, the calibration continues, and the white
  /// angular jerk leaves the rate after the gap independent of the rate before it.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out, RateReport& report) const {
    return estimate(samples, {}, out, report);
  }
  /// Estimates the rates with additional IMUs on the body. `auxiliary_imus` contains one list per entry of
  /// RateModelParams::auxiliary_imus, with one reading per sample (see align()). Returns `too_few` if the number of
  /// lists or of readings differs.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<RateState>& out, RateReport& report) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
  ClippingFinder rails_;
  RestDetector rest_detector_;
};

}  // namespace tumble
