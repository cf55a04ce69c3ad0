// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "rolling_window.hpp"

namespace tumble::rolling {

/// The smoother's last pass over stored samples: one Kalman filter with the modes decided, and the way back.
///
/// What the way back needs of a node is more than 10 KiB, so it is not kept: nodes are cut into segments, the filter
/// at the beginning of each and the adjoint at its end are kept, and the records of one segment are computed anew when
/// they are needed, to the same bits. A window of one segment is gone over once, a longer one three times. It holds
/// four filters of 13 KiB by value: it is no object for the stack.
class LastPass {
 public:
  static constexpr std::size_t kSegment = 128;  ///< nodes; 1.6 MiB of records, 0.2 KiB of kept states for each node

  /// The filter and where in the samples it is, between two nodes.
  struct Checkpoint {
    PathFilter filter;
    Readings::Cursor reading;
  };
  struct Distance {
    double distance_m = 0.0, sigma_m = 0.0;
  };
  /// What is known of one sample.
  struct Smoothed {
    const SamplePoint& point;
    const RollingNominal& nominal;  ///< at the node before
    Reported error;                 ///< of the point
    const NodeRecord* node;         ///< the one whose covariance counts; none where the window has no node
    std::size_t index;              ///< its place among the window's
  };

  /// All that is given has to outlive the pass. `distance`, when known, is measured at the end of the samples.
  /// `segment`: nodes whose records are held at a time; it changes nothing else.
  LastPass(const RollingParams& params, std::span<const ImuSample> samples, std::span<const PathNode> path,
           std::optional<Distance> distance, std::size_t segment = kSegment);

  /// Forward from `start` and back. `cut` is the number of nodes after which cut() is.
  void run(const Checkpoint& start, std::size_t cut);

  std::size_t nodes() const { return horizontal_m2_.size(); }
  /// Smoothed variance of the IMU's horizontal position at each node.
  std::span<const double> horizontal_m2() const { return horizontal_m2_; }
  const Checkpoint& cut() const { return cut_; }
  const PathFilter& end() const { return end_.filter; }

  /// Calls `take` for each sample before the node `until`, in the order of time.
  void give(std::size_t until, const std::function<void(const Smoothed&)>& take);

 private:
  struct Kept {
    Checkpoint start;
    Adjoint end;
  };

  std::size_t first_of(std::size_t segment) const { return segment * length_; }
  void forward(std::size_t segment, Checkpoint& at);
  void go_again(std::size_t segment);
  void load(std::size_t segment);
  void remember(TimeNs time_ns, const RollingNominal& nominal, const Eigen::Vector3d& rate_I_rad_s, std::size_t node);
  void give_segment(std::size_t segment, std::size_t until, const std::function<void(const Smoothed&)>& take) const;

  const RollingParams& params_;
  std::span<const ImuSample> samples_;
  std::span<const PathNode> path_;
  std::optional<Distance> distance_;
  std::size_t length_;      ///< of a segment
  std::vector<Kept> kept_;  ///< one for each segment
  std::vector<double> horizontal_m2_;
  std::size_t cut_after_ = 0;
  Checkpoint cut_, end_;
  Checkpoint again_;  ///< in a segment that is gone over again
  Adjoint adjoint_;   ///< on the way back
  // of the segment that is loaded
  std::size_t loaded_ = 0;
  std::vector<NodeRecord> records_;
  std::vector<SamplePoint> points_;
  Reported smoothed_start_ = Reported::Zero();
  Reported moved_at_end_ = Reported::Zero();  ///< by the distance
};

}  // namespace tumble::rolling
