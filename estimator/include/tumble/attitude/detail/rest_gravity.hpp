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

/// Checks the plausibility of rates by gravity at rests. The force at rest must have the magnitude g. The rates between
/// two rests rotate the sensor by R. The direction u_0 of the force at the earlier rest must become that at the later
/// rest: u_1 = R^T u_0. The relation u_1 = R^T u_0 also holds through flight, impacts and clipping. A gyro with wrong
/// sign, scale or axis labels gives an arbitrary angle between u_1 and R^T u_0. After a tumble of several revolutions,
/// an arbitrary angle is below `miss_least_rad` in one of fifty cases. The magnitude of the force reveals an
/// accelerometer with another unit. The rates come from an estimate, whose covariance widens the tolerance.
///
/// In addition, the velocity at a rest is zero. The forces between two rests, rotated back by the rates, therefore
/// integrate to gravity alone. Wrong rates that give the correct final direction by chance rarely give this integral.
///
/// The equations are imu_merge.md (I23), (I24), (I25), (I26). RestGravity does not detect wrong rates if the body
/// returns to its initial attitude (a pendulum), rotates about the vertical, or rests less than twice. An accelerometer
/// with all axes flipped is not detected either. A fall of a second without rotation and without any rest is mistaken
/// for a force without gravity. A rest on the ground and another in a steadily moving vehicle are mistaken for wrong
/// rates.
class RestGravity {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;
    /// Parameters of rest detection. The limits hold for any unit of the force, and a gyro's bias does not count as
    /// motion.
    RestDetector::Params rests = {.rate_max_rad_s = 0.15, .force_min_m_s2 = 0.3};
    double size_share_max = 0.15;     ///< maximum relative difference from gravity at rest: 80 mg of bias, 3 % of scale
    double miss_deviations = 5.0;     ///< maximum angle, as a chord, in standard deviations of the rates
    double miss_least_rad = 0.3;      ///< minimum tolerance of the angle: covers a bias, and pushes at rest
    double miss_most_rad = 0.6;       ///< maximum tolerance of the angle: less certain rates do not determine the
                                      ///< displacement
    double correlation_s = 0.1;       ///< minimum correlation time of a rate's error
    double rotation_least_rad = 1.0;  ///< minimum rotation between two rests
    double span_most_s = 60.0;        ///< maximum duration of a span, limited by the drift of a good gyro's bias
    double gap_max_s = 0.1;           ///< longer gaps separate rests: an impact may change the rate by several rad/s
    double accel_range_m_s2 = 0.0;    ///< stated by the device; 0: not stated

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 1e-12, 100.0, "strength of gravity"});
      visit.group("rests_", p.rests);
      visit(p.size_share_max, {"size_share_max", "1", 1e-3, 1.0,
                               "largest accepted difference between force at rest and gravity, as a share"});
      visit(p.miss_deviations, {"miss_deviations", "1", 0.1, 1e6,
                                "largest accepted error of gravity's direction at the next rest, in standard "
                                "deviations of the integrated rates"});
      visit(p.miss_least_rad, {"miss_least_rad", "rad", 1e-3, 2.0, "lower limit of this accepted error"});
      visit(p.miss_most_rad, {"miss_most_rad", "rad", 1e-3, 2.0, "upper limit of this accepted error"});
      visit(p.correlation_s, {"correlation_s", "s", 1e-4, 1e3, "correlation time of rate errors"});
      visit(p.rotation_least_rad,
            {"rotation_least_rad", "rad", 0.0, 1e3, "least rotation between two rests for a comparison"});
      visit(p.span_most_s, {"span_most_s", "s", 0.1, 1e6, "longest time between two rests for a comparison"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0, "a longer time between two samples separates the rests"});
      visit(p.accel_range_m_s2,
            {"accel_range_m_s2", "m/s^2", 0.0, kUnbounded, "range stated by the device; 0: not stated"});
    }
  };
  /// State for the magnitude of the force at rest.
  struct Size {
    RestDetector::State rest, weightless, heavy;
    double rest_s = 0.0, force_sum_m = 0.0;  ///< duration of all rests, and integral of the force at rest
    double weightless_s = 0.0;               ///< duration of rests without force
    TimeNs last_time_ns = 0;
    bool started = false, rests = false;
    bool operator==(const Size&) const = default;
  };
  struct State : Size {
    Eigen::Vector3d from_m_s2 = Eigen::Vector3d::Zero();  ///< force at the last rest in the sensor's axes; 0: none
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< rotation since then
    double span_angle_rad = 0.0, variance_rad2 = 0.0;            ///< since then
    Eigen::Vector3d velocity_sum_m_s = Eigen::Vector3d::Zero();  ///< since then, of the force in the axes of that rest
    double span_s = 0.0, hidden_m_s = 0.0;                       ///< since then; deficit of the accelerometer
    double segment_s = 0.0, segment_rad2_s = 0.0;                ///< duration and variance of consecutive unmeasured
                                                                 ///< samples
    double miss_rad = 0.0, miss_sigma_rad = 0.0;                 ///< angle error of the worst span between two rests,
                                                                 ///< and its standard deviation
    double velocity_share = 0.0, velocity_allowed_share = 0.0;   ///< velocity of the worst span, and its limit, over
                                                                 ///< gravity times duration
    std::size_t spans = 0;                                       ///< number of compared spans
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RestGravity(const Params& params);

  /// Processes a sample and its estimated rate. Ignores samples that are not finite or out of order. O(1), no
  /// allocation.
  void step(const ImuSample& sample, const RateState& rate, State& state) const;
  /// Processes a sample without rates, for the magnitude of the force at rest alone.
  void step(const ImuSample& sample, Size& state) const { (void)follow(sample, state); }

  /// Limits the memory of the force at rest to a minute of rest, so that a finding ends.
  static void limit_memory(Size& state);

  /// Returns the mean magnitude of the force at rest as a fraction of gravity. Returns 0 if every rest of a second was
  /// without force, and 1 without any rest.
  double size_share(const Size& state) const;
  /// Returns `out_of_range` if size_share() differs from 1. Beyond a factor of three, the message reports the unit of
  /// the force as suspect.
  Status size_verdict(const Size& state) const;
  /// Returns the error of size_verdict(). Also returns `out_of_range` if the rates of the worst span between two rests
  /// miss gravity or leave a velocity beyond the limits.
  Status verdict(const State& state) const;

 private:
  enum class Follows { not_at_all, after_gap, directly };
  struct Step {
    Follows follows = Follows::not_at_all;
    double dt_s = 0.0;
  };
  Step follow(const ImuSample& sample, Size& state) const;
  void turn(const ImuSample& sample, const RateState& rate, double dt_s, State& state) const;
  void end_segment(State& state) const;
  void arrive(State& state) const;
  void close_velocity(const Eigen::Vector3d& here_m_s2, double sigma_rad, State& state) const;
  double allowed_rad(double sigma_rad) const;

  Params params_;
  RestDetector detector_, weightless_, heavy_;
};

}  // namespace tumble
