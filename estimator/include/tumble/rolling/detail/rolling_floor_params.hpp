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
  double rough_radius_walk_m_sqrts = 1e-4;  ///< random walk of the rolling radius on a rough floor
  double slope_sigma = 0.15;                ///< standard deviation of both components of the slope when a slope begins
  double slope_walk_sqrts = 0.02;
  /// velocity error of an impact relative to its velocity change, from uncertain timing and direction
  double impact_sigma_ratio = 0.06;
  /// mean velocity change between two measurement updates by impacts that the rolling model does not explain
  double unexplained_impact_m_s = 0.03;
  double rest_velocity_sigma_m_s = 2e-3;
  double rest_rate_sigma_rad_s = 3e-3;  ///< standard deviation of a node's mean rate at rest
  double speed_sigma_m_s = 1.0;         ///< standard deviation of the mean velocity over 1 s without a measurement

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
    visit(p.rough_radius_walk_m_sqrts, {"rough_radius_walk_m_sqrts", "m/sqrt(s)", 0.0, 1.0,
                                        "random walk of the effective rolling radius on a rough floor"});
    visit(p.slope_sigma, {"slope_sigma", "1", 0.0, 1e3,
                          "standard deviation of the floor's inclination (sine of the angle) where a slope begins"});
    visit(p.slope_walk_sqrts, {"slope_walk_sqrts", "sqrt(s)", 1e-12, 1e3,
                               "random walk of the floor's inclination (sine of the angle) on a slope"});
    visit(p.impact_sigma_ratio,
          {"impact_sigma_ratio", "1", 0.0, 1e3,
           "standard deviation of the velocity after an impact, as a share of the impact's velocity change"});
    visit(p.unexplained_impact_m_s, {"unexplained_impact_m_s", "m/s", 1e-12, 1e3,
                                     "mean velocity change by unexplained impacts between two measurement updates, "
                                     "while the sphere stays on the floor"});
    visit(p.rest_velocity_sigma_m_s, {"rest_velocity_sigma_m_s", "m/s", 1e-12, 1e3,
                                      "standard deviation of the mean velocity between two measurement updates, at "
                                      "rest"});
    visit(p.rest_rate_sigma_rad_s, {"rest_rate_sigma_rad_s", "rad/s", 1e-12, 1e3,
                                    "standard deviation of the mean rate between two measurement updates, at rest"});
    visit(p.speed_sigma_m_s,
          {"speed_sigma_m_s", "m/s", 1e-12, 1e3,
           "standard deviation of the mean velocity over 1 s about zero, if nothing else measures the velocity"});
  }
};

struct RollingModeParams {
  double slip_begins_per_s = 0.5, slip_ends_per_s = 2.0;
  double bump_begins_per_s = 0.3, bump_ends_per_s = 5.0;
  double slip_bump_per_s = 0.2;  ///< rate of changes from slip to bump and from bump to slip
  double incline_begins_per_s = 0.001, incline_ends_per_s = 0.1;  ///< rates of change from and to the level floor
  double rough_begins_per_s = 0.02, rough_ends_per_s = 0.1;
  double event_shortest_s = 0.06;  ///< minimum duration of slip or bump
  /// threshold of RollingEstimate::uncertain: growth of the horizontal standard deviation of the position in slip or
  /// bump
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
    visit(p.slip_bump_per_s,
          {"slip_bump_per_s", "1/s", 1e-12, 1e3, "rate of transitions between slip and bump, each way"});
    visit(p.incline_begins_per_s, {"incline_begins_per_s", "1/s", 1e-12, 1e3,
                                   "rate of transitions from level floor to slope", FieldRank::basic});
    visit(p.incline_ends_per_s,
          {"incline_ends_per_s", "1/s", 1e-12, 1e3, "rate of transitions from slope to level floor"});
    visit(p.rough_begins_per_s,
          {"rough_begins_per_s", "1/s", 1e-12, 1e3, "rate of transitions from smooth to rough floor"});
    visit(p.rough_ends_per_s,
          {"rough_ends_per_s", "1/s", 1e-12, 1e3, "rate of transitions from rough to smooth floor"});
    visit(p.event_shortest_s,
          {"event_shortest_s", "s", 0.0, 10.0, "minimum duration of a slip or bump", FieldRank::basic});
    visit(p.event_sigma_growth_m,
          {"event_sigma_growth_m", "m", 1e-12, 1e3,
           "growth of the horizontal standard deviation of the position during slip or bump, above which the "
           "position is reported as uncertain"});
  }
};

}  // namespace tumble
