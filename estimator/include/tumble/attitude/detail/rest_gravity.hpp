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

/// Whether rates can be believed, by what gravity says wherever the body rests: its size must be g, and the rates
/// between one rest and the next must turn its direction there into that here, u_1 = R^T u_0, whatever happened in
/// between, flight, impacts and clipped axes. A gyro of another sense, scale or naming of the axes than it says misses
/// by any angle, after a tumble of several turns by less than `miss_least_rad` in one of fifty; an accelerometer of
/// another unit shows in the size. The rates are those of an estimate, whose covariance makes the bound wider.
///
/// Between two rests nothing is left of the velocity either: turned back by the rates, the forces of the span add to
/// gravity alone. Rates that miss the direction at its end by chance hardly do so all along.
///
/// The equations are imu_merge.md (I19), (I20), (I22), (I23). Not seen: a body that comes to rest as it lay (a
/// pendulum), turns about the vertical, an accelerometer with all three axes flipped, a run with less than two rests.
/// Mistaken for a force without gravity: a fall of a second without a turn, where no rest is. Mistaken for wrong rates:
/// one rest on the ground and the other in a vehicle that goes on for good.
class RestGravity {
 public:
  struct Params {
    double gravity_m_s2 = 9.80665;
    /// In whatever unit the force comes; a gyro's bias is no motion.
    RestDetector::Params rests = {.rate_max_rad_s = 0.15, .force_min_m_s2 = 0.3};
    double size_share_max = 0.15;     ///< by which a force at rest may differ from gravity: 80 mg of bias, 3 % of scale
    double miss_deviations = 5.0;     ///< allowed, of what the rates' covariance makes of the span; a chord, and
    double miss_least_rad = 0.3;      ///< at least so much: a bias, pushes at rest
    double miss_most_rad = 0.6;       ///< at most: rates that may be off by more tell nothing of the way
    double correlation_s = 0.1;       ///< for which errors of a rate last at least
    double rotation_least_rad = 1.0;  ///< of the span between two rests, to count
    double span_most_s = 60.0;        ///< likewise: in so long a good gyro's bias turns by a part of `miss_most_rad`
    double gap_max_s = 0.1;           ///< a longer gap parts the rests: an impact inside of it turns a rate by rad/s
    double accel_range_m_s2 = 0.0;    ///< as the device states it; 0: not stated

    /// Every number of it, stated once.
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
  struct State {
    RestDetector::State rest, weightless;
    Eigen::Vector3d from_m_s2 = Eigen::Vector3d::Zero();  ///< force at the last rest in the sensor's axes; 0: none
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();  ///< since then
    double span_angle_rad = 0.0, variance_rad2 = 0.0;            ///< likewise
    Eigen::Vector3d velocity_sum_m_s = Eigen::Vector3d::Zero();  ///< likewise, of force in the axes of that rest
    double span_s = 0.0, hidden_m_s = 0.0;                       ///< likewise, and what the accelerometer's rail hid
    double segment_s = 0.0, segment_rad2_s = 0.0;                ///< of samples in a row that the gyro did not measure
    double rest_s = 0.0, force_sum_m = 0.0;                      ///< of all rests, and of force by time
    double weightless_s = 0.0;                                   ///< of what would be rest but that no force holds it
    double miss_rad = 0.0, miss_sigma_rad = 0.0;                 ///< of the worst of the spans between two rests
    double velocity_share = 0.0, velocity_allowed_share = 0.0;   ///< likewise, over what gravity gives in its time
    std::size_t spans = 0;                                       ///< that were compared
    TimeNs last_time_ns = 0;
    bool started = false, rests = false;
  };

  /// Throws InvalidParams when a parameter is outside of its bound.
  explicit RestGravity(const Params& params);

  /// Takes a sample and the rate that an estimate gives for it; a sample that is not finite or out of order is passed
  /// over. O(1), no allocation.
  void step(const ImuSample& sample, const RateState& rate, State& state) const;

  /// Mean size of the force at rest as a share of gravity; 0 where all that rested for a second is without force, and 1
  /// where nothing rested.
  double size_share(const State& state) const;
  /// `out_of_range` where that is not 1.
  Status size_verdict(const State& state) const;
  /// The same, and where the rates of the worst span between two rests miss gravity, or leave a velocity, by more than
  /// they may.
  Status verdict(const State& state) const;

 private:
  void turn(const ImuSample& sample, const RateState& rate, double dt_s, State& state) const;
  void end_segment(State& state) const;
  void arrive(State& state) const;
  void close_velocity(const Eigen::Vector3d& here_m_s2, double sigma_rad, State& state) const;
  double allowed_rad(double sigma_rad) const;

  Params params_;
  RestDetector detector_, weightless_;
};

}  // namespace tumble
