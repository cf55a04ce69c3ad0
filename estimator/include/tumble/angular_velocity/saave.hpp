// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble {

/// Angular velocity of a tumbling body whose gyro clips, from the centripetal part of the specific force.
///
/// The published method (Deschenes et al., "Saturation-Aware Angular Velocity Estimation", ICRA 2024, eqs 5-7) in two
/// stages. Recursion, per sample: the rotation axis e of the last accepted sample and the lever arm t give the vector
/// from the IMU to the axis, l = (t.e)e - t; the component of the specific force along l is |l| |w|^2 in free flight,
/// so the one clipped axis follows from the two others. Then all samples are smoothed by WnojSmoother.
///
/// What it does not model: a second clipped axis (the first in x, y, z order is treated, the others are believed with
/// the variance of an unclipped reading), angular acceleration across the axis, contact, clipped accelerometers, bias.
/// Near r = |l| = 0 the estimate is unguarded (r = 0 exactly rejects). The variance of an estimate depends on nothing.
/// Smoothed rates are not held to the rail again: they may fall below it. As published, all of it.
class Saave {
 public:
  struct Params {
    /// t: from the centre of mass to the IMU, IMU axes [m]; bound |t_j| <= 10. Needed to about a millimetre; has no
    /// default.
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    /// A reading strictly beyond this counts as clipped [rad/s]. Known error, kept as published: a device
    /// whose plateau is exactly this value never exceeds it and nothing is recovered; pass a value slightly below. Has
    /// no default.
    double saturation_point_rad_s = 0.0;
    /// Variance of an unclipped reading [(rad/s)^2]; (0.03 deg/s/sqrt(Hz) * sqrt(100 Hz))^2.
    double variance_measured_rad2_s2 = 2.741e-5;
    /// Variance of an accepted estimate [(rad/s)^2]: 0.2741 as in the authors' code, 3.648 as printed in the paper.
    double variance_estimated_rad2_s2 = 0.2741;
    /// Variance of the clipped axis when no estimate is possible [(rad/s)^2].
    double variance_rejected_rad2_s2 = 1e6;
    /// Power spectral density of the white angular jerk [rad^2/s^5].
    double jerk_psd_rad2_s5 = 1e6;
    /// Longest time between two samples before the run is refused [s].
    double gap_max_s = 1.0;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0,
                            "lever arm from the centre of mass to the IMU, IMU axes; needs an accuracy of about 1 mm"});
      visit(p.saturation_point_rad_s,
            {"saturation_point_rad_s", "rad/s", 0.01, 1000.0,
             "readings beyond this count as clipped; choose it slightly below the gyro's plateau", Rank::first});
      visit(p.variance_measured_rad2_s2,
            {"variance_measured_rad2_s2", "rad^2/s^2", 1e-12, 1e12, "variance of an unclipped reading"});
      visit(
          p.variance_estimated_rad2_s2,
          {"variance_estimated_rad2_s2", "rad^2/s^2", 1e-12, 1e12,
           "variance of a recovered axis: 0.2741 as in the authors' code, 3.648 as printed in the paper", Rank::first});
      visit(p.variance_rejected_rad2_s2,
            {"variance_rejected_rad2_s2", "rad^2/s^2", 1e-12, 1e12, "variance of a clipped axis without an estimate"});
      visit(p.jerk_psd_rad2_s5,
            {"jerk_psd_rad2_s5", "rad^2/s^5", 1e-12, 1e12,
             "power spectral density of the smoother's white angular jerk (paper, sec. IV)", Rank::first});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                          "longest allowed time between two samples; a longer gap ends the run with an error"});
    }
  };

  /// All that the recursion carries from sample to sample.
  struct State {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< direction of the last accepted rate
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  /// A sample after the recursion, before smoothing.
  struct Recovered {
    Eigen::Vector3d rate_rad_s;
    Eigen::Vector3d variance_rad2_s2;  ///< per axis
    std::uint8_t clipped_axes = 0;     ///< bits of the axes beyond the saturation point
    bool accepted = true;              ///< false: the clipped axis could not be recovered
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit Saave(const Params& params);

  /// One step of the recursion. On trouble (`non_finite`, `time_order`, `gap`) neither state nor out is touched.
  /// O(1), no allocation.
  Status step(const ImuSample& sample, State& state, Recovered& out) const;

  /// Both stages over a whole recording; one RateState per sample. O(N). No sample: `empty`.
  /// On trouble nothing is written to `out` and the status names the first offending sample's field and value.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
};

}  // namespace tumble
