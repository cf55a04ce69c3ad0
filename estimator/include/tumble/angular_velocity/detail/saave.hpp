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
