// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

/// Groups of ImuPlausibility::Params::Expert.
namespace tumble {

/// Magnitude of a constant force, as a fraction of gravity.
struct SteadyForceParams {
  double share_min = 0.5, share_max = 2.0;  ///< bounds of the mean magnitude over windows with a constant force
  int windows_min = 5;                      ///< minimum number of constant windows

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.share_min, {"force_share_min", "1", 0.0, 1.0, "least mean force of steady windows, as a share of gravity"});
    visit(p.share_max,
          {"force_share_max", "1", 1.0, 1e6, "largest mean force of steady windows, as a share of gravity"});
    visit(p.windows_min,
          {"windows_min", "1", 1, 1e6, "least number of steady windows for a check of the force's magnitude"});
  }
};

/// Comparison of the rotation of gravity's direction with the gyro.
struct GravityRotationParams {
  /// Range of plausible regression slopes of gravity's rotation on the gyro's rotation. Pendulums and hand-held wands
  /// give slopes of 0.75 to 1.21.
  double slope_min = 0.65, slope_max = 1.5;
  double rotation_min_rad2 = 0.5;    ///< minimum sum of squared rotations for a decision
  double rotation_least_rad = 0.15;  ///< minimum rotation of a window
  /// Minimum number of windows in which the force rotated. In one or two windows, a push or the centripetal force of a
  /// spin in flight may be mistaken for gravity.
  double rotated_windows_min = 5.0;
  /// Maximum residual of a gyro scaled by the regression slope, as a fraction of the residual of the unscaled gyro. The
  /// maximum residual applies to slopes outside of 0 to 1.
  double unexplained_share_max = 0.75;
  double still_share = 1e-6;  ///< minimum rotation of the force, as a fraction of the gyro's rotation

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

/// Detection of wrong axis labels.
struct AxisNamingParams {
  double unexplained_share_max = 0.33;  ///< maximum residual of better labels, as a fraction of the current residual
  double unexplained_least = 0.01;      ///< minimum unexplained fraction at which labels are compared

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.unexplained_share_max, {"relabelled_share_max", "1", 0.0, 1.0,
                                    "largest unexplained share of exchanged axes, relative to the stated axes"});
    visit(p.unexplained_least,
          {"relabelled_least", "1", 0.0, 1.0, "unexplained share above which exchanged axes are tested"});
  }
};

/// Detection of a gyro or accelerometer that repeats its reading.
struct FrozenTriadParams {
  double repeats_s = 1.0;          ///< minimum duration of a repetition
  double longest_share = 10.0;     ///< minimum ratio to the longest earlier repetition
  double unexplained_least = 0.5;  ///< minimum unexplained fraction, for a gyro that never changed

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

/// Parameters of ImuPlausibilityParams that few users change, grouped by meaning.
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
