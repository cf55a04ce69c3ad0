// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

struct RollingContactParams {
  static constexpr double kGripSigma_m_s = 3e-3;      ///< standard deviation of the contact velocity while gripping
  static constexpr double kGripSigmaRatio = 1.5e-3;   ///< additional standard deviation, relative to the rolling speed
  static constexpr double kVerticalSigma_m_s = 8e-3;  ///< standard deviation of the vertical velocity while rolling
  /// standard deviation of the vertical velocity on a rough floor, relative to the rolling speed
  static constexpr double kRoughShare = 0.055;
  static constexpr double kSlopeSigma =
      0.15;  ///< standard deviation of both components of the slope when a slope begins
  static constexpr double kRestVelocitySigma_m_s = 2e-3;  ///< standard deviation of the mean velocity of a node at rest
  static constexpr double kRestRateSigma_rad_s = 3e-3;    ///< standard deviation of a node's mean rate at rest
};

struct RollingModeParams {
  double slip_begins_per_s = 0.5;
  static constexpr double kSlipEndsPerS = 2.0;  ///< rate of transitions from slip to grip
  double bump_begins_per_s = 0.3;
  static constexpr double kBumpEndsPerS = 5.0;      ///< rate of transitions from bump to grip
  double incline_begins_per_s = 0.001;              ///< rate of changes from the level floor to a slope
  static constexpr double kEventShortest_s = 0.06;  ///< minimum duration of slip or bump
  /// An event that increases the horizontal standard deviation of the position by more than this value sets
  /// RollingEstimate::uncertain.
  static constexpr double kEventSigmaGrowth_m = 0.03;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.slip_begins_per_s,
          {"slip_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to slip", ParameterRank::common_use});
    visit(p.bump_begins_per_s,
          {"bump_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to bump", ParameterRank::common_use});
    visit(p.incline_begins_per_s, {"incline_begins_per_s", "1/s", 1e-12, 1e3,
                                   "rate of transitions from level floor to slope", ParameterRank::common_use});
  }
};

}  // namespace tumble
