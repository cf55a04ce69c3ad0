// SPDX-License-Identifier: BSD-3-Clause
#include "rolling_window.hpp"

#include <algorithm>

#include "../common/dense.hpp"
#include "rolling_node.hpp"
#include "tumble/common/types.hpp"

namespace tumble::rolling {

namespace {

constexpr double kMaxSigmas = 5.0;

/// A residual beyond kMaxSigmas standard deviations has less weight, because a large linear correction would distort
/// the estimates of the whole run: rolling.md (R37).
void update_with_measurement(const Row& H, double measured, double variance, FilterNodeRecord& record, Vector& x,
                             Covariance& P) {
  const auto k = static_cast<std::size_t>(record.measurement_count++);
  const Vector PHt = P * H.transpose();
  record.measurement_rows[k] = H;
  record.innovation[k] = measured - H.dot(x);
  record.variance[k] = std::max(H.dot(PHt) + variance, squared(record.innovation[k] / kMaxSigmas));
  record.gain[k] = PHt / record.variance[k];
  x += record.gain[k] * record.innovation[k];
  P.noalias() -= PHt * record.gain[k].transpose();
}

void update_with_measurement(int index, double measured, double variance, FilterNodeRecord& record, Vector& x,
                             Covariance& P) {
  update_with_measurement(Row(Vector::Unit(index).transpose()), measured, variance, record, x, P);
}

Reported reported_errors(const Vector& x) {
  Reported out;
  out << x.head<9>(), x.segment<3>(kLeverArm);
  return out;
}

/// See rolling.md (R36).
void transform_adjoint(const Vector& turned, Adjoint& adjoint) {
  constexpr int kHeading = kAttitude + 2;
  adjoint.adjoint_vector[kHeading] += turned.dot(adjoint.adjoint_vector);
  adjoint.adjoint_matrix.row(kHeading) += (turned.transpose() * adjoint.adjoint_matrix).eval();
  adjoint.adjoint_matrix.col(kHeading) += (adjoint.adjoint_matrix * turned).eval();
}

/// Returns the smoothed error at a filter step (node), relative to the nominal trajectory before the update of the
/// filter step.
Reported error_before_update(const FilterNodeRecord& node) {
  const Reported error = node.smoothed + node.correction;
  return node.heading_lost ? Reported(error - node.smoothed[kAttitude + 2] * reported_errors(node.heading_correction))
                           : error;
}

/// Smooths the states of consecutive filter steps (nodes) by the modified Bryson-Frazier smoother. On entry, `adjoint`
/// contains the information from all measurements after the last node. On return, `adjoint` also contains the
/// information from the measurements at `nodes`.
/// See rolling.md (R38), (R39).
void backward_pass(Adjoint& adjoint, std::span<FilterNodeRecord> nodes) {
  auto& [adjoint_vector, adjoint_matrix] = adjoint;
  for (std::size_t n = nodes.size(); n-- > 0;) {
    FilterNodeRecord& node = nodes[n];
    node.smoothed = -node.covariance_rows * adjoint_vector;
    node.smoothed_covariance = reported_covariance(node.covariance_rows) -
                               node.covariance_rows * adjoint_matrix * node.covariance_rows.transpose();
    if (node.heading_lost) transform_adjoint(node.heading_correction, adjoint);
    for (std::size_t k = static_cast<std::size_t>(node.measurement_count); k-- > 0;) {
      const Row& H = node.measurement_rows[k];
      const Vector& K = node.gain[k];
      const Vector through = adjoint_matrix * K;
      adjoint_vector -= H.transpose() * (K.dot(adjoint_vector) + node.innovation[k] / node.variance[k]);
      const Row seen = H * (K.dot(through) + 1.0 / node.variance[k]);
      adjoint_matrix += H.transpose().lazyProduct(seen) - H.transpose().lazyProduct(through.transpose()) -
                        through.lazyProduct(H);  // lazyProduct() avoids a temporary matrix of 13 KiB per measurement
    }
    if (node.resets_floor_slope) {
      adjoint_vector.segment<2>(kSlope).setZero();
      adjoint_matrix.middleRows<2>(kSlope).setZero();
      adjoint_matrix.middleCols<2>(kSlope).setZero();
    }
    if (node.tilt_reset) {
      adjoint_vector.head<6>().setZero();
      adjoint_matrix.topRows<6>().setZero();
      adjoint_matrix.leftCols<6>().setZero();
    }
    adjoint_vector += (node.moving_jacobian.transpose() * adjoint_vector.head<9>()).eval();
    adjoint_matrix += (node.moving_jacobian.transpose() * adjoint_matrix.topRows<9>()).eval();
    adjoint_matrix += (adjoint_matrix.leftCols<9>() * node.moving_jacobian).eval();
  }
}

}  // namespace

void RollingReadings::next_gap_step(double gap_s, RollingReading& out) {
  const ImuSample& after = samples_[cursor_.next];
  ImuSample before;
  before.angular_velocity_rad_s = cursor_.rate_before_gap_rad_s;
  const int pieces = gap_step_count(params_, gap_s);
  out.sample = gap_step_sample(params_, before, after, gap_s, cursor_.gap_step_index, out.uncertainty);
  out.length_s = gap_s / pieces;
  out.in_gap = true;
  ++cursor_.gap_step_index;
  out.ends_at_sample = cursor_.gap_step_index == pieces;
  const double share = static_cast<double>(cursor_.gap_step_index) / pieces;
  out.end_ns = out.ends_at_sample ? after.time_ns : cursor_.gap_start_ns + static_cast<TimeNs>(share * gap_s * 1e9);
}

bool RollingReadings::next(RollingReading& out) {
  out = {};
  if (cursor_.next >= samples_.size()) return false;
  const ImuSample& sample = samples_[cursor_.next];
  const bool in_gap = cursor_.gap_step_index > 0;
  const double dt_s = seconds(sample.time_ns - (in_gap ? cursor_.gap_start_ns : cursor_.time_ns));
  if (in_gap || dt_s > RollingGapParams::kGapMinDuration_s) {
    if (!in_gap) {
      cursor_.rate_before_gap_rad_s = cursor_.last_rate_rad_s;
      cursor_.gap_start_ns = cursor_.time_ns;
    }
    next_gap_step(dt_s, out);
  } else {
    out.sample = sample;
    out.length_s = dt_s;
    out.end_ns = sample.time_ns;
  }
  if (out.ends_at_sample) {
    cursor_.gap_step_index = 0;
    ++cursor_.next;
  }
  cursor_.time_ns = out.end_ns;
  cursor_.last_rate_rad_s = out.sample.angular_velocity_rad_s;
  return true;
}

Eigen::Matrix<double, kReported, kStates> output_covariance_rows(const Covariance& P) {
  Eigen::Matrix<double, kReported, kStates> out;
  out << P.topRows<9>(), P.middleRows<3>(kLeverArm);
  return out;
}

Eigen::Matrix<double, kReported, kReported> reported_covariance(const Eigen::Matrix<double, kReported, kStates>& rows) {
  Eigen::Matrix<double, kReported, kReported> out;
  out << rows.leftCols<9>(), rows.middleCols<3>(kLeverArm);
  return out;
}

Eigen::Matrix3d velocity_covariance_I(const RollingNominalState& nominal, const Eigen::Vector3d& w_WI_I_rad_s,
                                      const Eigen::Matrix<double, kReported, kReported>& reported) {
  const Eigen::Matrix3d R_IW = nominal.q_WI.toRotationMatrix().transpose();
  Eigen::Matrix<double, 3, kReported> J;
  J << R_IW * so3::hat(nominal.v_WI_m_s), R_IW, Eigen::Matrix3d::Zero(), -so3::hat(w_WI_I_rad_s);
  return J * reported * J.transpose();
}

void complete_filter_node(const RollingParams& params, const RollingNodeIntegrals& sums,
                          const Eigen::Vector3d& rate_I_rad_s, const ModePathNode& path, ModePathFilter& filter,
                          FilterNodeRecord& record) {
  record.mode_path_node = path;
  record.moving_jacobian = transition(sums);
  Vector x = Vector::Zero();
  constexpr double kNoiseRatio = RollingSmoother::Params::kFinalPassNoiseRatio;
  predict(params, sums, record.moving_jacobian, x, filter.covariance, kNoiseRatio);
  record.tilt_reset = reset_tilt(params, sums, path.at_rest, filter.nominal, filter.covariance);
  record.resets_floor_slope = resets_floor_slope(filter.mode, path.mode);
  update_slope_for_mode(filter.mode, path.mode, sums.node_interval_s, filter.nominal, x, filter.covariance);
  record.heading_lost = heading_lost(filter.covariance);
  const auto take = [&](const auto& row, double measured, double variance) {
    update_with_measurement(row, measured, variance, record, x, filter.covariance);
  };
  if (path.at_rest) {
    stationary_measurement_rows(sums, filter.nominal, path.spins_in_place, take);
  } else {
    Contact c = contact(params, filter.nominal, rate_I_rad_s, sums, kNoiseRatio);
    if (record.heading_lost) remove_heading_component(c);
    contact_measurement_rows(c, path.mode, sums.node_interval_s, filter.nominal.v_WI_m_s, x, filter.covariance, take);
  }
  make_symmetric(filter.covariance);
  filter.covariance.block<3, 3>(kPosition, kPosition) += path.position_spread_m2;
  move_linearisation_point(x, filter.nominal);
  if (record.heading_lost) {
    record.heading_correction = heading_component(x);
    remove_heading_covariance(record.heading_correction, filter.covariance);
  }
  filter.mode = path.mode;
  record.correction = reported_errors(x);
  record.covariance_rows = output_covariance_rows(filter.covariance);
  record.nominal = filter.nominal;
}

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
