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

/// What can be done about clipped rates with the gyro alone: three models of how a rate goes on while it is not seen.
///
/// Each axis stands by itself. Readings at the rail are left out; the answer is held between the reading that was
/// clipped and a largest rate. The accelerometer is not used.
///
/// - `interpolate`: a cubic over each clipped gap that meets value and slope on both sides. Made for gaps that are
///   short beside the motion: a brush against the rail.
/// - `reject`: a causal Kalman filter whose rate is a random walk, so that it stands still over a gap. What Point-LIO
///   does with saturated rows while nothing else (no lidar) speaks: made for gaps shorter than the time between two
///   corrections by another sensor.
/// - `constant_jerk`: a smoother whose jerk is a random walk (white noise on snap) over short times and whose rate is
///   bounded in the long run: the stationary process of Matern 5/2 with deviation `rate_sigma_rad_s`. A clipped reading
///   is a hard bound that the curve leans on instead of being cut there. Works for swings that pass the rail without
///   impacts and for gaps up to about 2 / lambda, lambda = (3 psd / (16 sigma^2))^(1/5), 0.15 s; over longer ones it
///   falls back towards the rail, with the variance of a curve that is known to lie beyond it.
///
/// Where a gap begins or ends with an impact its slope is carried into the gap, and both smooth ones leave the truth:
/// on tumbles of the rig their means are worse than the clipped reading.
///
/// What none of them models: impacts inside of a gap, and the coupling of the axes of a tumbling body.
class ClippedBaseline {
 public:
  enum class Kind { interpolate, reject, constant_jerk };
  struct Params {
    Kind kind = Kind::interpolate;
    RailDetector::Params rails = {};
    bool tilted_rails = false;  ///< judge by tilted planes too (ClippingFinder); published by axis alone
    /// Noise density of the gyro [rad/s/sqrt(Hz)].
    double gyro_noise_density = 5.236e-4;
    /// Density of the white angular acceleration of `reject` [rad^2/s^3].
    double acceleration_psd = 1e3;
    /// Density of the white angular snap of `constant_jerk` [rad^2/s^7].
    double snap_psd = 1e9;
    /// How fast the body turns as a rule, one axis, `constant_jerk` [rad/s].
    double rate_sigma_rad_s = 20.0;
    double rate_max_rad_s = 50.0;  ///< no answer to a gap lies beyond
    double gap_max_s = 1.0;        ///< longest time between samples before the run is refused

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.rails);
      visit(p.tilted_rails,
            on_off("tilted_rails", "1: search tilted rails too; 0: treat each axis separately, as published",
                   Rank::first));
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro"});
      visit(p.acceleration_psd, {"acceleration_psd_rad2_s3", "rad^2/s^3", 1e-12, 1e12,
                                 "power spectral density of the white angular acceleration that drives the rate; 1000 "
                                 "as in Point-LIO's configurations",
                                 Rank::first});
      visit(p.snap_psd, {"snap_psd_rad2_s7", "rad^2/s^7", 1e-12, 1e15,
                         "power spectral density of the white angular snap that drives the jerk", Rank::first});
      visit(p.rate_sigma_rad_s, {"rate_sigma_rad_s", "rad/s", 1e-3, 1e4,
                                 "stationary standard deviation of the rate, which bounds long gaps", Rank::first});
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "largest estimated rate"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                          "longest allowed time between two samples; a longer gap ends the run with an error"});
    }
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit ClippedBaseline(const Params& params);

  /// One RateState per sample. On trouble (`empty`, `too_few`: less than two samples, `non_finite`, `time_order`,
  /// `gap`) nothing is written. O(N).
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out) const;

 private:
  Params params_;
  ClippingFinder rails_;
};

}  // namespace tumble::baselines
