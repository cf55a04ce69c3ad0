// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Smoother of angular velocity with a white-noise-on-jerk prior, exact and linear in the number of samples.
///
/// Per knot the angle, the rate and the angular acceleration of the body; between knots the prior of Tang, Yoon and
/// Barfoot (RA-L 2019), Phi and Q of order three with density `jerk_psd`; per knot a measurement of the rate with its
/// own variance per axis. The angle is unmeasured and locked at the first knot, so eliminating it from the last knot
/// backwards is exact and leaves the prior of the pair (rate, acceleration) with Q = q [dt^3/3, dt^2/2; dt^2/2, dt]:
/// only that pair is computed. Gives mean and variance of the rate at every knot by orthogonal (square-root
/// information) elimination and back-substitution; readings with variances many orders of magnitude apart do no harm.
///
/// What it does not model: three independent axes; what the commutators of SO(3) would add is about
/// dt^2 |w x alpha| / 4 and is left out. The sign in which the rate enters the prior (the published code feeds +gyro
/// where its own convention is -gyro) acts through those commutators alone: negating angle, rate and acceleration
/// together leaves this linear problem as it is. It therefore has no switch here.
class WnojSmoother {
 public:
  struct Params {
    double jerk_psd_rad2_s5 = 1e6;  ///< larger follows the readings more closely

    /// Visits every parameter: its value, name, unit, bounds and meaning (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.jerk_psd_rad2_s5,
            {"jerk_psd_rad2_s5", "rad^2/s^5", 1e-12, 1e12, "; larger follows the readings more closely"});
    }
  };
  struct Measurement {
    TimeNs time_ns;
    Eigen::Vector3d rate_rad_s;
    Eigen::Vector3d variance_rad2_s2;  ///< per axis, > 0
  };
  struct Smoothed {
    Eigen::Vector3d rate_rad_s;
    Eigen::Vector3d acceleration_rad_s2;
    Eigen::Vector3d variance_rad2_s2;  ///< posterior variance of the rate, per axis
  };

  /// Throws InvalidParams when the density is outside of its bound.
  explicit WnojSmoother(const Params& params);

  /// One result per measurement. No measurement: `empty`; time stamps must rise strictly (`time_order`), values be
  /// finite (`non_finite`), variances lie in [1e-18, 1e18] (`out_of_range`); on trouble `out` is left as it was. A
  /// single measurement is returned unchanged, with acceleration zero. O(N) in time and memory.
  Status smooth(std::span<const Measurement> measurements, std::vector<Smoothed>& out) const;

 private:
  Params params_;
};

}  // namespace tumble
