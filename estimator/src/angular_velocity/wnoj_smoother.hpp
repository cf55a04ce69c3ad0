// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Smooths angular velocity with a white-noise-on-jerk prior, exact and linear in the number of samples.
///
/// The state per knot is angle, rate and angular acceleration. The prior between knots is that of Tang, Yoon and
/// Barfoot (RA-L 2019), with transition matrix Phi and noise Q of order three and density `jerk_psd`. Each knot
/// measures the rate with a separate variance per axis. The angle is not measured, and its value at the first knot is
/// fixed. Eliminating the angle from the last knot backwards is therefore exact. The prior of (rate, acceleration)
/// remains, with Q = q [dt^3/3, dt^2/2; dt^2/2, dt]. Only rate and acceleration are computed. Orthogonal (square-root
/// information) elimination and back-substitution give mean and variance of the rate at every knot, also for variances
/// many orders of magnitude apart.
///
/// WnojSmoother does not model the coupling of the three axes. The commutators of SO(3) would add about dt^2 |w x
/// alpha| / 4. The published code feeds +gyro although its convention requires -gyro. The sign of the gyro only acts
/// through the commutators, since negating angle, rate and acceleration together does not change this linear problem.
/// The sign therefore has no parameter here.
class WnojSmoother {
 public:
  struct Params {
    double jerk_psd_rad2_s5 = 1e6;  ///< larger values follow the readings more closely

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
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

  /// Throws InvalidParams if the density is out of bounds.
  explicit WnojSmoother(const Params& params);

  /// Computes one result per measurement. On error `out` is unchanged: `empty`, `time_order` (time stamps must increase
  /// strictly), `non_finite`, `out_of_range` (variances must be in [1e-18, 1e18]). A single measurement is returned
  /// unchanged, with acceleration zero. O(N) in time and memory.
  Status smooth(std::span<const Measurement> measurements, std::vector<Smoothed>& out) const;

 private:
  Params params_;
};

}  // namespace tumble
