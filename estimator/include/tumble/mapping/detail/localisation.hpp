// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/status.hpp"
#include "tumble/mapping/sweep_report.hpp"

namespace tumble {

/// Whether a run knew where it was on its map, by what the mapper itself states of each sweep: docs/maths/mapping.md,
/// section 11. Two things speak against it, once for good:
///  - the deviation of a position grew beyond the distance at which surfaces are matched. From there on a sweep fits
///    whichever surface is nearest, and a place that is found again is one of many;
///  - surfaces moved two sweeps or more further than their priors allow. One alone may be a rail that hid more than the
///    rates knew, which is what surfaces are for; an IMU or a lidar that is not what it claims does so again.
/// Before its first sweep with surfaces a run has no map to be lost on. How many sweeps were held, and in which
/// directions, is no evidence: it is in the deviation. Not seen: a map of another scale, which SweepScale tells, and
/// clocks or mountings that are off by what the calibration explains.
class Localisation {
 public:
  /// `matched_m`: MatchingParams::distance_m of the mapper.
  explicit Localisation(double matched_m) : matched_m_(matched_m) {}

  /// A sweep that was placed, in order. O(1).
  void add(const SweepReport& sweep);

  double largest_sigma_m() const { return largest_sigma_m_; }
  /// The largest but one of SweepReport::innovation.
  double second_innovation() const { return second_innovation_; }
  /// `out_of_range` with what was seen and the bound that it broke.
  Status verdict() const;

  /// Visits every member of the state. Defined in the library's sources: state_visitor.hpp.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  double matched_m_;
  bool mapped_ = false;
  double largest_sigma_m_ = 0.0, largest_innovation_ = 0.0, second_innovation_ = 0.0;
};

}  // namespace tumble
