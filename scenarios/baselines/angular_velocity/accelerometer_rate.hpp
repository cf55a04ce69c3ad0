// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/auxiliary_imu.hpp"
#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// Rates from several accelerometers at known positions: the gyro-free inertial system, as an extended Kalman filter.
///
/// State: rate and angular acceleration, driven by white jerk. Measured: the difference of the specific force at each
/// auxiliary IMU and at the primary, alpha x p + w x (w x p), which holds in flight, in contact and at rest alike; and
/// the gyro's axes that are not clipped (`use_gyro`), the strongest form of the family: the accelerometers then carry
/// only what the rail hides. Made for long rotation at high rates with a wide spread of accelerometers (projectiles,
/// vehicles): centripetal force grows with the square of the rate, so that slow motion drowns in noise and
/// misalignment.
///
/// With one auxiliary IMU the rate about the line between the two shows only through its products with the others;
/// without any the filter bridges clipped readings by smoothness alone. What it does not model: free flight, bias and
/// misalignment of the accelerometers, correlation between the auxiliary IMUs' differences.
class AccelerometerRate {
 public:
  struct Params {
    RailDetector::Params rails = {};
    bool tilted_rails = false;  ///< judge by tilted planes too (ClippingFinder); published by axis alone
    bool use_gyro = true;
    double gyro_noise_density = 5.236e-4;  ///< [rad/s/sqrt(Hz)]
    double accel_noise_density = 1.5e-3;   ///< the worst of the accelerometers [m/s^2/sqrt(Hz)]
    double accel_floor_m_s2 = 0.05;        ///< bias of a difference, one standard deviation
    double accel_scale_error = 2e-3;       ///< scale and misalignment, as a share of the force
    double jerk_psd = 1e7;                 ///< density of the white angular jerk [rad^2/s^5]
    double rate_max_rad_s = 50.0;          ///< no answer lies beyond
    double gap_max_s = 1.0;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.rails);
      visit(p.tilted_rails,
            on_off("tilted_rails", "1: search tilted rails too; 0: treat each axis separately, as published",
                   Rank::first));
      visit(p.use_gyro,
            on_off("use_gyro", "1: also use the axes of the primary gyro that are not clipped; 0: do not use the gyro",
                   Rank::first));
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro"});
      visit(p.accel_noise_density,
            {"accel_noise_density", "m/s^2/sqrt(Hz)", 1e-9, 10.0, "noise density of the accelerometer"});
      visit(p.accel_floor_m_s2, {"accel_floor_m_s2", "m/s^2", 0.0, 100.0,
                                 "standard deviation of the bias of a difference between two accelerometers"});
      visit(p.accel_scale_error, {"accel_scale_error", "1", 0.0, 1.0,
                                  "scale and misalignment error of the accelerometers, as a share of the force"});
      visit(p.jerk_psd, {"jerk_psd_rad2_s5", "rad^2/s^5", 1.0, 1e12, "power spectral density of the white angular jerk",
                         Rank::first});
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "largest estimated rate"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                          "longest allowed time between two samples; a longer gap ends the run with an error"});
    }
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit AccelerometerRate(const Params& params);

  /// One RateState per sample. On trouble (`empty`, `too_few`: less than two samples, or an auxiliary IMU with another
  /// number of samples, `non_finite`, `time_order`, `gap`) nothing is written. O(N times auxiliary IMUs).
  Status estimate(std::span<const ImuSample> samples, std::span<const AuxiliaryAccelerometer> auxiliary_imus,
                  std::vector<RateState>& out) const;

 private:
  Params params_;
  ClippingFinder rails_;
};

}  // namespace tumble::baselines
