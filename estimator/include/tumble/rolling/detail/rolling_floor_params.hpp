// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

struct RollingContactParams {
  static constexpr double kGripSigma_m_s = 3e-3;  ///< standard deviation of the contact point's velocity while gripping
  static constexpr double kGripSigmaRatio =
      1.5e-3;  ///< additional standard deviation of this velocity, relative to the rolling speed
  static constexpr double kVerticalSigma_m_s = 8e-3;  ///< standard deviation of the vertical velocity on a smooth floor
  /// standard deviation of the vertical velocity on a rough floor, relative to the rolling speed
  static constexpr double kRoughShare = 0.055;
  static constexpr double kSlopeSigma = 0.15;  ///< prior standard deviation of both components of the floor's slope
  static constexpr double kRestVelocitySigma_m_s =
      2e-3;  ///< standard deviation of the mean velocity over a time step at rest
  static constexpr double kRestRateSigma_rad_s =
      3e-3;  ///< standard deviation of the mean rate over a time step at rest
};

struct ContactModeParams {
  double slip_begins_per_s = 0.5;
  static constexpr double kSlipEndsPerS = 2.0;  ///< rate of transitions from slip to grip
  double bump_begins_per_s = 0.3;
  static constexpr double kBumpEndsPerS = 5.0;  ///< rate of transitions from bump to grip
  double incline_begins_per_s = 0.001;          ///< rate of transitions from the level floor to a slope
  static constexpr double kEventShortest_s = 0.06;
  /// RollingEstimate::uncertain is set if a slip or bump increases the horizontal standard deviation of the position by
  /// more than this value.
  static constexpr double kEventSigmaGrowth_m = 0.03;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.slip_begins_per_s, {"slip_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to slip",
                                ParameterAudience::common_use});
    visit(p.bump_begins_per_s, {"bump_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to bump",
                                ParameterAudience::common_use});
    visit(p.incline_begins_per_s, {"incline_begins_per_s", "1/s", 1e-12, 1e3,
                                   "rate of transitions from level floor to slope", ParameterAudience::common_use});
  }
};

}  // namespace tumble
