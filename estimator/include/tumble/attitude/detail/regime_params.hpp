// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/attitude/detail/regimes.hpp"
#include "tumble/attitude/detail/spin_tracker.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Parameters that MotionRegimeSmoother and MotionRegimeStream share.
struct MotionRegimeParams {
  MotionRegimeEvidence::Params evidence;
  SpinTracker::Params spin;
  double hand_held_probability_min = 0.02;  ///< below this probability of hand-held motion, its estimator does not run
  static constexpr double kSegmentGapMax_s = 0.1;  ///< clipped samples with shorter gaps form one segment

  template <class Self, class Visitor>
  static void fields(Self& p, Visitor& visit) {
    visit.group("evidence_", p.evidence);
    visit.group("spin_", p.spin);
    visit(p.hand_held_probability_min,
          {"hand_held_probability_min", "1", 0.0, 1.0,
           "minimum probability of hand-held motion for which the estimator of hand-held motion runs"});
  }
};

}  // namespace tumble
