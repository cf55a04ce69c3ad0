// SPDX-License-Identifier: BSD-3-Clause
#include "last_pass.hpp"

#include <algorithm>

namespace tumble::rolling {

LastPass::LastPass(const RollingParams& params, std::span<const ImuSample> samples, std::span<const PathNode> path,
                   std::optional<Distance> distance, std::size_t segment)
    : params_(params), samples_(samples), path_(path), distance_(distance), length_(segment) {
  kept_.resize(std::max<std::size_t>(1, (path.size() + length_ - 1) / length_));
  records_.reserve(std::min(path.size(), length_));
  horizontal_variance_m2_.reserve(path.size());
}

void LastPass::run(const Checkpoint& start, std::size_t cut) {
  cut_after_ = cut;
  end_ = start;
  std::size_t nodes = 0;
  for (std::size_t segment = 0; segment < kept_.size(); ++segment) {
    kept_[segment].start = end_;
    forward(segment, end_);
    nodes += records_.size();
  }
  horizontal_variance_m2_.resize(nodes);
  for (std::size_t segment = kept_.size(); segment-- > 0;) {
    if (loaded_ != segment) recompute_segment(segment);
    kept_[segment].end = adjoint_;
    backward_pass(adjoint_, records_);
    smoothed_start_ = -output_covariance_rows(kept_[segment].start.filter.P) * adjoint_.lambda;
    for (std::size_t k = 0; k < records_.size(); ++k) {
      const auto& P = records_[k].smoothed_P;
      horizontal_variance_m2_[first_of(segment) + k] = P(kPosition, kPosition) + P(kPosition + 1, kPosition + 1);
    }
  }
}

/// Filters one segment. On return, `at` is the start of the next segment.
void LastPass::forward(std::size_t segment, Checkpoint& at) {
  const std::size_t first = first_of(segment), end = std::min(first + length_, path_.size());
  loaded_ = segment;
  records_.clear();
  points_.clear();
  distance_correction_.setZero();
  auto& [filter, cursor] = at;
  if (segment == 0 && cursor.next == 1) store(cursor.time_ns, filter.nominal, cursor.last_rate_rad_s, 0);
  RollingIntegrals sums;
  Readings readings(params_, samples_, cursor);
  Reading reading;
  while (readings.next(reading)) {
    const ImuAverage& average = reading.average;
    const Eigen::Vector3d& rate = average.mean.angular_velocity_rad_s;
    if (reading.whole && sums.node_s >= params_.expert.node_s - 0.5 * average.length_s &&
        first + records_.size() < end) {
      const PathNode& decided = path_[first + records_.size()];
      NodeRecord& record = records_.emplace_back();
      complete_node(params_, sums, 0.5 * (cursor.last_rate_rad_s + rate), decided, filter, record);
      record.time_ns = cursor.time_ns;
      sums = {};
      if (first + records_.size() == cut_after_) cut_ = at;
      if (first + records_.size() == end && end < path_.size()) return;
    }
    const std::size_t node = first + records_.size();
    if (reading.in_gap) {
      integrate_gap(params_, average, reading.uncertainty, filter.nominal, sums);
      if (reading.end > reading.first) store(reading.end_ns, filter.nominal, rate, node);
    } else {
      ImuAverage so_far;
      TimeNs last_ns = cursor.time_ns;
      for (std::size_t k = reading.first; k < reading.end; ++k) {
        const ImuSample& sample = samples_[k];
        so_far.add(sample, seconds(sample.time_ns - last_ns));
        last_ns = sample.time_ns;
        store(last_ns, extrapolate_nominal(params_, so_far, filter.nominal), so_far.mean.angular_velocity_rad_s, node);
      }
      if (reading.whole) integrate(params_, average, filter.nominal, sums);
    }
    cursor = readings.cursor();
  }
  if (distance_ && !records_.empty()) {
    distance_correction_ =
        measure_distance(params_, distance_->distance_m, distance_->sigma_m, records_.back(), filter);
  }
}

void LastPass::recompute_segment(std::size_t segment) {
  again_ = kept_[segment].start;
  forward(segment, again_);
}

void LastPass::store(TimeNs time_ns, const RollingNominal& nominal, const Eigen::Vector3d& rate_I_rad_s,
                     std::size_t node) {
  points_.push_back({time_ns, nominal.q_WI, nominal.v_WI_m_s, nominal.p_WI_m, rate_I_rad_s, node});
}

void LastPass::load(std::size_t segment) {
  if (loaded_ == segment) return;
  const SegmentEnds& kept = kept_[segment];
  recompute_segment(segment);
  adjoint_ = kept.end;
  backward_pass(adjoint_, records_);
  smoothed_start_ = -output_covariance_rows(kept.start.filter.P) * adjoint_.lambda;
}

void LastPass::give(std::size_t until, const std::function<void(const Smoothed&)>& take) {
  for (std::size_t segment = 0; segment < kept_.size() && first_of(segment) < until; ++segment) {
    load(segment);
    report_segment(segment, until, take);
  }
}

void LastPass::report_segment(std::size_t segment, std::size_t until,
                              const std::function<void(const Smoothed&)>& take) const {
  const std::size_t first = first_of(segment);
  const Checkpoint& start = kept_[segment].start;
  for (const SamplePoint& point : points_) {
    if (point.node >= until) return;
    const std::size_t next = point.node - first;
    const bool inside = next < records_.size(), at_start = next == 0;
    const Reported from = at_start ? smoothed_start_ : records_[next - 1].smoothed;
    Reported error = inside ? from : Reported(from + distance_correction_);
    if (inside) {
      const TimeNs from_ns = at_start ? start.reading.time_ns : records_[next - 1].time_ns;
      const double length_s = seconds(records_[next].time_ns - from_ns);
      const double share = length_s > 0.0 ? seconds(point.time_ns - from_ns) / length_s : 1.0;
      error += share * (error_before_update(records_[next]) - from);
    }
    const std::size_t of = records_.empty() ? 0 : std::min(next, records_.size() - 1);
    const NodeRecord* node = records_.empty() ? nullptr : &records_[of];
    take({point, at_start ? start.filter.nominal : records_[next - 1].nominal, error, node, first + of});
  }
}

}  // namespace tumble::rolling
