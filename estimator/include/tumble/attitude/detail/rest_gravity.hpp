// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Checks accelerometer and estimated rates with the body at rest. The specific force at rest must have the magnitude
/// of gravity; a wrong magnitude reveals a wrong unit, for example g. Between two rests, the integrated velocity change
/// must be zero: imu_merge.md (I23), (I24), (I25), (I26). The integral uses the specific force, rotated by the
/// estimated rates.
///
/// RestGravity does not detect wrong rates if the body returns to its initial attitude, rotates about the vertical, or
/// rests less than twice. An accelerometer with all axes flipped is not detected. False alarms occur if a body that
/// never rests falls for a second without rotation. They also occur if only one of two rests is in a moving vehicle.
class RestGravity {
 public:
  struct Setup {
    double gravity_m_s2 = 9.80665;
    double accel_range_m_s2 = 0.0;  ///< range from the data sheet; 0: unknown
  };
  struct GravityMagnitudeState {
    RestDetector::State stationary_state, stationary_weightless, stationary_above_gravity;
    double rest_s = 0.0, stationary_force_integral_m_s =
                             0.0;  ///< total duration of rests, and integral of the force magnitude over these rests
    double weightless_s = 0.0;     ///< duration of rests with a specific force close to zero
    TimeNs last_time_ns = 0;
    bool started = false, is_stationary = false;
    bool operator==(const GravityMagnitudeState&) const = default;
  };
  struct State : GravityMagnitudeState {
    Eigen::Vector3d last_rest_force_m_s2 =
        Eigen::Vector3d::Zero();  ///< specific force at the last rest, in sensor axes; 0: no rest yet
    Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
    double angle_since_last_rest_rad = 0.0,
           angle_variance_rad2 = 0.0;  ///< rotation angle since the last rest, and variance of the angle's error
    Eigen::Vector3d integrated_force_m_s = Eigen::Vector3d::Zero();
    double span_s = 0.0,
           integrated_saturation_deficit_m_s =
               0.0;  ///< time since the last rest; integrated saturation deficit of the accelerometer
    double unmeasured_duration_s = 0.0,
           unmeasured_rotation_variance =
               0.0;  ///< duration and angle variance of the current run of samples without measured rate
    double worst_velocity_error_ratio = 0.0,
           worst_pair_error_limit =
               0.0;  ///< velocity error between two rests for the worst pair of rests, and its limit
    std::size_t compared_rest_pairs = 0;
  };

  /// Throws InvalidParams if gravity is beyond [1e-12, 100] m/s^2, or if the range is negative or not finite.
  explicit RestGravity(const Setup& setup);

  /// Processes one sample with its estimated rate. Samples that are not finite or out of order are ignored. Cost: O(1),
  /// no allocation.
  void step(const ImuSample& sample, const AngularRateState& rate, State& state) const;
  /// Processes one sample for the check of the magnitude only.
  void step(const ImuSample& sample, GravityMagnitudeState& state) const {
    (void)detect_stationary_periods(sample, state);
  }

  /// Reduces the weight of rests older than about a minute, so that a finding ends after its cause.
  static void limit_memory(GravityMagnitudeState& state);

  /// Returns `out_of_range` if the mean magnitude of the specific force at rest differs from gravity by more than 15 %.
  Status gravity_magnitude_verdict(const GravityMagnitudeState& state) const;
  /// Returns the error of gravity_magnitude_verdict(), if any. Otherwise returns `out_of_range` if the integrated
  /// velocity change between two rests is not zero.
  Status verdict(const State& state) const;

 private:
  enum class SampleContinuity { not_comparable, after_gap, consecutive };
  struct Step {
    SampleContinuity continuity = SampleContinuity::not_comparable;
    double dt_s = 0.0;
  };
  Step detect_stationary_periods(const ImuSample& sample, GravityMagnitudeState& state) const;
  void integrate_rotation(const ImuSample& sample, const AngularRateState& rate, double dt_s, State& state) const;
  void end_segment(State& state) const;
  void finish_rest_pair(State& state) const;

  Setup setup_;
  RestDetector detector_, weightless_, above_gravity_;
};

}  // namespace tumble
