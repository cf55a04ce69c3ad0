// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// WnojSmoother smooths the rate of each axis with a white-noise-on-jerk prior (Tang, Yoon and Barfoot, RA-L 2019).
///
/// The state does not contain the angle, because no sample measures the angle. The motion prior of (rate, acceleration)
/// has the process noise Q = q [dt^3/3, dt^2/2; dt^2/2, dt]. The square-root information form stays accurate even if
/// variances differ by many orders of magnitude.
///
/// WnojSmoother smooths each axis separately, and therefore neglects that rotations about different axes do not
/// commute. For the rate w, angular acceleration alpha and sample period dt, the rate error is about dt^2 |w x alpha| /
/// 4 per sample.
class WnojSmoother {
 public:
  struct Params {
    double jerk_psd_rad2_s5 = 1e6;  ///< larger values: the rate follows the readings more closely

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
    Eigen::Vector3d variance_rad2_s2;
  };

  /// Throws InvalidParams if the jerk density is out of bounds.
  explicit WnojSmoother(const Params& params);

  /// Cost: O(N) in time and memory. Returns `empty`, `time_order` (time stamps must increase strictly), `non_finite`,
  /// or `out_of_range` (variances must be in [1e-18, 1e18]). On error, `out` is unchanged. A single measurement is
  /// returned unchanged, with zero angular acceleration.
  Status smooth(std::span<const Measurement> measurements, std::vector<Smoothed>& out) const;

 private:
  Params params_;
};

}  // namespace tumble
