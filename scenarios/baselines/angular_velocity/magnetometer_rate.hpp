// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "tumble/angular_velocity/clipping_finder.hpp"
#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"

namespace tumble::baselines {

/// Estimates angular rates from the rotation of the magnetic field, by an extended Kalman filter over gyro and
/// magnetometer.
///
/// The state contains the rate, the angular acceleration (white jerk), the field in IMU axes with b' = -w x b, and the
/// sensor's hard iron. The measurements are the unclipped gyro axes and the magnetometer. Field changes along the path
/// (nearby iron) are process noise. The process noise increases if the measured field strength differs from the
/// Earth's, as in the adaptive part of Tan's method.
///
/// The method is designed for bodies outdoors that spin fast about an axis perpendicular to the magnetic field (shells,
/// balls). The rate about the field direction is not observable; the filter estimates this rate only by assuming
/// smoothness. The filter mistakes the field of nearby steel for rotation.
///
/// Bandwidth and delay of the magnetometer, soft iron and forces are not modelled. The filter also ignores that
/// averaging over a window reduces the field strength by the fraction (w dt)^2 / 24, which is 0.1 % at 15 rad/s and 100
/// Hz.
///
/// Without a magnetometer, the filter bridges clipped readings by assuming a smooth rate.
class MagnetometerRate {
 public:
  struct Params {
    RailDetector::Params rails = {};
    bool tilted_rails = false;             ///< also detects tilted rails (ClippingFinder)
    double gyro_noise_density = 5.236e-4;  ///< [rad/s/sqrt(Hz)]
    double field_noise_t = 5e-8;           ///< standard deviation of one reading [T]
    double hard_iron_t = 1e-6;             ///< standard deviation of the sensor's offset [T]
    double earth_field_t = 0.0;            ///< undisturbed field strength [T]; 0: unknown
    double disturbance_t_sqrt_s = 1e-6;    ///< change of the field along the path [T/sqrt(s)]
    double disturbed_share = 0.02;         ///< relative deviation of the field strength that doubles the noise power
    double jerk_psd = 1e7;                 ///< density of the white angular jerk [rad^2/s^5]
    double rate_max_rad_s = 50.0;          ///< largest rate about one axis in the result
    double gap_max_s = 1.0;

    /// Visits every parameter with its name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.rails);
      visit(p.tilted_rails,
            on_off("tilted_rails", "1: search tilted rails too; 0: treat each axis separately, as published",
                   Rank::first));
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro"});
      visit(p.field_noise_t, {"field_noise_t", "T", 1e-12, 1e-3,
                              "noise of one reading: 0.5 mG, MTi-300 sheet of May 2023", Rank::first});
      visit(p.hard_iron_t,
            {"hard_iron_t", "T", 0.0, 1e-3, "standard deviation of the magnetometer's offset", Rank::first});
      visit(p.earth_field_t, {"earth_field_t", "T", 0.0, 1e-3, "magnitude of the undisturbed field; 0: unknown"});
      visit(p.disturbance_t_sqrt_s,
            {"disturbance_t_sqrt_s", "T/sqrt(s)", 0.0, 1.0, "random walk of the field along the path", Rank::first});
      visit(p.disturbed_share,
            {"disturbed_share", "1", 1e-4, 10.0,
             "relative deviation of the field's magnitude at which this random walk doubles in power", Rank::first});
      visit(p.jerk_psd, {"jerk_psd_rad2_s5", "rad^2/s^5", 1.0, 1e12, "power spectral density of the white angular jerk",
                         Rank::first});
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "largest estimated rate"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                          "longest allowed time between two samples; a longer gap ends the run with an error"});
    }
  };

  /// Throws InvalidParams if a parameter is outside its limits.
  explicit MagnetometerRate(const Params& params);

  /// Computes one RateState per sample in O(N). `field_I_t` contains one magnetometer reading per sample, NaN if
  /// missing; the span is empty if there is no magnetometer. On error, `out` is unchanged. Errors: `empty`, `too_few`
  /// (fewer than two samples, or a different number of magnetometer readings), `non_finite`, `time_order`, `gap`.
  Status estimate(std::span<const ImuSample> samples, std::span<const Eigen::Vector3d> field_I_t,
                  std::vector<RateState>& out) const;

 private:
  Params params_;
  ClippingFinder rails_;
};

}  // namespace tumble::baselines
