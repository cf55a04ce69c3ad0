// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <deque>
#include <optional>

#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/types.hpp"

namespace tumble {

/// Estimates heading and translation of the frame of position readings relative to the world frame W, causally. The
/// method is a weighted least-squares fit to the last 64 distinct antenna positions. Position readings within half a
/// standard deviation of each other are averaged. The poses drift, so earlier positions have smaller weights. A
/// chi-square test (99.9 %) rejects up to a fifth of the positions as outliers.
class PositionAlignment {
 public:
  static constexpr std::size_t kReadingsMax = 1024, kMaxPositionPairs = 64;
  struct PositionPair {
    Eigen::Vector3d antenna_position_W_m = Eigen::Vector3d::Zero(), antenna_position_P_m = Eigen::Vector3d::Zero();
    double variance_m2 = 0.0, path_m = 0.0, pose_variance_m2 = 0.0;
  };

  /// Stores a position reading. The reading is processed when the sweep that covers its time has been registered.
  /// Readings may arrive in any order. See TumblingOdometry::add_frame_alignment_position().
  Status add(const PositionReading& reading, TimeNs done_ns, TimeNs latest_ns, std::size_t most);
  /// Processes a registered sweep and all position readings up to the end of the sweep. Cost: O(n^2) for n stored
  /// positions.
  void add_sweep(const SweepResult& report);
  /// Discards the processed position readings, because the world frame W has changed.
  void restart_fit();
  /// Returns the frame of the position readings relative to W, at the end of the last sweep. The result is empty if the
  /// heading is uncertain by more than 0.1 rad, or if the position readings contradict each other.
  const std::optional<PositionFrame>& position_frame() const { return position_frame_; }

 private:
  void add_position_pair(const PositionReading& reading, const PoseState& pose);
  void fit();

  std::deque<PositionReading> waiting_readings_;  ///< in the order of their times
  std::deque<PositionPair> position_pairs_;
  std::optional<PositionFrame> position_frame_;
  Eigen::Vector3d last_position_W_m_ = Eigen::Vector3d::Zero();  ///< position of the IMU at the end of the last sweep
  double path_m_ = 0.0, pose_variance_m2_ = 0.0;  ///< length of the path; variance of the last pose, all axes
  bool in_prior_map_ = false;
};

}  // namespace tumble
