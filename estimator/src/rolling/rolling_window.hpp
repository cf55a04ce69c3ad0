// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "rolling_node.hpp"
#include "tumble/common/types.hpp"
#include "tumble/rolling/detail/rolling_smoother.hpp"

namespace tumble::rolling {

struct ModePathNode {
  ContactMode mode = ContactMode::grip;
  bool at_rest = false;
  bool spins_in_place = false;  ///< the sphere is at rest, but rotates about the contact point
  bool holds_constant_position = false;
  Eigen::Matrix3d position_spread_m2 = Eigen::Matrix3d::Zero();
};

/// number of error states that determine a pose: attitude, velocity, position, lever arm
inline constexpr int kReported = 12;
using Reported = Eigen::Matrix<double, kReported, 1>;

struct FilterNodeRecord {
  /// maximum number of scalar measurements per filter step: at rest, three velocities and three gyro biases
  static constexpr int kMaxMeasurements = 6;
  Moving moving_jacobian;
  std::array<Row, kMaxMeasurements> measurement_rows;
  std::array<Vector, kMaxMeasurements> gain;
  std::array<double, kMaxMeasurements> innovation{}, variance{};
  int measurement_count = 0;
  bool resets_floor_slope = false;
  bool tilt_reset = false;
  bool heading_lost = false;
  /// rows of the error covariance that belong to the reported states, after the update
  Eigen::Matrix<double, kReported, kStates> covariance_rows;
  Reported correction;
  Vector heading_correction;  ///< heading_component() of the correction, if the heading is lost
  RollingNominalState nominal;
  ModePathNode mode_path_node;
  TimeNs time_ns = 0;
  Reported smoothed;
  Eigen::Matrix<double, kReported, kReported> smoothed_covariance;
};

/// RollingReading is one input of the live filter: an IMU reading, or a part of a data gap.
struct RollingReading {
  ImuSample sample;
  double length_s = 0.0;
  GapUncertainty uncertainty;
  bool in_gap = false, ends_at_sample = true;  ///< in a gap, only the last part ends at a sample
  TimeNs end_ns = 0;
};

/// RollingReadings iterates over stored samples, and returns the same inputs that the live filter received. next()
/// costs O(1) and allocates no memory.
class RollingReadings {
 public:
  RollingReadings(const RollingParams& params, std::span<const ImuSample> samples, const ReadingCursor& from)
      : params_(params), samples_(samples), cursor_(from) {}

  const ReadingCursor& cursor() const { return cursor_; }
  bool next(RollingReading& out);

 private:
  void next_gap_step(double gap_s, RollingReading& out);

  const RollingParams& params_;
  std::span<const ImuSample> samples_;
  ReadingCursor cursor_;
};

struct SampleMotion {
  TimeNs time_ns = 0;
  Eigen::Quaterniond q_WI;
  Eigen::Vector3d v_WI_m_s, p_WI_m;
  Eigen::Vector3d rate_I_rad_s;
  std::size_t node = 0;  ///< index of the first node that is completed after the sample
};

Eigen::Matrix<double, kReported, kStates> output_covariance_rows(const Covariance& P);
Eigen::Matrix<double, kReported, kReported> reported_covariance(const Eigen::Matrix<double, kReported, kStates>& rows);
/// Returns the covariance of the velocity of the sphere's centre in IMU axes. The product of angular velocity error and
/// lever arm is neglected.
Eigen::Matrix3d velocity_covariance_I(const RollingNominalState& nominal, const Eigen::Vector3d& w_WI_I_rad_s,
                                      const Eigen::Matrix<double, kReported, kReported>& reported);

void complete_filter_node(const RollingParams& params, const RollingNodeIntegrals& sums,
                          const Eigen::Vector3d& rate_I_rad_s, const ModePathNode& path, ModePathFilter& filter,
                          FilterNodeRecord& record);

/// Adjoint contains the information that later measurements provide about the error state at a filter step (node).
struct Adjoint {
  Vector adjoint_vector = Vector::Zero();
  Covariance adjoint_matrix = Covariance::Zero();
};

/// FinalSmoothingPass runs a Kalman filter with known contact modes forward, and a smoother backward.
///
/// The backward smoother needs more than 10 KiB per filter step (node), so FinalSmoothingPass processes the nodes in
/// segments. For each segment, FinalSmoothingPass stores only the filter state at the start, and the adjoint variables
/// of the smoother at the end. The backward pass recomputes all other data of a segment, with bit-identical results. If
/// the window has several segments, the filter runs three times: forward, for the backward pass, and for the reported
/// estimates. A FinalSmoothingPass is too large for the stack (four filters of 13 KiB).
class FinalSmoothingPass {
 public:
  static constexpr std::size_t kNodesPerSegment =
      128;  ///< number of filter steps (nodes) per segment; a segment needs 1.6 MiB

  struct Smoothed {
    const SampleMotion& point;
    const RollingNominalState& nominal;
    Reported smoothed_error;
    /// record of the filter step whose covariance applies to the sample; null if the window contains no complete filter
    /// step
    const FilterNodeRecord* node;
    std::size_t index;
  };

  /// All arguments must outlive the FinalSmoothingPass. `segment` is the number of filter steps (nodes) per segment.
  FinalSmoothingPass(const RollingParams& params, std::span<const ImuSample> samples,
                     std::span<const ModePathNode> path, std::size_t segment = kNodesPerSegment);

  /// Filters and smooths all filter steps (nodes). After the call, cut_checkpoint() returns the filter state after the
  /// first `cut` nodes.
  void run_to_cut(const SmoothingCheckpoint& start, std::size_t cut);

  std::size_t nodes() const { return horizontal_variance_m2_.size(); }
  /// smoothed variance of the IMU's horizontal position, per filter step (node)
  std::span<const double> horizontal_variance_m2() const { return horizontal_variance_m2_; }
  const SmoothingCheckpoint& cut_checkpoint() const { return cut_checkpoint_; }
  const ModePathFilter& end_filter() const { return end_checkpoint_.filter; }

  /// Calls `take` in time order with the smoothed estimate of each sample before the filter step (node) `until`.
  void report_smoothed(std::size_t until, const std::function<void(const Smoothed&)>& take);

 private:
  struct SegmentEnds {
    SmoothingCheckpoint start;
    Adjoint end;
  };

  std::size_t first_node_of(std::size_t segment) const { return segment * length_; }
  void filter_forward(std::size_t segment, SmoothingCheckpoint& at);
  void recompute_segment_filter(std::size_t segment);
  void load(std::size_t segment);
  void store_sample_point(TimeNs time_ns, const RollingNominalState& nominal, const Eigen::Vector3d& rate_I_rad_s,
                          std::size_t node);
  void report_smoothed_segment(std::size_t segment, std::size_t until,
                               const std::function<void(const Smoothed&)>& take) const;

  const RollingParams& params_;
  std::span<const ImuSample> samples_;
  std::span<const ModePathNode> mode_path_;
  std::size_t length_;
  std::vector<SegmentEnds> segment_ends_;
  std::vector<double> horizontal_variance_m2_;
  std::size_t cut_node_ = 0;
  SmoothingCheckpoint cut_checkpoint_, end_checkpoint_;
  SmoothingCheckpoint recomputation_checkpoint_;
  Adjoint adjoint_;
  // index of the segment whose filter records are in `node_records_`; each segment consists of `length_` successive
  // filter steps (nodes)
  std::size_t loaded_ = 0;
  std::vector<FilterNodeRecord> node_records_;
  std::vector<SampleMotion> points_;
  Reported smoothed_start_error_ = Reported::Zero();
};

}  // namespace tumble::rolling
