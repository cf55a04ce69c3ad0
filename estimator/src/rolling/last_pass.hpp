// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "rolling_window.hpp"

namespace tumble::rolling {

/// LastPass runs a Kalman filter with known contact modes forward, and a smoother backward.
///
/// The backward pass needs more than 10 KiB per node, so LastPass divides the nodes into segments. LastPass stores only
/// the filter at each segment's start and the adjoint at its end, and recomputes other data bit for bit. A window of
/// one segment needs one run of the filter, a longer window needs three. A LastPass is too large for the stack (four
/// filters of 13 KiB).
class LastPass {
 public:
  static constexpr std::size_t kSegment = 128;  ///< number of nodes per segment; the backward pass needs 1.6 MiB

  struct Checkpoint {
    PathFilter filter;
    Readings::Cursor reading;
  };
  struct Distance {
    double distance_m = 0.0, sigma_m = 0.0;
  };
  struct Smoothed {
    const SamplePoint& point;
    const RollingNominal& nominal;
    Reported error;          ///< smoothed error of the nominal trajectory at the sample
    const NodeRecord* node;  ///< node with the covariance of the sample; null if the window has no node
    std::size_t index;
  };

  /// All arguments must outlive the pass. A known `distance` from the start acts as a measurement after the last
  /// sample. `segment` is the number of nodes whose records are stored at a time.
  LastPass(const RollingParams& params, std::span<const ImuSample> samples, std::span<const PathNode> path,
           std::optional<Distance> distance, std::size_t segment = kSegment);

  /// After run(), cut() returns the filter after the first `cut` nodes.
  void run(const Checkpoint& start, std::size_t cut);

  std::size_t nodes() const { return horizontal_variance_m2_.size(); }
  /// smoothed variance of the IMU's horizontal position, per node
  std::span<const double> horizontal_variance_m2() const { return horizontal_variance_m2_; }
  const Checkpoint& cut() const { return cut_; }
  const PathFilter& end() const { return end_.filter; }

  /// Calls `take` with the smoothed estimate of each sample before the node `until`, in time order.
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
  Checkpoint again_;  ///< filter for a segment that is recomputed
  Adjoint adjoint_;   ///< state of the backward pass
  // index of the segment (`length_` successive nodes) whose filter records are in `records_`
  std::size_t loaded_ = 0;
  std::vector<NodeRecord> records_;
  std::vector<SamplePoint> points_;
  Reported smoothed_start_ = Reported::Zero();
  /// correction of the nominal trajectory due to the known distance from the start
  Reported distance_correction_ = Reported::Zero();
};

}  // namespace tumble::rolling
