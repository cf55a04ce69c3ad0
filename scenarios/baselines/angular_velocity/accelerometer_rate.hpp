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

/// AccelerometerRate estimates angular rates from several accelerometers at known positions, by an extended Kalman
/// filter (gyro-free inertial navigation).
///
/// The filter state contains the angular rate w and the angular acceleration alpha, which is driven by white jerk. Each
/// auxiliary IMU at position p gives one measurement: its specific force minus that of the primary IMU is alpha x p + w
/// x (w x p). The motion model of white jerk is valid in flight, in contact and at rest. The filter also uses unclipped
/// gyro axes (`use_gyro`), so the accelerometers only replace the clipped axes.
///
/// AccelerometerRate is designed for long fast rotation and widely spaced accelerometers (projectiles, vehicles). Slow
/// rotation is lost in noise and misalignment, because centripetal acceleration grows with the squared rate. The filter
/// neglects accelerometer bias, misalignment, and the correlation between the force differences of the auxiliary IMUs.
/// In flight, the filter does not use Euler's equations of free rotation.
///
/// With one auxiliary IMU, only products of rates contain the rate about the line between the two IMUs. Without
/// auxiliary IMUs, the filter assumes a smooth rate during clipping.
class AccelerometerRate {
 public:
  struct Params {
    RailDetector::Params rails = {};
    bool tilted_rails = false;  ///< also detects tilted rails (ClippingFinder), unlike the published method
    bool use_gyro = true;
    double gyro_noise_density = 5.236e-4;  ///< [rad/s/sqrt(Hz)]
    double accel_noise_density = 1.5e-3;   ///< largest density among the accelerometers [m/s^2/sqrt(Hz)]
    double accel_floor_m_s2 = 0.05;        ///< standard deviation of the bias of a force difference between two IMUs
    double accel_scale_error = 2e-3;       ///< scale error and misalignment, relative to the specific force
    double jerk_psd = 1e7;                 ///< density of the white angular jerk [rad^2/s^5]
    double rate_max_rad_s = 50.0;          ///< largest rate about one axis in the result
    double gap_max_s = 1.0;

    /// Calls the visitor with each parameter's reference, name, unit and limits.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("rails_", p.rails);
      visit(p.tilted_rails,
            switch_field("tilted_rails",
                         "1: also search for tilted saturation limits; 0: treat each axis separately, as published",
                         FieldRank::basic));
      visit(p.use_gyro,
            switch_field("use_gyro", "1: also use the unclipped axes of the primary gyro; 0: use accelerometers only",
                         FieldRank::basic));
      visit(p.gyro_noise_density, {"gyro_noise_density", "rad/s/sqrt(Hz)", 1e-9, 1.0, "noise density of the gyro"});
      visit(p.accel_noise_density,
            {"accel_noise_density", "m/s^2/sqrt(Hz)", 1e-9, 10.0, "noise density of the accelerometer"});
      visit(p.accel_floor_m_s2, {"accel_floor_m_s2", "m/s^2", 0.0, 100.0,
                                 "standard deviation of the bias of a difference between two accelerometers"});
      visit(p.accel_scale_error, {"accel_scale_error", "1", 0.0, 1.0,
                                  "scale and misalignment error of the accelerometers, as a share of the force"});
      visit(p.jerk_psd, {"jerk_psd_rad2_s5", "rad^2/s^5", 1.0, 1e12, "power spectral density of the white angular jerk",
                         FieldRank::basic});
      visit(p.rate_max_rad_s, {"rate_max_rad_s", "rad/s", 1.0, 1e4, "largest estimated rate"});
      visit(p.gap_max_s, {"gap_max_s", "s", 1e-6, 3600.0,
                          "maximum time between two samples; a longer gap ends the run with an error"});
    }
  };

  /// Throws InvalidParams if a parameter is outside its limits.
  explicit AccelerometerRate(const Params& params);

  /// Estimates the angular rate of each sample, and writes one RateState per sample to `out`. On error, `out` keeps its
  /// content. Possible errors are `empty`, `too_few` (fewer than two samples, or an auxiliary IMU with a different
  /// number of samples), `non_finite`, `time_order` and `gap`. The cost is proportional to the number of samples times
  /// the number of auxiliary IMUs.
  Status estimate(std::span<const ImuSample> samples, std::span<const AuxiliaryAccelerometer> auxiliary_imus,
                  std::vector<RateState>& out) const;

 private:
  Params params_;
  ClippingFinder rails_;
};

}  // namespace tumble::baselines
