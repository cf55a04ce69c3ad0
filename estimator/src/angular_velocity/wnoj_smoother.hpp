// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// WnojSmoother smooths angular velocity with a white-noise-on-jerk prior. The solution is exact; the cost is linear in
/// the number of samples.
///
/// The state at each sample (knot) consists of angle, rate and angular acceleration. The motion prior between samples
/// is that of Tang, Yoon and Barfoot (RA-L 2019): white angular jerk of density `jerk_psd`. Each sample measures the
/// rate, with a separate variance per axis. No sample measures the angle, so the angle is eliminated exactly, from the
/// last sample backwards. The motion prior of (rate, acceleration) then has the process noise Q = q [dt^3/3, dt^2/2;
/// dt^2/2, dt]. Square-root information elimination and back-substitution give mean and variance of the rate at every
/// sample. The square-root form stays accurate even if the variances of the samples differ by many orders of magnitude.
///
/// WnojSmoother smooths the three axes independently. The neglected commutators of SO(3) would change the angular
/// acceleration by about dt^2 |w x alpha| / 4. The published code uses the gyro's rates with the wrong sign for its
/// convention, which matters only in the neglected commutators.
class WnojSmoother {
 public:
  struct Params {
    double jerk_psd_rad2_s5 = 1e6;  ///< larger values: the rate follows the readings more closely

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.jerk_psd_rad2_s5,
            {"jerk_psd_rad2_s5", "rad^2/s^5", 1e-12, 1e12, "; a larger value follows the readings more closely"});
    }
  };
  struct Measurement {
    TimeNs time_ns;
    Eigen::Vector3d rate_rad_s;
    Eigen::Vector3d variance_rad2_s2;  ///< variance of each axis, > 0
  };
  struct Smoothed {
    Eigen::Vector3d rate_rad_s;
    Eigen::Vector3d acceleration_rad_s2;
    Eigen::Vector3d variance_rad2_s2;  ///< posterior variance of the rate, per axis
  };

  /// Throws InvalidParams if the jerk density is out of bounds.
  explicit WnojSmoother(const Params& params);

  /// Computes one smoothed rate and acceleration per measurement. Cost: O(N) in time and memory. Returns `empty`,
  /// `time_order` (time stamps must increase strictly), `non_finite`, or `out_of_range` (variances must be in [1e-18,
  /// 1e18]). On error, `out` is unchanged. A single measurement is returned unchanged, with zero angular acceleration.
  Status smooth(std::span<const Measurement> measurements, std::vector<Smoothed>& out) const;

 private:
  Params params_;
};

}  // namespace tumble
