// SPDX-License-Identifier: BSD-3-Clause
#include "last_pass.hpp"

#include <algorithm>

namespace tumble::rolling {

FinalSmoothingPass::FinalSmoothingPass(const RollingParams& params, std::span<const ImuSample> samples,
                                       std::span<const ModePathNode> path, std::size_t segment)
    : params_(params), samples_(samples), mode_path_(path), length_(segment) {
  segment_ends_.resize(std::max<std::size_t>(1, (path.size() + length_ - 1) / length_));
  node_records_.reserve(std::min(path.size(), length_));
  horizontal_variance_m2_.reserve(path.size());
}

void FinalSmoothingPass::run_to_cut(const SmoothingCheckpoint& start, std::size_t cut) {
  cut_node_ = cut;
  end_checkpoint_ = start;
  std::size_t nodes = 0;
  for (std::size_t segment = 0; segment < segment_ends_.size(); ++segment) {
    segment_ends_[segment].start = end_checkpoint_;
    filter_forward(segment, end_checkpoint_);
    nodes += node_records_.size();
  }
  horizontal_variance_m2_.resize(nodes);
  for (std::size_t segment = segment_ends_.size(); segment-- > 0;) {
    if (loaded_ != segment) recompute_segment_filter(segment);
    segment_ends_[segment].end = adjoint_;
    backward_pass(adjoint_, node_records_);
    smoothed_start_error_ =
        -output_covariance_rows(segment_ends_[segment].start.filter.covariance) * adjoint_.adjoint_vector;
    for (std::size_t k = 0; k < node_records_.size(); ++k) {
      const auto& P = node_records_[k].smoothed_covariance;
      horizontal_variance_m2_[first_node_of(segment) + k] = P(kPosition, kPosition) + P(kPosition + 1, kPosition + 1);
    }
  }
}

/// On entry, `at` is the filter state at the start of the segment. On return, `at` is the filter state at the start of
/// the next segment.
void FinalSmoothingPass::filter_forward(std::size_t segment, SmoothingCheckpoint& at) {
  const std::size_t first = first_node_of(segment), end = std::min(first + length_, mode_path_.size());
  loaded_ = segment;
  node_records_.clear();
  points_.clear();
  auto& [filter, cursor] = at;
  if (segment == 0 && cursor.next == 1) store_sample_point(cursor.time_ns, filter.nominal, cursor.last_rate_rad_s, 0);
  RollingNodeIntegrals sums;
  RollingReadings readings(params_, samples_, cursor);
  RollingReading reading;
  while (readings.next(reading)) {
    const Eigen::Vector3d& rate = reading.sample.angular_velocity_rad_s;
    if (sums.node_interval_s >= params_.expert.kNode_s - 0.5 * reading.length_s && first + node_records_.size() < end) {
      const ModePathNode& decided = mode_path_[first + node_records_.size()];
      FilterNodeRecord& record = node_records_.emplace_back();
      complete_filter_node(params_, sums, 0.5 * (cursor.last_rate_rad_s + rate), decided, filter, record);
      record.time_ns = cursor.time_ns;
      sums = {};
      if (first + node_records_.size() == cut_node_) cut_checkpoint_ = at;
      if (first + node_records_.size() == end && end < mode_path_.size()) return;
    }
    const std::size_t node = first + node_records_.size();
    if (reading.in_gap) {
      integrate_gap(params_, reading.sample, reading.length_s, reading.uncertainty, filter.nominal, sums);
    } else {
      integrate(params_, reading.sample, reading.length_s, filter.nominal, sums);
    }
    if (reading.ends_at_sample) store_sample_point(reading.end_ns, filter.nominal, rate, node);
    cursor = readings.cursor();
  }
}

void FinalSmoothingPass::recompute_segment_filter(std::size_t segment) {
  recomputation_checkpoint_ = segment_ends_[segment].start;
  filter_forward(segment, recomputation_checkpoint_);
}

void FinalSmoothingPass::store_sample_point(TimeNs time_ns, const RollingNominalState& nominal,
                                            const Eigen::Vector3d& rate_I_rad_s, std::size_t node) {
  points_.push_back({time_ns, nominal.q_WI, nominal.v_WI_m_s, nominal.p_WI_m, rate_I_rad_s, node});
}

void FinalSmoothingPass::load(std::size_t segment) {
  if (loaded_ == segment) return;
  const SegmentEnds& kept = segment_ends_[segment];
  recompute_segment_filter(segment);
  adjoint_ = kept.end;
  backward_pass(adjoint_, node_records_);
  smoothed_start_error_ = -output_covariance_rows(kept.start.filter.covariance) * adjoint_.adjoint_vector;
}

void FinalSmoothingPass::report_smoothed(std::size_t until, const std::function<void(const Smoothed&)>& take) {
  for (std::size_t segment = 0; segment < segment_ends_.size() && first_node_of(segment) < until; ++segment) {
    load(segment);
    report_smoothed_segment(segment, until, take);
  }
}

void FinalSmoothingPass::report_smoothed_segment(std::size_t segment, std::size_t until,
                                                 const std::function<void(const Smoothed&)>& take) const {
  const std::size_t first = first_node_of(segment);
  const SmoothingCheckpoint& start = segment_ends_[segment].start;
  for (const SampleMotion& point : points_) {
    if (point.node >= until) return;
    const std::size_t next = point.node - first;
    const bool inside = next < node_records_.size(), at_start = next == 0;
    const Reported from = at_start ? smoothed_start_error_ : node_records_[next - 1].smoothed;
    Reported error = from;
    if (inside) {
      const TimeNs from_ns = at_start ? start.reading.time_ns : node_records_[next - 1].time_ns;
      const double length_s = seconds(node_records_[next].time_ns - from_ns);
      const double share = length_s > 0.0 ? seconds(point.time_ns - from_ns) / length_s : 1.0;
      error += share * (error_before_update(node_records_[next]) - from);
    }
    const std::size_t of = node_records_.empty() ? 0 : std::min(next, node_records_.size() - 1);
    const FilterNodeRecord* node = node_records_.empty() ? nullptr : &node_records_[of];
    take({point, at_start ? start.filter.nominal : node_records_[next - 1].nominal, error, node, first + of});
  }
}

}  // namespace tumble::rolling
