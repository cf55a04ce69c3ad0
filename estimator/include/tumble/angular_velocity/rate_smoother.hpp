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

/// Of RateSmoother.
struct RateSmootherParams {
  RateModelParams model = {};
  RailDetector::Params rails = {};
  double recovered_sigma_rad_s = 0.5;  ///< a clipped axis known better than this is recovered, not only bounded
  /// A run whose constants move further than this (RateReport::calibration_mahalanobis) is estimated again with the
  /// constants held to what was known.
  double calibration_mahalanobis_max = 1.5;
  /// What an earlier run has told of the device's errors (RateReport::sensor_errors); of use where they are
  /// estimated.
  std::optional<KnownSensorErrors> learnt_errors = std::nullopt;
  double gap_max_s = 1.0;  ///< longest time between samples before the run is refused

  using Expert = RateSmootherExpertParams;
  Expert expert = {};  ///< what few need

  /// Every number of it, stated once.
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

/// What a run tells about its own health.
struct RateReport {
  int iterations = 0;
  bool converged = false;
  int restarts = 0;              ///< descents from another start, where the first found hardly any flight
  double last_step_rad_s = 0.0;  ///< largest change of a rate in the last iteration
  RigCalibration calibration;    ///< what the run has learnt of the rig: can be given to the next
  /// How far the constants moved from what was known beforehand (RateModel::calibration_mahalanobis). Far beyond 1 the
  /// prior is wrong, or a run without flight was taken for one with flight.
  double calibration_mahalanobis = 0.0;
  bool calibration_at_prior = false;  ///< that was too large: nothing was learnt, the constants stayed at their prior
  std::array<std::optional<double>, 6> rail;  ///< in use: gyro [rad/s], accelerometer [m/s^2]; none: not seen
  std::array<bool, 6> rail_seen{};            ///< on that axis itself, not on another one or in a sheet
  RailPlanes planes;                          ///< of the gyro's elements, where they were seen
  RailPlanes accel_planes;                    ///< of the accelerometer's, m/s^2
  /// What the device makes of the motion, as far as the run tells.
  KnownSensorErrors sensor_errors;
  double calibrated = 1.0, together = 1.0;  ///< see SensorErrorFit
  /// A delay that both triads may share, counted in the covariance: of a device that is not what its sheet says.
  double shared_delay_sigma_s = 0.0;
  double gyro_update_s = 0.0, accel_update_s = 0.0;  ///< of readings that repeat (find_held); 0: none does
  int error_rounds = 0;                              ///< descents with corrected readings
  bool rails_upright = false;                        ///< the device clips what it delivers, nothing else is off
  std::array<bool, 6> rail_disagrees{};              ///< a stated range contradicted by the readings
  bool rate_unit_suspect = false;   ///< a reading beyond RateModelParams::rate_max_rad_s: perhaps degrees
  bool force_unit_suspect = false;  ///< the median specific force is near 1: perhaps given in g
  std::size_t samples = 0, clipped = 0, recovered_flight = 0, recovered_contact = 0, bounded_only = 0;
  std::size_t missing_readings = 0;  ///< samples with an overflow (sign flipped at the rail)
  double flight_share = 0.0;         ///< share of the samples that count as free flight
  /// Bit j, one per sample: the reading of axis j may stand at a rail that was not seen, though nothing says that it is
  /// clipped.
  std::vector<std::uint8_t> doubted_axes;
};

/// Angular velocity of a tumbling body through saturation of its gyro: a tightly coupled smoother over a recording.
///
/// Unknown per sample: rate and angular acceleration, and for the run the RigConstants. Gauss-Newton on: the gyro where
/// it is not clipped; the bound that a clipped reading is, for any number of axes; in flight the whole rigid-body
/// form of the specific force at the lever arm and Euler's equation without torque, both weighed down together where
/// they do not hold (contact); between samples white noise on jerk, of a density that grows with the force of contact
/// so that an impact breaks the chain; at standstill (RestDetector) the rate is zero, which tells the gyro's bias. The
/// normal equations are an arrow matrix: O(N) per iteration, covariance included. Starts from the published method
/// (Saave), extended to bounds.
///
/// Contact: the force at the centre of mass is what flight leaves of the reading, and a force through a point of the
/// cage has no torque about its own direction: that row of Euler's equation stays in force, the two across it are as
/// wide as the cage makes them (RateContactParams::lever_rad_m). More is not to be had from a contact point:
/// of clipped samples in contact (tests/bench/rate_contact; docs/maths/rate_smoother.md) along the force lie 1.4 % of
/// the torque (median), but the point that the sample before gives leaves 66 % of it, the best single point of a whole
/// impact 48 %, and all of it in one sample of ten: a cage strikes with several bars, and within 10 ms it rolls on.
/// Rest is zero rate (RestDetector).
///
/// What the device makes of the motion (SensorErrors: scale, misalignment, g-sensitivity, delay and window of the
/// accelerometer against the gyro) looks in part like other constants of the rig. It is estimated as far as the run
/// tells, at the size that the readings show (fit_sensor_errors), by a descent with corrected readings; what remains
/// open is in both covariances (as of parameters considered, S. F. Schmidt, 1966), else the fit takes it for noise and
/// averages it away: the test ScaleAndMisalignmentAreInTheCovariance. A first guess of the delay comes before
/// (guess_triad_delay). Of two triads that are apart the later one is taken to be late and the other in time.
///
/// A gyro's elements clip along their own, not quite orthogonal axes; the device's compensation then mixes what is left
/// (RailPlaneFinder). While one clips the gyro is read element by element (element_factor): free elements measure,
/// clipped ones bound, and the axes beside are corrected for what is hidden. The rows are constants of the run, told by
/// the planes of the rails and by flight; where the rails are found to be upright nothing of this applies.
///
/// What it does not model: a contact point that persists, a delay that both triads share. The rates are those at
/// which the gyro's readings stand: means over the window of the sample.
class RateSmoother {
 public:
  using Params = RateSmootherParams;

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RateSmoother(const Params& params);

  /// One RateState per sample, and what the run tells of itself. On trouble (`empty`, `too_few`: less than two samples,
  /// `non_finite`, `time_order`, `gap`, `diverged`) nothing is written and the status names field, value and bound.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out, RateReport& report) const {
    return estimate(samples, {}, out, report);
  }
  /// The same with other IMUs on the body: `auxiliary_imus` holds one list per RateModelParams::auxiliary_imus, one
  /// reading per sample each (see align()); `too_few` when the numbers differ.
  Status estimate(std::span<const ImuSample> samples, std::span<const std::vector<AuxiliaryReading>> auxiliary_imus,
                  std::vector<RateState>& out, RateReport& report) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
  ClippingFinder rails_;
  RestDetector rests_;
};

}  // namespace tumble
