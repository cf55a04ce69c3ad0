// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "rolling_window.hpp"

namespace tumble::rolling {

/// LastPass is the final pass of RollingSmoother over stored samples: one Kalman filter with fixed modes, then the
/// backward pass.
///
/// The backward pass needs more than 10 KiB per node. LastPass therefore divides the nodes into segments, and stores
/// only the filter at the start of each segment and the adjoint at its end. The records of one segment are recomputed
/// when needed, bit for bit. A window of one segment is processed one time, and a longer window three times. A LastPass
/// contains four filters of 13 KiB, so do not put a LastPass on the stack.
class LastPass {
 public:
  static constexpr std::size_t kSegment = 128;  ///< number of nodes; 1.6 MiB of records

  /// Checkpoint is the filter and its position in the samples, between two nodes.
  struct Checkpoint {
    PathFilter filter;
    Readings::Cursor reading;
  };
  struct Distance {
    double distance_m = 0.0, sigma_m = 0.0;
  };
  /// Smoothed is the smoothed result at one sample.
  struct Smoothed {
    const SamplePoint& point;
    const RollingNominal& nominal;
    Reported error;          ///< error of the sample
    const NodeRecord* node;  ///< node whose covariance applies; null if the window has no node
    std::size_t index;
  };

  /// Constructs the pass; all arguments must outlive the pass. If `distance` is known, the distance is measured at the
  /// end of the samples. `segment` is the number of nodes whose records are stored at a time. The number of nodes per
  /// segment affects only memory and computing time.
  LastPass(const RollingParams& params, std::span<const ImuSample> samples, std::span<const PathNode> path,
           std::optional<Distance> distance, std::size_t segment = kSegment);

  /// Runs forward from `start`, and then backward. `cut` is the number of nodes after which the filter is copied for
  /// cut().
  void run(const Checkpoint& start, std::size_t cut);

  std::size_t nodes() const { return horizontal_variance_m2_.size(); }
  /// Returns the smoothed variance of the IMU's horizontal position at each node.
  std::span<const double> horizontal_variance_m2() const { return horizontal_variance_m2_; }
  const Checkpoint& cut() const { return cut_; }
  const PathFilter& end() const { return end_.filter; }

  /// Calls `take` for each sample before the node `until`, in time order.
  void give(std::size_t until, const std::function<void(const Smoothed&)>& take);

 private:
  struct SegmentEnds {
    Checkpoint start;
    Adjoint end;
  };

  std::size_t first_of(std::size_t segment) const { return segment * length_; }
  void forward(std::size_t segment, Checkpoint& at);
  void recompute_segment(std::size_t segment);
  void load(std::size_t segment);
  void store(TimeNs time_ns, const RollingNominal& nominal, const Eigen::Vector3d& rate_I_rad_s, std::size_t node);
  void report_segment(std::size_t segment, std::size_t until, const std::function<void(const Smoothed&)>& take) const;

  const RollingParams& params_;
  std::span<const ImuSample> samples_;
  std::span<const PathNode> path_;
  std::optional<Distance> distance_;
  std::size_t length_;
  std::vector<SegmentEnds> kept_;
  std::vector<double> horizontal_variance_m2_;
  std::size_t cut_after_ = 0;
  Checkpoint cut_, end_;
  Checkpoint again_;  ///< filter in a segment that is recomputed
  Adjoint adjoint_;   ///< adjoint of the backward pass
  // index of the loaded segment
  std::size_t loaded_ = 0;
  std::vector<NodeRecord> records_;
  std::vector<SamplePoint> points_;
  Reported smoothed_start_ = Reported::Zero();
  Reported distance_correction_ = Reported::Zero();  ///< correction due to the measured distance
};

}  // namespace tumble::rolling
