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
  double recovered_sigma_rad_s = 0.5;  ///< a clipped axis with a smaller standard deviation is recovered
  /// If the constants move further from their prior (RateReport::calibration_mahalanobis), the run is estimated again
  /// with the constants fixed at the prior.
  double calibration_mahalanobis_max = 1.5;
  /// Sensor errors from an earlier run (RateReport::sensor_errors). Only used if sensor errors are estimated.
  std::optional<KnownSensorErrors> learnt_errors = std::nullopt;
  double gap_max_s = 1.0;  ///< a longer time between samples is an error

  using Expert = RateSmootherExpertParams;
  Expert expert = {};  ///< parameters that few users change

  /// Visits every parameter: its value, name, unit, bounds and meaning (common/parameters.hpp).
  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.model);
    visit.group("rails_", p.rails);
    visit(
        p.recovered_sigma_rad_s,
        {"recovered_sigma_rad_s", "rad/s", 0.0, 1e4,
         "largest standard deviation for a clipped axis to be reported as recovered instead of bounded", Rank::first});
    visit(p.calibration_mahalanobis_max,
          {"calibration_mahalanobis_max", "1", 0.1, 1e6,
           "largest Mahalanobis distance of the rig constants from their prior", Rank::first});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                        "longest allowed time between two samples; a longer gap ends the run with an error"});
    visit.group("", p.expert);
  }
};

/// Diagnostics of a run.
struct RateReport {
  int iterations = 0;
  bool converged = false;
  int restarts = 0;              ///< restarts from other initial values, if the first found almost no flight
  double last_step_rad_s = 0.0;  ///< largest change of a rate in the last iteration
  RigCalibration calibration;    ///< estimated calibration, which can be passed to the next run
  /// Distance of the constants from their prior (RateModel::calibration_mahalanobis). Far above 1: a wrong prior, or a
  /// run without flight that was mistaken for one with flight.
  double calibration_mahalanobis = 0.0;
  bool calibration_at_prior = false;          ///< the distance was too large; the constants remain at their prior
  std::array<std::optional<double>, 6> rail;  ///< levels in use: gyro [rad/s], accelerometer [m/s^2]; empty: none
  std::array<bool, 6> rail_seen{};            ///< observed on this axis, not inferred
  RailPlanes planes;                          ///< of the gyro's elements, where observed
  RailPlanes accel_planes;                    ///< of the accelerometer's elements, m/s^2
  /// Estimated sensor errors.
  KnownSensorErrors sensor_errors;
  double calibrated = 1.0, together = 1.0;  ///< see SensorErrorFit
  /// Standard deviation of a delay common to both triads; above 0 if the device deviates from its data sheet.
  double shared_delay_sigma_s = 0.0;
  double gyro_update_s = 0.0, accel_update_s = 0.0;  ///< update interval of repeated readings; 0: none
  int error_rounds = 0;                              ///< number of descents with corrected readings
  bool rails_upright = false;                        ///< the device clips its output, so other axes are unaffected
  std::array<bool, 6> rail_disagrees{};              ///< readings contradict the stated range
  bool rate_unit_suspect = false;   ///< a reading exceeds RateModelParams::rate_max_rad_s: possibly degrees
  bool force_unit_suspect = false;  ///< the median specific force is near 1: possibly in g
  std::size_t samples = 0, clipped = 0, recovered_flight = 0, recovered_contact = 0, bounded_only = 0;
  std::size_t missing_readings = 0;  ///< samples with an overflow (flipped sign)
  double flight_share = 0.0;         ///< fraction of samples classified as free flight
  /// Bit j, one byte per sample: the reading of axis j may be saturated although no saturation was detected.
  std::vector<std::uint8_t> doubted_axes;
};

/// Estimates the angular velocity of a tumbling body through gyro saturation: a tightly coupled smoother over a
/// recording.
///
/// Unknowns: rate and angular acceleration per sample, and RigConstants for the run. Gauss-Newton uses these factors:
/// - The gyro's readings where not clipped, and the bounds given by clipped readings, for any number of axes.
/// - In flight, the complete rigid-body equation of the specific force at the lever arm, and Euler's equation without
///   torque. During contact, both equations have reduced weight.
/// - White noise on jerk between samples. The density grows with the contact force: impacts interrupt the chain.
/// - At rest (RestDetector), zero rate, which determines the gyro's bias.
///
/// The normal equations are an arrow matrix: O(N) per iteration, including the covariance. The initial values come from
/// the published method (Saave), extended by bounds.
///
/// Contact: the force at the centre of mass is the part of the reading that flight does not explain. A force through
/// one point of the cage has no torque about its own direction. This row of Euler's equation therefore remains in use.
/// The uncertainty of the two other rows follows from the size of the cage (RateContactParams::lever_rad_m). The
/// position of the contact point gives no further information, because a cage strikes with several bars and rolls on
/// within 10 ms. For clipped samples, the median torque along the force is 1.4 %, but the contact point of the previous
/// sample leaves 66 % of the torque unexplained (tests/bench/rate_contact; docs/maths/rate_smoother.md).
///
/// Sensor errors (SensorErrors: scale, misalignment, g-sensitivity, delay and window of the accelerometer relative to
/// the gyro) are partly correlated with other constants. Sensor errors are estimated as far as the run determines them,
/// by repeated descents with corrected readings. Their prior magnitude is chosen to fit the readings
/// (fit_sensor_errors). The remaining uncertainty is included in both covariances as considered parameters (S. F.
/// Schmidt, 1966). Otherwise the fit would treat these errors as noise and average them. guess_triad_delay computes an
/// initial delay. If the two triads are not synchronous, the later one is assumed to be delayed.
///
/// The elements of a gyro clip along their own, not quite orthogonal axes. The device's compensation then mixes the
/// clipped values (RailPlaneFinder). While an element clips, the gyro is therefore used element by element
/// (element_factor). Free elements measure, clipped elements bound, and the other axes are corrected for the saturation
/// deficit. The rows are constants of the run, determined by saturation planes and by flight. If the device clips its
/// output, none of this is needed.
///
/// Not modelled: a persistent contact point, and a delay common to both triads. The rates have the time of the gyro's
/// readings: means over the sample's window.
class RateSmoother {
 public:
  using Params = RateSmootherParams;

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RateSmoother(const Params& params);

  /// Computes one RateState per sample, and the diagnostics of the run. On error nothing is written; the status
  /// contains field, value and bound: `empty`, `too_few` (less than two samples), `non_finite`, `time_order`, `gap`,
  /// `diverged`.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out, RateReport& report) const {
    return estimate(samples, {}, out, report);
  }
  /// Same with other IMUs on the body: one list per RateModelParams::auxiliary_imus, one reading per sample (see
  /// align()). Returns `too_few` if the sizes differ.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<RateState>& out, RateReport& report) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
  ClippingFinder rails_;
  RestDetector rests_;
};

}  // namespace tumble
