// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "tumble/angular_velocity/types.hpp"
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

/// Estimates the angular velocity of a tumbling body from the centripetal force while the gyro is clipped.
/// SaturationAwareRateEstimator implements a published method (Deschenes et al., "Saturation-Aware Angular Velocity
/// Estimation", ICRA 2024, eqs 5-7).
///
/// The recursive stage recovers at most one clipped axis per sample, the first in the order x, y, z. Other clipped axes
/// of the sample get the variance of an unclipped reading. The smoothing stage smooths the rates of all samples with a
/// white-noise-on-jerk prior.
///
/// SaturationAwareRateEstimator assumes free flight, an unclipped accelerometer, no bias, and no angular acceleration
/// across the rotation axis. If the IMU is close to the rotation axis, the estimate has a large error that
/// SaturationAwareRateEstimator does not detect. The smoothed rates of clipped axes may be below the saturation limit.
class SaturationAwareRateEstimator {
 public:
  struct Params {
    /// Lever arm from the centre of mass to the IMU in IMU axes [m]. The lever arm has no default and must be accurate
    /// to about a millimetre.
    Eigen::Vector3d lever_arm_m = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
    /// Readings above this rate count as clipped. Required; choose a value slightly below the largest reading of the
    /// gyro.
    double saturation_point_rad_s = 0.0;
    /// variance of an unclipped reading [(rad/s)^2]; default: (0.03 deg/s/sqrt(Hz) * sqrt(100 Hz))^2
    static constexpr double kVarianceMeasured_rad2_s2 = 2.741e-5;
    /// variance of a recovered rate [(rad/s)^2]: 0.2741 in the code of the ICRA 2024 paper, 3.648 in the paper
    static constexpr double kVarianceEstimated_rad2_s2 = 0.2741;
    /// variance of a clipped axis whose rate SaturationAwareRateEstimator cannot recover [(rad/s)^2]
    static constexpr double kVarianceRejected_rad2_s2 = 1e6;
    /// power spectral density of the white angular jerk [rad^2/s^5]
    double jerk_psd_rad2_s5 = 1e6;
    static constexpr double kGapMax_s = 1.0;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.lever_arm_m, {"lever_arm_m", "m", -10.0, 10.0,
                            "lever arm from the centre of mass to the IMU, IMU axes; needs an accuracy of about 1 mm"});
      visit(p.saturation_point_rad_s,
            {"saturation_point_rad_s", "rad/s", 0.01, 1000.0,
             "readings beyond this value count as clipped; choose a value slightly below the gyro's saturation limit",
             ParameterAudience::common_use});
      visit(p.jerk_psd_rad2_s5,
            {"jerk_psd_rad2_s5", "rad^2/s^5", 1e-12, 1e12,
             "power spectral density of the smoother's white angular jerk (ICRA 2024 paper, sec. IV)",
             ParameterAudience::common_use});
    }
  };

  struct State {
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
    TimeNs last_time_ns = 0;
    bool started = false;
    bool operator==(const State&) const = default;
  };

  struct RecoveredRate {
    Eigen::Vector3d rate_rad_s;
    Eigen::Vector3d variance_rad2_s2;
    std::uint8_t clipped_axes = 0;  ///< bit j: the reading of gyro axis j exceeds the saturation point
    bool accepted = true;           ///< false: the rate about the clipped axis could not be recovered
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit SaturationAwareRateEstimator(const Params& params);

  /// Processes one sample in the recursive stage. On error (`non_finite`, `time_order`, `gap`), `state` and `out` are
  /// unchanged. Cost: O(1), no allocation.
  Status step(const ImuSample& sample, State& state, RecoveredRate& out) const;

  /// Returns `ok`, `empty`, `non_finite`, `time_order` or `gap`. On error, `out` is unchanged, and the status contains
  /// the field and value of the first invalid sample. Cost: O(N).
  Status estimate(std::span<const ImuSample> samples, std::vector<AngularRateState>& out) const;

  const Params& params() const { return params_; }

 private:
  Params params_;
};

}  // namespace tumble
