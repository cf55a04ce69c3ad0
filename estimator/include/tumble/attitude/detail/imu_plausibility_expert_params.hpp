// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

/// The structs in imu_plausibility_expert_params.hpp are parts of ImuPlausibilityParams::Expert.
namespace tumble {

/// SteadyForceParams limits the magnitude of a constant force, as a fraction of gravity.
struct SteadyForceParams {
  double steady_force_ratio_min = 0.5,
         share_max = 2.0;  ///< bounds of the mean magnitude over windows with a constant force
  int windows_min = 5;     ///< minimum number of windows with a constant force

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.steady_force_ratio_min,
          {"force_ratio_min", "1", 0.0, 1.0, "minimum mean force of windows with steady force, as a share of gravity"});
    visit(p.share_max,
          {"force_ratio_max", "1", 1.0, 1e6, "maximum mean force of windows with steady force, as a share of gravity"});
    visit(p.windows_min, {"windows_min", "1", 1, 1e6,
                          "minimum number of windows with steady force for a check of the force's magnitude"});
  }
};

/// GravityRotationParams contains the parameters for comparing the rotation of gravity's direction with the gyro.
struct GravityRotationParams {
  /// Range of plausible regression slopes of gravity's rotation on the gyro's rotation. Pendulums and hand-held wands
  /// give slopes of 0.75 to 1.21.
  double slope_min = 0.65, slope_max = 1.5;
  double rotation_min_rad2 = 0.5;  ///< minimum sum of squared rotations for a decision
  double rotation_min_rad = 0.15;  ///< minimum rotation of a window
  /// Minimum number of windows in which the force rotated. In one or two windows, the check may mistake a push or the
  /// centripetal force of a spin in flight for gravity.
  double rotated_windows_min = 5.0;
  /// Maximum residual of a gyro scaled by the regression slope, as a fraction of the residual of the unscaled gyro. The
  /// maximum residual applies to slopes outside of 0 to 1.
  double unexplained_ratio_max = 0.75;
  double still_rotation_ratio = 1e-6;  ///< minimum rotation of the force, as a fraction of the gyro's rotation

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.slope_min, {"rotation_slope_min", "1", 0.0, 1.0,
                        "minimum ratio of gravity's rotation (accelerometer) to the rotation measured by the gyro"});
    visit(p.slope_max, {"rotation_slope_max", "1", 1.0, 1e6,
                        "maximum ratio of gravity's rotation (accelerometer) to the rotation measured by the gyro"});
    visit(p.rotation_min_rad2, {"rotation_min_rad2", "rad^2", 1e-12, 1e6,
                                "minimum sum of squared rotations for a check of the ratio of rotations"});
    visit(p.rotation_min_rad, {"rotation_min_rad", "rad", 1e-12, 3.0, "minimum rotation of a compared window"});
    visit(p.rotated_windows_min, {"rotated_windows_min", "1", 1.0, 1e6,
                                  "minimum number of windows with a rotating force for a check of the rotation"});
    visit(p.unexplained_ratio_max,
          {"rotation_unexplained_ratio_max", "1", 0.0, 1.0,
           "maximum unexplained rotation with another scale or sign of the gyro, as a share of the unexplained "
           "rotation with the stated gyro; below this share, a fault is reported"});
    visit(p.still_rotation_ratio,
          {"still_rotation_ratio", "1", 0.0, 1.0,
           "the force counts as not rotating if it rotates by less than this share of the gyro's rotation"});
  }
};

/// AxisNamingParams contains the parameters for detecting wrong axis labels.
struct AxisNamingParams {
  double unexplained_ratio_max = 0.33;  ///< maximum ratio of the residuals of better labels and current labels
  double unexplained_ratio_min = 0.01;  ///< minimum unexplained fraction for comparing labels

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.unexplained_ratio_max, {"relabelled_ratio_max", "1", 0.0, 1.0,
                                    "maximum unexplained rotation with exchanged axes, as a share of the unexplained "
                                    "rotation with the stated axes; below this share, a fault is reported"});
    visit(
        p.unexplained_ratio_min,
        {"relabelled_ratio_min", "1", 0.0, 1.0,
         "share of gravity's rotation that the stated axes leave unexplained, above which exchanged axes are tested"});
  }
};

/// FrozenTriadParams contains the parameters for detecting a gyro or accelerometer that repeats its reading.
struct FrozenTriadParams {
  double repeats_s = 1.0;              ///< minimum duration of a repetition
  double repetition_ratio_min = 10.0;  ///< minimum ratio to the longest earlier repetition
  double unexplained_ratio_min = 0.5;  ///< minimum unexplained fraction, for a gyro with constant readings

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.repeats_s,
          {"frozen_s", "s", 1e-12, 1e4,
           "duration after which an axis may be frozen, if it repeats one reading after an equally long motion"});
    visit(p.repetition_ratio_min,
          {"frozen_repetition_ratio", "1", 1.0, 1e6,
           "minimum length of a frozen run of equal readings, relative to the longest earlier run"});
    visit(p.unexplained_ratio_min,
          {"frozen_unexplained_ratio_min", "1", 0.0, 1.0,
           "share of unexplained rotation of gravity, above which a gyro with constant readings counts as frozen"});
  }
};

/// ImuPlausibilityExpertParams contains the rarely changed parameters of ImuPlausibility, grouped by topic.
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
