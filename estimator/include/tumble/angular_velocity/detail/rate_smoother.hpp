// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/angular_velocity/detail/rail_detector.hpp"
#include "tumble/angular_velocity/detail/rail_plane.hpp"
#include "tumble/angular_velocity/detail/rate_model_params.hpp"
#include "tumble/angular_velocity/detail/rate_smoother_expert_params.hpp"
#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/detail/sensor_errors.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// RateSmootherParams contains the parameters of RateSmoother.
struct RateSmootherParams {
  RateModelParams model = {};
  RailDetector::Params rails = {};
  double recovered_sigma_rad_s = 0.5;  ///< clipped rates with a smaller standard deviation count as recovered
  /// Largest accepted Mahalanobis distance of the estimated rig constants from their prior
  /// (RateReport::calibration_mahalanobis). If the distance exceeds the maximum, RateSmoother estimates the run again
  /// with the rig constants fixed at the prior.
  double calibration_mahalanobis_max = 1.5;
  /// Sensor errors that an earlier run estimated (RateReport::sensor_errors). RateSmoother uses the earlier sensor
  /// errors only if the estimation of sensor errors is enabled.
  std::optional<KnownSensorErrors> calibrated_errors = std::nullopt;
  double gap_max_s = 1.0;  ///< a longer time between two samples is a gap; see estimate()

  using Expert = RateSmootherExpertParams;
  Expert expert = {};  ///< rarely changed parameters

  /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.model);
    visit.group("rails_", p.rails);
    visit(p.recovered_sigma_rad_s, {"recovered_sigma_rad_s", "rad/s", 0.0, 1e4,
                                    "maximum standard deviation of a clipped axis that is reported as recovered; "
                                    "otherwise the axis is reported as bounded",
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

/// RateReport contains the diagnostics of a run of RateSmoother.
struct RateReport {
  int iterations = 0;
  bool converged = false;
  int restarts = 0;              ///< number of restarts with other initial values after a solution without flight
  double last_step_rad_s = 0.0;  ///< largest change of a rate in the last iteration
  RigCalibration calibration;    ///< estimated calibration; can initialise the next run
  /// Mahalanobis distance of the estimated rig constants from their prior, in standard deviations. A distance far above
  /// 1 indicates a wrong prior, or a run without flight that RateSmoother classified as flight.
  double calibration_mahalanobis = 0.0;
  bool calibration_at_prior = false;          ///< the rig constants were fixed at their prior
  std::array<std::optional<double>, 6> rail;  ///< saturation limits: gyro [rad/s], accelerometer [m/s^2]; empty: none
  std::array<bool, 6> rail_observed{};        ///< the limit was observed on this axis, not inferred from another axis
  RailPlanes planes;                          ///< saturation planes of the gyro's sensing elements, where observed
  RailPlanes accel_planes;                    ///< saturation planes of the accelerometer's sensing elements, in m/s^2
  /// Estimated sensor errors and the covariance of the estimate.
  KnownSensorErrors sensor_errors;
  double data_sheet_probability = 1.0, synchronous_probability = 1.0;  ///< see SensorErrorFit
  /// Standard deviation of a delay common to gyro and accelerometer [s]. The value is zero if the device agrees with
  /// its data sheet.
  double common_delay_sigma_s = 0.0;
  double gyro_update_s = 0.0, accel_update_s = 0.0;  ///< update interval of repeated readings; 0: no repeated readings
  int error_rounds = 0;                              ///< number of optimisations with corrected readings
  bool clips_after_compensation = false;             ///< the gyro clips after misalignment compensation, axis by axis
  std::array<bool, 6> contradicts_stated_range{};    ///< whether the readings contradict the stated range
  std::size_t samples = 0, clipped = 0, recovered_flight = 0, recovered_contact = 0, bounded_only = 0;
  std::size_t missing_readings = 0;  ///< samples in which a gyro axis overflowed (flipped sign)
  double flight_share = 0.0;         ///< fraction of samples classified as free flight
  /// Gyro axes that may be saturated at a limit that was not found: one byte per sample, bit j for axis j.
  std::vector<std::uint8_t> suspect_axes;
};

/// Estimates the angular velocity of a tumbling body through gyro saturation, by tightly coupled smoothing over a whole
/// recording.
///
/// RateSmoother estimates the rate and angular acceleration of each sample, and the rig constants of the run
/// (RigConstants). A Gauss-Newton solver minimises the residuals of several measurements and constraints. Unclipped
/// gyro readings measure the rate, and clipped readings give a lower bound on the rate, for any number of axes. In
/// flight, the accelerometer measures only the effect of rotation at the lever arm, and Euler's equation holds without
/// torque. During contact, the force equation and Euler's equation have lower weights. Between samples, the angular
/// jerk is white noise, whose density increases with the contact force. An impact therefore decouples the rates before
/// the impact from the rates after the impact. At rest (RestDetector), the rate is zero, so the gyro measures its bias.
///
/// The normal equations have an arrow matrix, so an iteration costs O(N), including the covariance. The initial values
/// come from the published method (Saave), extended by the lower bounds of clipped readings.
///
/// The contact force at the centre of mass is the part of the measured force that the equations of flight do not
/// explain. A force through one point of the robot's cage has no torque about the direction of the force. RateSmoother
/// therefore keeps the component of Euler's equation along the contact force. The size of the cage determines the
/// uncertainty of the other two components of Euler's equation (RateContactParams::lever_rad_m). RateSmoother does not
/// estimate the contact point, because several bars of a cage touch the ground within 10 ms. The equations of
/// RateSmoother are in docs/maths/rate_smoother.md.
///
/// RateSmoother also estimates SensorErrors: scale, misalignment, g-sensitivity, and the accelerometer's delay and
/// window. RateSmoother corrects the readings with the estimated sensor errors and repeats the optimisation. The
/// function fit_sensor_errors() chooses the prior magnitude of the sensor errors that fits the readings. The
/// covariances of rates and rig constants include the remaining uncertainty of the sensor errors, as consider
/// parameters (Schmidt, 1966). Otherwise, the covariance would treat constant sensor errors as independent noise. If
/// gyro and accelerometer are not synchronous, RateSmoother assumes that the later of the two sensors is delayed.
///
/// The sensing elements of a gyro clip along their own axes, which are not quite orthogonal. The device's misalignment
/// compensation then mixes the clipped values into all output axes (RailPlaneFinder). While a sensing element clips,
/// RateSmoother therefore processes the gyro element by element. Unsaturated sensing elements measure a component of
/// the rate, and clipped sensing elements give a lower bound. RateSmoother estimates the sensing directions as
/// constants of the run, from saturation planes and from flight. If the device clips its output after misalignment
/// compensation, RateSmoother processes the gyro axis by axis.
///
/// RateSmoother does not model a persistent contact point, or a delay common to gyro and accelerometer. The estimated
/// rates refer to the time of the gyro's readings, which are means over the sample's window.
class RateSmoother {
 public:
  using Params = RateSmootherParams;

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RateSmoother(const Params& params);

  /// Computes one RateState per sample, and the diagnostics of the run. On error, the outputs are unchanged. The
  /// returned Status contains the faulty field, its value and its bound. The kind of error is `empty`, `too_few` (less
  /// than two samples), `non_finite`, `time_order` or `diverged`. RateSmoother keeps the calibration across a gap in
  /// the samples. Due to the white angular jerk, the rate after a gap is independent of the rate before the gap.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out, RateReport& report) const {
    return estimate(samples, {}, out, report);
  }
  /// Estimates the rates with additional IMUs on the body. The argument `auxiliary_imus` contains one list of readings
  /// per entry of RateModelParams::auxiliary_imus. The function align() computes such a list, with one reading per
  /// sample. Returns `too_few` if the number of lists or of readings is wrong.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<RateState>& out, RateReport& report) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
  ClippingFinder rails_;
  RestDetector rest_detector_;
};

}  // namespace tumble
