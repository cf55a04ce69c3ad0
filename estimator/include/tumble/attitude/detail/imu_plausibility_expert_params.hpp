// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

/// Groups of ImuPlausibility::Params::Expert.
namespace tumble {

/// Size of a steady force as a share of gravity.
struct SteadyForceParams {
  double share_min = 0.5, share_max = 2.0;  ///< mean of steady windows
  int windows_min = 5;                      ///< steady ones, to say something of it

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.share_min, {"force_share_min", "1", 0.0, 1.0, "least mean force of steady windows, as a share of gravity"});
    visit(p.share_max,
          {"force_share_max", "1", 1.0, 1e6, "largest mean force of steady windows, as a share of gravity"});
    visit(p.windows_min,
          {"windows_min", "1", 1, 1e6, "least number of steady windows for a check of the force's magnitude"});
  }
};

/// How gravity's direction turns beside what the gyro says.
struct GravityRotationParams {
  /// Slope of gravity's turning over the gyro's; pendulums and wands leave 0.75 to 1.21.
  double slope_min = 0.65, slope_max = 1.5;
  double rotation_min_rad2 = 0.5;    ///< sum of squares below which nothing is said of it
  double rotation_least_rad = 0.15;  ///< of a window, to count as turning
  /// So many of them: in one or two a push may pass for gravity, or what a rig that spins in flight feels at its
  /// position.
  double rotated_windows_min = 5.0;
  /// Of what the gyro leaves unexplained, by one of the slope's scale, where that is not between 0 and 1.
  double unexplained_share_max = 0.75;
  double still_share = 1e-6;  ///< of the gyro's turning; a spin in flight leaves 0.006 and less

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.slope_min,
          {"rotation_slope_min", "1", 0.0, 1.0, "least slope of gravity's rotation over the gyro's rotation"});
    visit(p.slope_max,
          {"rotation_slope_max", "1", 1.0, 1e6, "largest slope of gravity's rotation over the gyro's rotation"});
    visit(p.rotation_min_rad2,
          {"rotation_min_rad2", "rad^2", 1e-12, 1e6, "least sum of squared rotations for a check of the slope"});
    visit(p.rotation_least_rad, {"rotation_least_rad", "rad", 1e-12, 3.0, "least rotation of a window to be compared"});
    visit(p.rotated_windows_min, {"rotated_windows_min", "1", 1.0, 1e6,
                                  "least number of windows with a rotating force for a check of the rotation"});
    visit(p.unexplained_share_max,
          {"rotation_unexplained_share_max", "1", 0.0, 1.0,
           "largest unexplained share of a gyro with another scale or sign, relative to the stated gyro"});
    visit(p.still_share,
          {"still_share", "1", 0.0, 1.0,
           "rotation of the force, as a share of the gyro's rotation, below which the force does not rotate"});
  }
};

/// When axes are named otherwise than they say.
struct AxisNamingParams {
  double unexplained_share_max = 0.33;  ///< of what the naming at hand leaves unexplained, by a better one
  double unexplained_least = 0.01;      ///< unexplained share from which on namings are compared

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.unexplained_share_max, {"relabelled_share_max", "1", 0.0, 1.0,
                                    "largest unexplained share of exchanged axes, relative to the stated axes"});
    visit(p.unexplained_least,
          {"relabelled_least", "1", 0.0, 1.0, "unexplained share above which exchanged axes are tested"});
  }
};

/// A triad that repeats its reading.
struct FrozenTriadParams {
  double repeats_s = 1.0;          ///< for so long it may be frozen, after as long of moving ones
  double longest_share = 10.0;     ///< and lasts so many times longer than any did before
  double unexplained_least = 0.5;  ///< of gravity's turning, for a gyro that never moved

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.repeats_s, {"frozen_s", "s", 1e-12, 1e4,
                        "a reading that repeats for this long, after equally long motion, may be frozen"});
    visit(p.longest_share,
          {"frozen_share", "1", 1.0, 1e6, "least ratio of a frozen run to the longest earlier run of equal readings"});
    visit(p.unexplained_least,
          {"frozen_unexplained_least", "1", 0.0, 1.0,
           "least unexplained share of gravity's rotation for a gyro that never moved to be frozen"});
  }
};

/// What few need of ImuPlausibilityParams, by meaning.
struct ImuPlausibilityExpertParams {
  SteadyForceParams force = {};
  GravityRotationParams turning = {};
  AxisNamingParams naming = {};
  FrozenTriadParams frozen = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.force);
    visit.group("", p.turning);
    visit.group("", p.naming);
    visit.group("", p.frozen);
  }
};

}  // namespace tumble
