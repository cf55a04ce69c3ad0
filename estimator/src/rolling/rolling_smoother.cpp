// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/detail/rolling_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "rolling_window.hpp"
#include "tumble/attitude/detail/strapdown.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

namespace {

// maximum number of preallocated samples; if the lag of the smoother is longer, the memory grows during the run
constexpr std::size_t kPreallocatedMax = 1'000'000;

/// Returns a factor for the variances of the final smoothing pass. The final smoothing pass assumes reduced noise, so
/// the factor increases the variances to the reported variances.
double stated_distance_sigma(const RollingSmoother::Params& params) {
  return 1.0 / (params.kFinalPassNoiseRatio * params.kFinalPassNoiseRatio);
}

rolling::ReadingCursor start_cursor(const ImuSample& sample) {
  rolling::ReadingCursor cursor;
  cursor.time_ns = sample.time_ns;
  cursor.last_rate_rad_s = sample.angular_velocity_rad_s;
  cursor.next = 1;
  return cursor;
}

/// See rolling.md (R40).
Eigen::Matrix<double, 6, 6> pose_covariance(const rolling::FilterNodeRecord& node, const Eigen::Vector3d& arm_W) {
  Eigen::Matrix<double, 6, rolling::kReported> J = Eigen::Matrix<double, 6, rolling::kReported>::Zero();
  J.block<3, 3>(0, 0) = so3::hat(arm_W);
  J.block<3, 3>(0, 6).setIdentity();
  J.block<3, 3>(0, 9) = -node.nominal.q_WI.toRotationMatrix();
  J.block<3, 3>(3, 0).setIdentity();
  return J * node.smoothed_covariance * J.transpose();
}

/// While the sphere is at rest, the smoother keeps the reported position constant.
void keep_position_at_rest(const rolling::ModePathNode& node, RollingSmoother::FinalSmoothingState& committed,
                           RollingEstimate& estimate) {
  const bool stands = node.holds_constant_position && !may_slip(node.mode) &&
                      estimate.sphere_velocity_W_m_s.norm() < rolling::kConstrainSpeed_m_s;
  if (stands && !committed.reported_position_constant)
    committed.constrained_sphere_centre_W_m = estimate.sphere_centre_W_m;
  if (stands) estimate.sphere_centre_W_m = committed.constrained_sphere_centre_W_m;
  committed.reported_position_constant = stands;
}

RollingSmoother::EstimateCallback append_estimates_to(std::vector<RollingEstimate>& out) {
  return [&out](const RollingEstimate& estimate) { out.push_back(estimate); };
}

/// The final smoothing pass starts at the last filter step with reported estimates, or at the first sample if no
/// estimate has been reported.
void start_window(const RollingParams& filter, const RollingSmoother::State& state,
                  rolling::SmoothingCheckpoint& start) {
  start = state.committed_state.checkpoint;
  if (state.committed_state.started) return;
  const ImuSample& sample = state.samples[0];
  Eigen::Quaterniond q_WI = filter.q_WI_start.value_or(Eigen::Quaterniond::Identity());
  // When the live filter started, inclination_from_force() succeeded for this sample, so the returned status is
  // ignored.
  if (!filter.q_WI_start) (void)inclination_from_force(sample.specific_force_m_s2, q_WI);
  start.filter.nominal = rolling::start_nominal(filter, q_WI, sample.angular_velocity_rad_s);
  rolling::set_prior(filter, sample.angular_velocity_rad_s, start.filter.covariance);
  start.reading = start_cursor(sample);
}

struct SlipAndBumpEvents {
  std::vector<bool> uncertain;
  double committed_position_variance_m2 =
      0.0;  ///< value of FinalSmoothingState::slip_start_variance_m2 after the last reported node
};

SlipAndBumpEvents find_slip_and_bump_events(const RollingSmoother::Params& params,
                                            std::span<const rolling::ModePathNode> path,
                                            std::span<const double> horizontal_variance_m2, std::size_t emitted,
                                            const RollingSmoother::FinalSmoothingState& committed) {
  const std::size_t count = horizontal_variance_m2.size();
  SlipAndBumpEvents out;
  out.uncertain.resize(count, false);
  double before_m2 = committed.slip_start_variance_m2;
  for (std::size_t a = 0; a < count;) {
    if (!may_slip(path[a].mode)) {
      before_m2 = stated_distance_sigma(params) * horizontal_variance_m2[a];
      if (a + 1 == emitted) out.committed_position_variance_m2 = before_m2;
      ++a;
      continue;
    }
    std::size_t b = a;
    while (b < count && may_slip(path[b].mode)) {
      if (b + 1 == emitted) out.committed_position_variance_m2 = before_m2;
      ++b;
    }
    const double after_m2 = stated_distance_sigma(params) * horizontal_variance_m2[std::min(b, count - 1)];
    const bool grew =
        after_m2 - before_m2 > ContactModeParams::kEventSigmaGrowth_m * ContactModeParams::kEventSigmaGrowth_m;
    for (std::size_t n = a; n < b; ++n) out.uncertain[n] = grew;
    a = b;
  }
  return out;
}

RollingEstimate estimate_at(const RollingSmoother::Params& params, const rolling::FinalSmoothingPass::Smoothed& at) {
  const rolling::SampleMotion& point = at.point;
  RollingEstimate estimate;
  estimate.time_ns = point.time_ns;
  estimate.q_WI = (so3::exp(at.smoothed_error.head<3>()) * point.q_WI).normalized();
  const Eigen::Vector3d arm_W =
      estimate.q_WI * (params.filter.lever_arm_m + at.nominal.lever_arm_error_m + at.smoothed_error.tail<3>());
  estimate.w_WI_I_rad_s = point.rate_I_rad_s - at.nominal.gyro_bias_rad_s;
  const Eigen::Vector3d w_W = estimate.q_WI * estimate.w_WI_I_rad_s;
  estimate.sphere_centre_W_m = point.p_WI_m + at.smoothed_error.segment<3>(6) - arm_W;
  estimate.sphere_velocity_W_m_s = point.v_WI_m_s + at.smoothed_error.segment<3>(3) - w_W.cross(arm_W);
  if (at.node == nullptr) return estimate;
  estimate.covariance = stated_distance_sigma(params) * pose_covariance(*at.node, arm_W);
  estimate.velocity_covariance_I_m2_s2 =
      stated_distance_sigma(params) *
      rolling::velocity_covariance_I(at.node->nominal, estimate.w_WI_I_rad_s, at.node->smoothed_covariance);
  estimate.mode = at.node->mode_path_node.mode;
  estimate.at_rest = at.node->mode_path_node.at_rest;
  return estimate;
}

}  // namespace

RollingSmoother::RollingSmoother(const Params& p) : params_(p), filter_(p.filter) {
  require_valid_fields(p);
  require_in_interval("lag_s", p.lag_s, p.filter.expert.kNode_s, kWholeRecordingLag);
  lag_nodes_ = static_cast<std::size_t>(std::ceil(p.lag_s / p.filter.expert.kNode_s - 1e-9));
  nodes_per_block_ = static_cast<std::size_t>(std::ceil(p.kBlock_s / p.filter.expert.kNode_s - 1e-9));
}

std::size_t RollingSmoother::preallocated_samples() const {
  return static_cast<std::size_t>(std::ceil((params_.lag_s + params_.kBlock_s + 1.0) * params_.rate_max_hz));
}

Status RollingSmoother::step(const ImuSample& sample, State& state, std::vector<RollingEstimate>& out) const {
  if (!state.live_filter.started && params_.lag_s < kWholeRecordingLag) {
    state.node_modes.reserve(std::min(lag_nodes_ + nodes_per_block_ + 1, kPreallocatedMax));
    state.samples.reserve(std::min(preallocated_samples(), kPreallocatedMax));
  }
  const auto closed = [&steps = state.node_modes](const RollingFilter::State& live) {
    NodeModes step;
    for (std::size_t k = 0; k < RollingFilter::kHypotheses; ++k) {
      step.parent[k] = static_cast<std::uint8_t>(live.hypotheses[k].parent);
      step.mode[k] = live.hypotheses[k].mode;
    }
    step.position_spread_m2 = live.pruned_position_covariance_m2;
    step.rest_s = seconds(live.stationary_state.small_rate_since_ns);
    step.at_rest = live.at_rest;
    step.spins_in_place = live.spins_in_place;
    steps.push_back(step);
  };
  const std::size_t nodes = state.node_modes.size();
  if (const Status bad = filter_.step(sample, state.live_filter, closed); !bad.ok()) return bad;
  state.samples.push_back(sample);
  const EstimateCallback append = append_estimates_to(out);
  while (state.node_modes.size() > nodes && state.node_modes.size() >= lag_nodes_ + nodes_per_block_) {
    const std::size_t before = state.node_modes.size();
    smooth_window(most_probable_path(state), nodes_per_block_, state, append);
    if (state.node_modes.size() == before) break;
  }
  return {};
}

void RollingSmoother::finish(State& state, const EstimateCallback& take) const {
  smooth_window(most_probable_path(state), state.node_modes.size() + 1, state, take);
}

void RollingSmoother::finish(State& state, std::vector<RollingEstimate>& out) const {
  finish(state, append_estimates_to(out));
}

/// Returns the contact modes of the most probable hypothesis, back to the last filter step (node) with reported
/// estimates.
RollingSmoother::ModePath RollingSmoother::most_probable_path(const State& state) const {
  ModePath path(state.node_modes.size());
  const double constrain_after_s = std::min(rolling::kConstrainAfter_s, params_.filter.expert.rest_detector.rest_s);
  std::size_t which = 0;
  double lasts_s = 0.0;  // duration of the rest period that contains the node
  for (std::size_t n = path.size(); n-- > 0;) {
    const NodeModes& step = state.node_modes[n];
    rolling::ModePathNode& node = path[n];
    lasts_s = step.rest_s > 0.0 ? std::max(lasts_s, step.rest_s) : 0.0;
    node.holds_constant_position = lasts_s > 0.0 && lasts_s >= constrain_after_s;
    node.mode = step.mode[which];
    node.at_rest = step.at_rest;
    node.spins_in_place = step.spins_in_place;
    node.position_spread_m2 = step.position_spread_m2;
    which = step.parent[which];
  }
  return path;
}

void RollingSmoother::smooth_window(const ModePath& path, std::size_t emitted, State& state,
                                    const EstimateCallback& take) const {
  if (state.samples.empty()) return;
  const auto owned_pass = std::make_unique<rolling::FinalSmoothingPass>(params_.filter, state.samples, path);
  rolling::FinalSmoothingPass& pass = *owned_pass;
  const auto start = std::make_unique<rolling::SmoothingCheckpoint>();
  start_window(params_.filter, state, *start);
  pass.run_to_cut(*start, emitted);
  state.constants = pass.end_filter().nominal;
  state.radius_sigma_m = std::sqrt(std::max(0.0, pass.end_filter().covariance(rolling::kRadius, rolling::kRadius)));

  const SlipAndBumpEvents events =
      find_slip_and_bump_events(params_, path, pass.horizontal_variance_m2(), emitted, state.committed_state);
  pass.report_smoothed(emitted, [&](const rolling::FinalSmoothingPass::Smoothed& at) {
    RollingEstimate estimate = estimate_at(params_, at);
    if (at.node != nullptr) {
      estimate.position_uncertain = events.uncertain[at.index];
      if (params_.lag_s < kWholeRecordingLag)
        keep_position_at_rest(at.node->mode_path_node, state.committed_state, estimate);
    }
    take(estimate);
  });

  if (emitted <= pass.nodes()) {
    FinalSmoothingState& last = state.committed_state;  // keeps the constrained position of the last reported node
    last.checkpoint = pass.cut_checkpoint();
    const std::size_t used = std::exchange(last.checkpoint.reading.next, 0);
    last.slip_start_variance_m2 = events.committed_position_variance_m2;
    last.started = true;
    state.samples.erase(state.samples.begin(), state.samples.begin() + static_cast<std::ptrdiff_t>(used));
    state.node_modes.erase(state.node_modes.begin(), state.node_modes.begin() + static_cast<std::ptrdiff_t>(emitted));
  } else {
    state.committed_state.checkpoint.reading.gap_step_index = 0;  // the data gap has ended
    state.samples.clear();
    state.node_modes.clear();
  }
}

}  // namespace tumble
