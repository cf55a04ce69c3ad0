// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <vector>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// StandstillSmoother estimates angular rates between standstills with an inertial navigation filter and a backward
/// smoothing pass. At rest the filter applies zero-velocity and zero-rate updates. The smoother distributes the
/// rotation lost to saturation over the clipped samples between two standstills.
///
/// The error state has 12 elements: attitude, velocity, rate and angular acceleration. The filter integrates the
/// specific force and models the rate as a Matern 3/2 process: white angular jerk over short times, bounded rate over
/// long times. Unclipped gyro axes are measurements, and clipped gyro axes are limits of the rate. At standstill, the
/// filter also measures zero velocity, zero rate and the direction of gravity. A backward Rauch-Tung-Striebel pass
/// follows the forward extended Kalman filter.
///
/// The method follows zero-velocity smoothers for foot-mounted and hand-moved sensors (Dang and Suh). The smoother is
/// designed for motions of one or two seconds between standstills, with few clipped samples. If the tilt or velocity
/// error at the next standstill is too large for a linear filter, the filter resets attitude and velocity. A tumble of
/// several turns causes such a reset. Only the clipping limits and the smoothness then determine the rates before the
/// reset. StandstillSmoother neglects clipped specific force, lever arms and sensor bias.
class StandstillSmoother {
 public:
  struct Params {
    RailDetector::Params rails = {};
    bool tilted_rails = false;  ///< also detects tilted rails (ClippingFinder), unlike the published method
    double gravity_m_s2 = 9.80665;
    double gyro_noise_density = 5.236e-4;   ///< [rad/s/sqrt(Hz)]
    double accel_noise_density = 5.9e-4;    ///< [m/s^2/sqrt(Hz)]
    double accel_error_m_s2 = 0.05;         ///< scale and bias errors of the force, modelled as noise per sample
    double jerk_psd = 1e5;                  ///< density of the white angular jerk [rad^2/s^5]
    double rest_rate_rad_s = 0.1;           ///< standstill: largest rate
    double rest_force_m_s2 = 0.3;           ///< standstill: largest deviation of the specific force from gravity
    double rest_s = 0.2;                    ///< standstill: shortest duration
    double rest_velocity_sigma_m_s = 0.01;  ///< standard deviation of the velocity at a standstill
    double rate_sigma_rad_s = 20.0;         ///< typical rate of one axis
    double tilt_max_rad = 0.5;              ///< tilt error at a standstill above which the filter resets
    double velocity_gate = 5.0;             ///< velocity error [standard deviations] above which the filter resets
    double rate_max_rad_s = 50.0;           ///< largest rate about one axis in the result
    double gap_max_s = 1.0;

    /// Calls the visitor with each parameter's reference, name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.rails);
      visit(p.tilted_rails,
            switch_field("tilted_rails",
                         "1: also search for tilted saturation limits; 0: treat each axis separately, as published",
                         FieldRank::basic));
      visit(p.gravity_m_s2, {"gravity_m_s2", "m/s^2", 0.1, 100.0, "strength of gravity"});
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro"});
      visit(p.accel_noise_density,
            {"accel_noise_density", "m/s^2/sqrt(Hz)", 1e-9, 10.0, "noise density of the accelerometer"});
      visit(p.accel_error_m_s2,
            {"accel_error_m_s2", "m/s^2", 0.0, 100.0,
             "standard deviation of the scale and bias error of the specific force, treated as noise of each sample",
             FieldRank::basic});
      visit(p.jerk_psd, {"jerk_psd_rad2_s5", "rad^2/s^5", 1.0, 1e12, "power spectral density of the white angular jerk",
                         FieldRank::basic});
      visit(p.rest_rate_rad_s, {"rest_rate_rad_s", "rad/s", 1e-6, 10.0, "maximum rate at a standstill"});
      visit(p.rest_force_m_s2, {"rest_force_m_s2", "m/s^2", 1e-6, 10.0,
                                "maximum difference between the magnitude of the specific force and gravity at a "
                                "standstill"});
      visit(p.rest_s, {"rest_s", "s", 0.0, 60.0, "minimum duration of a standstill"});
      visit(p.rest_velocity_sigma_m_s,
            {"rest_velocity_sigma_m_s", "m/s", 1e-6, 10.0, "standard deviation of the velocity at a standstill"});
      visit(p.rate_sigma_rad_s,
            {"rate_sigma_rad_s", "rad/s", 1e-3, 1e4, "standard deviation of the rate over long times"});
      visit(p.tilt_max_rad,
            {"tilt_max_rad", "rad", 0.0, 4.0,
             "maximum tilt error at a standstill; above this error, the smoother assumes that it missed a rotation"});
      visit(p.velocity_gate,
            {"velocity_gate", "1", 0.0, 1e6, "maximum velocity error at a standstill, in standard deviations"});
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "largest estimated rate"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                          "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };

  /// Throws InvalidParams if a parameter is outside its limits.
  explicit StandstillSmoother(const Params& params);

  /// Estimates the angular rate of each sample, and writes one RateState per sample to `out`. For unclipped axes, the
  /// estimated rate equals the gyro reading. On error, `out` keeps its content. Possible errors are `empty`, `too_few`
  /// (fewer than two samples), `non_finite`, `time_order` and `gap`. Time and memory are proportional to the number of
  /// samples.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out) const;

 private:
  Params params_;
  ClippingFinder rails_;
};

}  // namespace tumble::baselines
