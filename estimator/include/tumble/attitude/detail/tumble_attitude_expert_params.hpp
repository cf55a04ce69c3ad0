// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/angular_velocity/detail/rest_detector.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

struct AttitudeRestParams {
  static constexpr double kVelocitySigma_m_s = 0.005;  ///< standard deviation of the velocity at rest, per node
  static constexpr double kRateSigma_rad_sqrts =
      2e-3;  ///< standard deviation of the rate measured at rest, mean over 1 s
  /// maximum difference between mean rate and bias at rest, in standard deviations of the difference
  double rate_sigmas = 3.0;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rate_sigmas, {"rest_rate_sigmas", "1", 1.0, 1e6,
                          "maximum difference between mean rate and bias at rest, in standard deviations"});
  }
};

struct AttitudeGapParams {
  /// Random walks of the rate and velocity of tumbling bodies during a gap. On hills, stairs and cliffs, the true
  /// random walks over 0.05 to 0.5 s are 3.0 to 11.4 rad/s and 2.4 to 4.1 m/s per sqrt(s) (docs/figures.md).
  static constexpr double kRateWalk_rad_s_sqrts = 7.0;
  static constexpr double kVelocityWalk_m_s_sqrts = 3.3;
  /// Standard deviations of the tilt, per axis. Coarse alignment starts above `lost_tilt_rad`, where the linearised
  /// filter is invalid, and ends below `aligned_tilt_rad`.
  double lost_tilt_rad = 0.3;
  static constexpr double kAlignedTilt_rad = 0.4;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.lost_tilt_rad,
          {"gap_lost_tilt_rad", "rad", 1e-3, 1e4,
           "standard deviation of the tilt after a gap, above which TumbleAttitude initialises the tilt again"});
  }
};

struct TumbleAttitudeExpertParams {
  static constexpr double kBiasWalk_rad_s_sqrts = 2e-6;  ///< random walk of the bias per sqrt(s)
  double recovered_tau_s = 0.05;                         ///< correlation time of the error of a recovered rate
  double gap_max_s = 1.0;
  RestDetector::Params rest_detector = {.rate_max_rad_s = 3.4907e-2,
                                        .rate_spread_rad_s = 3.4907e-2,
                                        .force_spread_m_s2 = 0.5,
                                        .rest_s = 1.0,
                                        .reading_s = 0.0,  // the readings are already averaged
                                        .memory_s = 1.0};
  AttitudeRestParams at_rest = {};
  AttitudeGapParams gap = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.recovered_tau_s, {"recovered_tau_s", "s", 1e-4, 1e4, "correlation time of the error of a recovered rate"});
    visit(p.gap_max_s, {"gap_max_s", "s", 1e-9, 1e4, "maximum time between two samples; a longer gap causes an error"});
    visit.group("rest_", p.rest_detector);
    visit.group("", p.at_rest);
    visit.group("", p.gap);
  }
};

}  // namespace tumble
