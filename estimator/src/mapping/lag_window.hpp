// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <deque>
#include <vector>

#include "local_map.hpp"
#include "tumble/mapping/detail/registration.hpp"

namespace tumble::mapping {

struct EstimatedSweep {
  Registration::Estimate mean;
  Registration::Matrix error_covariance = Registration::Matrix::Zero();
};

/// The unknowns in `predicted`, `filtered` and `smoothed` refer to the start of the sweep.
struct WindowSweep {
  EstimatedSweep predicted;
  /// derivative of the unknowns with respect to the unknowns of the previous sweep
  Registration::Matrix jacobian_previous = Registration::Matrix::Identity();
  EstimatedSweep filtered, smoothed;
  std::vector<MotionSample> samples;
  TimeNs end_ns = 0;
  std::vector<InsertedPoint> inserted;

  Status motion(SweepTrajectory& trajectory) const;
};

/// LagWindow is a fixed-lag smoother over the newest sweeps.
class LagWindow {
 public:
  LagWindow() = default;
  explicit LagWindow(int sweeps) : length_(static_cast<std::size_t>(sweeps)) {}

  /// Appends a sweep, and drops the oldest sweep if the lag window is full.
  WindowSweep& append_sweep();
  /// If the lag window is full, the estimate of the oldest sweep is final.
  bool is_full() const { return sweeps_.size() == length_; }
  /// Smooths all sweeps except the newest: mapping.md (R63).
  void smooth();
  /// Moves the map points of all sweeps except the newest sweep to their smoothed positions.
  void move_inserted_sweeps(LocalMap& map) const;
  /// Excludes all previously inserted map points from later smoothing. The caller must call clear_inserted() after a
  /// change of the map point indices.
  void clear_inserted();

  template <class Change>
  void for_each(const Change& change) {
    for (WindowSweep& sweep : sweeps_) change(sweep);
  }

  std::size_t length() const { return length_; }
  const std::deque<WindowSweep>& sweeps() const { return sweeps_; }

 private:
  std::size_t length_ = 1;
  std::deque<WindowSweep> sweeps_;
};

}  // namespace tumble::mapping
