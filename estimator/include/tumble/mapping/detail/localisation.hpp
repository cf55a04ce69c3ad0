// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tumble/common/status.hpp"
#include "tumble/mapping/sweep_report.hpp"

namespace tumble {

/// Detects tracking failure from the SweepReport of each sweep (docs/maths/mapping.md, section 11). Tracking has failed
/// permanently if one of two findings applies.
/// First, tracking has failed if the position's standard deviation exceeded the matching distance of surfaces. A sweep
/// can then match any nearby surface, and a relocalisation is ambiguous.
/// Second, tracking has failed if surfaces corrected two or more sweeps by more than their priors allow. A single large
/// correction may come from saturation that the rates underestimated.
/// An IMU or a lidar that does not meet its data sheet causes several large corrections.
///
/// Before the first sweep with surfaces there is no map, so tracking cannot fail. Localisation does not use the number
/// of well constrained sweeps, because the standard deviation accounts for the number. Localisation does not detect a
/// map of another scale (see SweepScale), or errors of clocks or mounting that the calibration explains.
class Localisation {
 public:
  /// `matched_m` is MatchingParams::distance_m of the mapper.
  explicit Localisation(double matched_m) : matched_m_(matched_m) {}

  /// Processes a sweep that has a pose. Cost: O(1). Sweeps must be in time order.
  void add(const SweepReport& sweep);

  double largest_sigma_m() const { return largest_sigma_m_; }
  /// Returns the second largest SweepReport::innovation.
  double second_innovation() const { return second_innovation_; }
  /// Returns `out_of_range` with the finding and the violated limit, or `ok` without a finding.
  Status verdict() const;

  /// Passes every member of the state to the visitor. The source file state_visitor.hpp defines the function.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  double matched_m_;
  bool mapped_ = false;
  double largest_sigma_m_ = 0.0, largest_innovation_ = 0.0, second_innovation_ = 0.0;
};

}  // namespace tumble
