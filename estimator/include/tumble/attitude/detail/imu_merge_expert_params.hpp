// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

/// The structs in imu_merge_expert_params.hpp are parts of ImuMergeParams::Expert.
namespace tumble {

/// ImuOutlierParams defines when ImuMerge excludes a reading that differs from the readings of all other IMUs.
struct ImuOutlierParams {
  double rate_rad_s = 0.15;  ///< maximum difference from the median
  double rate_share = 0.03;  ///< additional difference, as a fraction of the rate
  double force_m_s2 = 3.0;   ///< maximum difference from the median
  /// A reading above subsample_saturation_ratio * range may be saturated during a part of its averaging window.
  double subsample_saturation_ratio = 0.15;
  double hidden_force_m_s2 = 3.0;  ///< largest force error attributed to saturation during a part of the window

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rate_rad_s, {"rate_tolerance_rad_s", "rad/s", 1e-12, 1e3,
                         "maximum accepted difference between an IMU's rate and the median of all IMUs"});
    visit(p.rate_share,
          {"rate_tolerance_ratio", "1", 0.0, 1.0,
           "additional accepted difference between an IMU's rate and the median, as a share of the rate"});
    visit(p.force_m_s2, {"force_tolerance_m_s2", "m/s^2", 1e-12, 1e4,
                         "maximum accepted difference between an IMU's force and the median of all IMUs"});
    visit(p.subsample_saturation_ratio,
          {"subsample_saturation_ratio", "1", 1e-12, 1.0,
           "above this share of the range, a reading may contain saturation within its sample period"});
    visit(p.hidden_force_m_s2,
          {"hidden_force_m_s2", "m/s^2", 1e-12, 1e4,
           "maximum accepted difference between a possibly saturated force and the forces of the other IMUs"});
  }
};

/// FrozenImuParams defines when ImuMerge treats an IMU as frozen. A frozen IMU repeats its reading while the readings
/// of other IMUs change, or repeats its force while gravity rotates. Sample and hold repeats a reading for less than
/// `after_s`, and does not count as frozen.
struct FrozenImuParams {
  double after_s = 0.1;
  double rate_rad_s = 0.03;  ///< minimum change of the rates of other IMUs
  double force_m_s2 = 0.3;
  double turned_rad = 1.0;        ///< minimum rotation of gravity during a repeated force; also used if all IMUs repeat
  double unfreeze_after_s = 0.5;  ///< duration of changing readings after which an IMU is used again

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.after_s,
          {"frozen_after_s", "s", 1e-12, 1e3,
           "duration after which an IMU counts as frozen, if it repeats one reading while the other IMUs move"});
    visit(p.rate_rad_s, {"frozen_rate_rad_s", "rad/s", 1e-12, 1e3,
                         "minimum change of the rates of the other IMUs while an IMU repeats its reading"});
    visit(p.force_m_s2, {"frozen_force_m_s2", "m/s^2", 1e-12, 1e4,
                         "minimum change of the forces of the other IMUs while an IMU repeats its reading"});
    visit(p.turned_rad,
          {"frozen_turned_rad", "rad", 1e-12, 1e3,
           "rotation of the IMUs after which an accelerometer that repeats one reading counts as frozen"});
    visit(p.unfreeze_after_s, {"unfreeze_after_s", "s", 1e-12, 1e3,
                               "duration of changing readings after which a frozen IMU is used again"});
  }
};

/// DisagreeingImuParams defines when ImuMerge permanently excludes an IMU: the IMU's mean over half a second differs
/// from the median of all IMUs for at least `after_s`.
struct DisagreeingImuParams {
  double rate_rad_s = 0.1;
  double rate_share = 0.06;  ///< additional difference, as a fraction of the rate
  double force_m_s2 = 1.0;
  double after_s = 0.3;

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rate_rad_s,
          {"disagree_rate_rad_s", "rad/s", 1e-12, 1e3,
           "difference of an IMU's mean rate over 0.5 s from the median of all IMUs, above which the IMU disagrees"});
    visit(p.rate_share,
          {"disagree_rate_ratio", "1", 0.0, 1.0,
           "additional accepted difference between an IMU's mean rate and the median, as a share of the rate"});
    visit(p.force_m_s2,
          {"disagree_force_m_s2", "m/s^2", 1e-12, 1e4,
           "difference of an IMU's mean force over 0.5 s from the median of all IMUs, above which the IMU disagrees"});
    visit(p.after_s, {"disagrees_after_s", "s", 1e-12, 1e3, "duration of disagreement after which an IMU is excluded"});
  }
};

/// ImuMergeExpertParams contains the rarely changed parameters of ImuMerge, grouped by topic.
struct ImuMergeExpertParams {
  ImuOutlierParams outliers = {};
  FrozenImuParams frozen = {};
  DisagreeingImuParams disagreeing = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.outliers);
    visit.group("", p.frozen);
    visit.group("", p.disagreeing);
  }
};

}  // namespace tumble
