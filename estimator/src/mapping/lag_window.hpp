// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include "local_map.hpp"
#include "tumble/mapping/registration.hpp"

namespace tumble::mapping {

/// Unknowns and the covariance of their errors.
struct Estimated {
  Registration::Estimate mean;
  Registration::Matrix errors = Registration::Matrix::Zero();
};

/// A sweep that those after it still refine. Unknowns are those of its start.
struct WindowSweep {
  Estimated predicted;
  Registration::Matrix by_before = Registration::Matrix::Identity();  ///< of the predicted by those of the sweep before
  Estimated filtered, smoothed;                                       ///< smoothed begins as filtered
  std::vector<MotionSample> samples;
  TimeNs end_ns = 0;
  std::vector<InsertedPoint> inserted;

  /// As smoothed. Trouble is that of SweepTrajectory::build.
  Status motion(SweepTrajectory& trajectory) const;
};

/// The newest sweeps, refined together: fixed-lag smoothing.
class LagWindow {
 public:
  LagWindow() = default;
  explicit LagWindow(int sweeps) : length_(static_cast<std::size_t>(sweeps)) {}

  /// A new one, blank. The oldest leaves when the window is full already.
  WindowSweep& enter();
  /// Whether the oldest sweep has been refined by all that ever will.
  bool is_full() const { return sweeps_.size() == length_; }
  /// Each sweep but the newest by those after it: mapping.md (R52).
  void smooth();
  /// Moves what the sweeps but the newest put into the map to where they are now known to have seen it.
  void move_inserted(LocalMap& map) const;
  /// What was inserted so far stays where it is: indices of the map have changed.
  void forget_inserted();

  std::size_t length() const { return length_; }
  const std::deque<WindowSweep>& sweeps() const { return sweeps_; }

  /// Stated once: `mapping_members.hpp`.
  template <class Self, class Visitor>
  static void members(Self& s, Visitor& visit);

 private:
  std::size_t length_ = 1;
  std::deque<WindowSweep> sweeps_;
};

}  // namespace tumble::mapping
