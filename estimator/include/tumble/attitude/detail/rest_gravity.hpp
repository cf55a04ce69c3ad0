// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/angular_velocity/rest_detector.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Checks estimated rates and the accelerometer with the measured force at rests. The force at rest must have the
/// magnitude of gravity. Between two rests, the estimated rates rotate the sensor by R. The direction u_0 of the force
/// at the earlier rest and the direction u_1 at the later rest must satisfy u_1 = R^T u_0. The relation u_1 = R^T u_0
/// also holds if flight, impacts and clipping happen between the rests. A gyro with wrong sign, scale or axis labels
/// gives an arbitrary angle between u_1 and R^T u_0. After a tumble of several revolutions, an arbitrary angle is below
/// `angle_tolerance_min_rad` in one of fifty cases. A wrong magnitude of the force reveals an accelerometer with
/// another unit, for example g. The covariance of the rates increases the tolerance of the angle.
///
/// The velocity at a rest is zero. The forces between two rests, rotated back by the rates, therefore integrate to
/// gravity times the duration. Wrong rates that give the correct final direction by chance rarely give the correct
/// integral of the forces.
///
/// The equations of RestGravity are imu_merge.md (I23), (I24), (I25), (I26). RestGravity does not detect wrong rates if
/// the body returns to its initial attitude (a pendulum), rotates about the vertical, or rests less than twice.
/// RestGravity does not detect an accelerometer with all axes flipped. RestGravity mistakes a body that falls for a
/// second without rotation, and never rests, for a wrong accelerometer. If one rest is on the ground and another rest
/// is in a steadily moving vehicle, RestGravity mistakes correct rates for wrong rates.
class RestGravity {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;
    /// Parameters of the rest detector. The limits accept any unit of the force and any plausible gyro bias.
    RestDetector::Params rests = {.rate_max_rad_s = 0.15, .force_min_m_s2 = 0.3};
    double magnitude_error_max = 0.15;     ///< maximum relative difference from gravity: 80 mg of bias, 3 % of scale
    double angle_error_max_sigmas = 5.0;   ///< maximum angle error, in standard deviations of the rates
    double angle_tolerance_min_rad = 0.3;  ///< minimum tolerance of the angle error: covers bias, and pushes at rest
    double angle_tolerance_max_rad = 0.6;  ///< maximum tolerance of the angle error
    double correlation_s = 0.1;            ///< minimum correlation time of a rate's error
    double rotation_min_rad = 1.0;         ///< minimum rotation between two rests
    double rest_interval_max_s = 60.0;     ///< maximum time between two rests, limited by the bias drift of a gyro
    double gap_max_s = 0.1;                ///< a longer gap separates rests, because an impact may change the rate
    double accel_range_m_s2 = 0.0;         ///< range from the data sheet; 0: unknown

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
      visit.group("rests_", p.rests);
      visit(p.magnitude_error_max,
            {"magnitude_error_max", "1", 1e-3, 1.0,
             "maximum accepted difference between the force at rest and gravity, as a share of gravity"});
      visit(p.angle_error_max_sigmas, {"angle_error_max_sigmas", "1", 0.1, 1e6,
                                       "maximum accepted error of gravity's direction at the next rest, in standard "
                                       "deviations of the integrated rates"});
      visit(p.angle_tolerance_min_rad,
            {"angle_tolerance_min_rad", "rad", 1e-3, 2.0, "minimum of the accepted error of gravity's direction"});
      visit(p.angle_tolerance_max_rad,
            {"angle_tolerance_max_rad", "rad", 1e-3, 2.0, "maximum of the accepted error of gravity's direction"});
      visit(p.correlation_s, {"correlation_s", "s", 1e-4, 1e3, "correlation time of rate errors"});
      visit(p.rotation_min_rad, {"rotation_min_rad", "rad", 0.0, 1e3, "minimum rotation between two compared rests"});
      visit(p.rest_interval_max_s, {"rest_interval_max_s", "s", 0.1, 1e6, "maximum time between two compared rests"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0, "maximum time between two samples of one rest"});
      visit(p.accel_range_m_s2,
            {"accel_range_m_s2", "m/s^2", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
    }
  };
  /// MagnitudeState contains the sums for checking the magnitude of the force at rest.
  struct MagnitudeState {
    RestDetector::State rest, weightless, above_gravity;
    double rest_s = 0.0, force_sum_m = 0.0;  ///< total duration of rests, and integral of the force at rest
    double weightless_s = 0.0;               ///< duration of rests without force
    TimeNs last_time_ns = 0;
    bool started = false, rests = false;
    bool operator==(const MagnitudeState&) const = default;
  };
  struct State : MagnitudeState {
    Eigen::Vector3d last_rest_force_m_s2 =
        Eigen::Vector3d::Zero();  ///< force at the last rest in sensor axes; 0: no rest yet
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();  ///< rotation since the last rest
    double span_angle_rad = 0.0, variance_rad2 = 0.0;  ///< angle since the last rest, and variance of its error
    Eigen::Vector3d velocity_sum_m_s = Eigen::Vector3d::Zero();  ///< integrated force since the last rest
    double span_s = 0.0,
           saturation_deficit_m_s = 0.0;  ///< time since the last rest; integrated saturation deficit of the force
    double segment_s = 0.0, segment_rad2_s = 0.0;  ///< duration and variance of the current run of unmeasured samples
    double angle_error_rad = 0.0,
           angle_error_sigma_rad = 0.0;  ///< angle error of the worst pair of rests, with its standard deviation
    double velocity_error_ratio = 0.0, velocity_error_ratio_max = 0.0;  ///< velocity error of the worst pair, and limit
    std::size_t spans = 0;                                              ///< number of compared pairs of rests
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RestGravity(const Params& params);

  /// Processes an IMU sample and its estimated rate. Cost: O(1), no allocation. Samples that are not finite or out of
  /// order are ignored.
  void step(const ImuSample& sample, const RateState& rate, State& state) const;
  /// Processes a sample without a rate, for checking the magnitude of the force at rest only.
  void step(const ImuSample& sample, MagnitudeState& state) const { (void)follow(sample, state); }

  /// Limits the memory of the force at rest to a minute of rest, so that the finding ends after the fault ends.
  static void limit_memory(MagnitudeState& state);

  /// Returns the mean magnitude of the force at rest as a fraction of gravity. Returns 0 if every rest of a second was
  /// without force, and 1 if the body never rested.
  double magnitude_error_ratio(const MagnitudeState& state) const;
  /// Returns `out_of_range` if magnitude_error_ratio() differs from 1. If the magnitude is wrong by more than a factor
  /// of three, the message names the unit of the force as the probable error.
  Status magnitude_verdict(const MagnitudeState& state) const;
  /// Returns the error of magnitude_verdict(), if any, and otherwise checks the rates. Returns `out_of_range` if, for
  /// the worst pair of rests, gravity's direction or the final velocity is wrong by more than its limit.
  Status verdict(const State& state) const;

 private:
  enum class Continuity { unrelated, after_gap, directly };
  struct Step {
    Continuity follows = Continuity::unrelated;
    double dt_s = 0.0;
  };
  Step follow(const ImuSample& sample, MagnitudeState& state) const;
  void integrate_rotation(const ImuSample& sample, const RateState& rate, double dt_s, State& state) const;
  void end_segment(State& state) const;
  void finish_span(State& state) const;
  void check_velocity(const Eigen::Vector3d& current_force_m_s2, double sigma_rad, State& state) const;
  double allowed_rad(double sigma_rad) const;

  Params params_;
  RestDetector detector_, weightless_, above_gravity_;
};

}  // namespace tumble
