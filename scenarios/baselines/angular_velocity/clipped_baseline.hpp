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

/// ClippedBaseline estimates clipped angular rates from the gyro alone, with one of three models of the rate during
/// clipping.
///
/// ClippedBaseline estimates each gyro axis independently. The estimate is limited to the range from the saturation
/// level to a maximum rate. ClippedBaseline ignores the accelerometer.
///
/// - The model `interpolate` bridges each gap of clipped samples by a cubic with the rate and the derivative at both
///   ends of the gap. The model suits gaps that are short compared with the motion.
/// - The model `reject` is a causal Kalman filter with a random-walk rate, so the rate is constant during a gap.
///   Point-LIO also keeps the rate constant during saturation, until the next lidar correction. The model suits gaps
///   shorter than the time between corrections by another sensor.
/// - The model `constant_jerk` smooths a stationary Matern 5/2 process: white snap, with a bounded rate
///   (`rate_sigma_rad_s`). Clipped readings are hard lower limits of the rate's magnitude. The model suits swings
///   without impacts, and gaps up to about 2 / lambda = 0.15 s, with lambda = (3 snap_psd / (16 rate_sigma^2))^(1/5).
///   In longer gaps, the estimated rate returns towards the saturation limit, while the reported variance belongs to a
///   curve above the limit.
///
/// An impact at the start or end of a gap gives `interpolate` and `constant_jerk` a wrong derivative. On simulated
/// tumbles of the rig, the mean errors of both models exceed the error of the clipped reading. ClippedBaseline neglects
/// impacts within a gap, and the coupling between the axes of a tumbling body.
class ClippedBaseline {
 public:
  enum class Kind { interpolate, reject, constant_jerk };
  struct Params {
    Kind kind = Kind::interpolate;
    RailDetector::Params rails = {};
    bool tilted_rails = false;  ///< also detects tilted rails (ClippingFinder), unlike the published method
    /// Noise density of the gyro [rad/s/sqrt(Hz)].
    double gyro_noise_density = 5.236e-4;
    /// Model `reject`: density of the white angular acceleration [rad^2/s^3].
    double acceleration_psd = 1e3;
    /// Model `constant_jerk`: density of the white angular snap [rad^2/s^7].
    double snap_psd = 1e9;
    /// Model `constant_jerk`: standard deviation of the rate of one axis [rad/s].
    double rate_sigma_rad_s = 20.0;
    double rate_max_rad_s = 50.0;  ///< largest rate about one axis in a gap
    double gap_max_s = 1.0;        ///< longest accepted time between samples

    /// Calls the visitor with each parameter's reference, name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.rails);
      visit(p.tilted_rails,
            switch_field("tilted_rails",
                         "1: also search for tilted saturation limits; 0: treat each axis separately, as published",
                         FieldRank::basic));
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro"});
      visit(p.acceleration_psd, {"acceleration_psd_rad2_s3", "rad^2/s^3", 1e-12, 1e12,
                                 "power spectral density of the white angular acceleration that drives the rate; "
                                 "Point-LIO's configurations use 1000",
                                 FieldRank::basic});
      visit(p.snap_psd, {"snap_psd_rad2_s7", "rad^2/s^7", 1e-12, 1e15,
                         "power spectral density of the white angular snap that drives the jerk", FieldRank::basic});
      visit(p.rate_sigma_rad_s,
            {"rate_sigma_rad_s", "rad/s", 1e-3, 1e4,
             "standard deviation of the rate over long times; bounds the uncertainty in long gaps", FieldRank::basic});
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "largest estimated rate"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                          "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };

  /// Throws InvalidParams if a parameter is outside its limits.
  explicit ClippedBaseline(const Params& params);

  /// Estimates the angular rate of each sample, and writes one RateState per sample to `out`, in O(N). On error, `out`
  /// keeps its content. Possible errors are `empty`, `too_few` (fewer than two samples), `non_finite`, `time_order` and
  /// `gap`.
  Status estimate(std::span<const ImuSample> samples, std::vector<RateState>& out) const;

 private:
  Params params_;
  ClippingFinder rails_;
};

}  // namespace tumble::baselines
