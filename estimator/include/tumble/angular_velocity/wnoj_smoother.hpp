// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Smoother of angular velocity with a white-noise-on-jerk prior, exact and linear in the number of samples.
///
/// Per knot the angle, the rate and the angular acceleration of the body; between knots the prior of Tang, Yoon and
/// Barfoot (RA-L 2019), Phi and Q of order three with density `jerk_psd`; per knot a measurement of the rate with its
/// own variance per axis. The angle is unmeasured and locked at the first knot. Three independent axes: what the
/// commutators of SO(3) would add is about dt^2 |w x alpha| / 4 and is left out.
/// Gives mean and covariance of the rate at every knot (block-tridiagonal elimination and back-substitution).
class WnojSmoother {
 public:
  struct Params {
    double jerk_psd_rad2_s5 = 1e6;  ///< bound (0, 1e12]; larger follows the readings more closely
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

  explicit WnojSmoother(const Params& params);
  /// Time stamps must rise strictly (`time_order`) and all values be finite (`non_finite`).
  Status smooth(std::span<const Measurement> measurements, std::vector<Smoothed>& out) const;

 private:
  Params params_;
};

}  // namespace tumble
