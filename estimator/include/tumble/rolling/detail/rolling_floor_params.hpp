// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

struct RollingContactParams {
  double grip_sigma_m_s = 3e-3;      ///< standard deviation of the contact velocity while gripping
  double grip_sigma_ratio = 1.5e-3;  ///< additional standard deviation, relative to the rolling speed
  double vertical_sigma_m_s = 8e-3;
  /// standard deviation of the vertical velocity on a rough floor, relative to the rolling speed
  double rough_share = 0.055;
  double slope_sigma = 0.15;  ///< standard deviation of both components of the slope when a slope begins
  double rest_velocity_sigma_m_s = 2e-3;
  double rest_rate_sigma_rad_s = 3e-3;  ///< standard deviation of a node's mean rate at rest

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.grip_sigma_m_s, {"grip_sigma_m_s", "m/s", 1e-12, 1e3,
                             "standard deviation of the contact velocity while gripping", FieldRank::basic});
    visit(p.grip_sigma_ratio,
          {"grip_sigma_ratio", "1", 1e-12, 1e3,
           "additional standard deviation of the contact velocity while gripping, as a share of the rolling speed"});
    visit(p.vertical_sigma_m_s,
          {"vertical_sigma_m_s", "m/s", 1e-12, 1e3, "standard deviation of the vertical velocity while rolling"});
    visit(p.rough_share,
          {"rough_share", "1", 1e-12, 1e3,
           "standard deviation of the vertical velocity on a rough floor, as a share of the rolling speed",
           FieldRank::basic});
    visit(p.slope_sigma, {"slope_sigma", "1", 0.0, 1e3, "standard deviation of the sines of a slope at its start"});
    visit(p.rest_velocity_sigma_m_s, {"rest_velocity_sigma_m_s", "m/s", 1e-12, 1e3,
                                      "standard deviation of the mean velocity between two measurement updates, at "
                                      "rest"});
    visit(p.rest_rate_sigma_rad_s, {"rest_rate_sigma_rad_s", "rad/s", 1e-12, 1e3,
                                    "standard deviation of the mean rate between two measurement updates, at rest"});
  }
};

struct RollingModeParams {
  double slip_begins_per_s = 0.5, slip_ends_per_s = 2.0;
  double bump_begins_per_s = 0.3, bump_ends_per_s = 5.0;
  double incline_begins_per_s = 0.001;  ///< rate of changes from the level floor to a slope
  double event_shortest_s = 0.06;       ///< minimum duration of slip or bump
  /// An event that increases the horizontal standard deviation of the position by more than this value sets
  /// RollingEstimate::uncertain.
  double event_sigma_growth_m = 0.03;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.slip_begins_per_s,
          {"slip_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to slip", FieldRank::basic});
    visit(p.slip_ends_per_s,
          {"slip_ends_per_s", "1/s", 1e-12, 1e3, "rate of transitions from slip to grip", FieldRank::basic});
    visit(p.bump_begins_per_s,
          {"bump_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from grip to bump", FieldRank::basic});
    visit(p.bump_ends_per_s,
          {"bump_ends_per_s", "1/s", 1e-12, 1e3, "rate of transitions from bump to grip", FieldRank::basic});
    visit(p.incline_begins_per_s, {"incline_begins_per_s", "1/s", 1e-12, 1e3,
                                   "rate of transitions from level floor to slope", FieldRank::basic});
    visit(p.event_shortest_s,
          {"event_shortest_s", "s", 0.0, 10.0, "minimum duration of a slip or bump", FieldRank::basic});
    visit(p.event_sigma_growth_m,
          {"event_sigma_growth_m", "m", 1e-12, 1e3,
           "growth of the horizontal standard deviation of the position during slip or bump, above which the "
           "position is reported as uncertain"});
  }
};

}  // namespace tumble
