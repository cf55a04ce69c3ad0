// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/parameters.hpp"

namespace tumble {

/// Maximum differences of one IMU from the others, beyond which ImuMerge excludes the IMU.
struct ImuOutlierParams {
  double rate_rad_s = 0.15;  ///< maximum difference from the median
  double force_m_s2 = 3.0;   ///< maximum difference from the median
  /// A reading above this fraction of the range may be saturated during a part of its averaging window.
  double subsample_saturation_ratio = 0.15;
  double hidden_force_m_s2 = 3.0;  ///< largest force error attributed to saturation during a part of the window

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit(p.rate_rad_s, {"rate_tolerance_rad_s", "rad/s", 1e-12, 1e3,
                         "maximum accepted difference between an IMU's rate and the median of all IMUs"});
    visit(p.force_m_s2, {"force_tolerance_m_s2", "m/s^2", 1e-12, 1e4,
                         "maximum accepted difference between an IMU's force and the median of all IMUs"});
    visit(p.subsample_saturation_ratio,
          {"subsample_saturation_ratio", "1", 1e-12, 1.0,
           "a reading above this share of the range may be saturated during a part of its sample period"});
    visit(p.hidden_force_m_s2,
          {"hidden_force_m_s2", "m/s^2", 1e-12, 1e4,
           "maximum accepted difference between a possibly saturated force and the forces of the other IMUs"});
  }
};

struct ImuMergeExpertParams {
  ImuOutlierParams outliers = {};

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("", p.outliers);
  }
};

}  // namespace tumble
