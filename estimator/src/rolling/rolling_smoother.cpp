// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/detail/rolling_smoother.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "last_pass.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

// maximum number of preallocated samples; with a longer lag of the smoother, the memory grows during the run
constexpr std::size_t kPreallocatedMax = 1'000'000;

RollingParams scale_noise(RollingParams params, double share) {
  params.expert.contact.grip_sigma_m_s *= share;
  params.expert.contact.grip_sigma_ratio *= share;
  params.expert.noise.velocity_walk_m_s_sqrts *= share;
  params.expert.noise.rate_error_sqrts *= share;
  return params;
}

RollingMode less_constrained(RollingMode a, RollingMode b) {
  const auto rank = [](RollingMode mode) {
    if (may_slip(mode)) return mode == RollingMode::bump ? 3 : 2;
    return mode == RollingMode::grip ? 0 : 1;
  };
  return rank(a) >= rank(b) ? a : b;
}

bool equal(const ImuSample& a, const ImuSample& b) {
  return a.time_ns == b.time_ns && a.angular_velocity_rad_s == b.angular_velocity_rad_s &&
         a.specific_force_m_s2 == b.specific_force_m_s2;
}

/// Returns the factor from the variance of the final pass, which uses reduced noise, to the reported variance.
double stated(const RollingSmoother::Params& params) {
  return 1.0 / (params.kFinalPassNoiseRatio * params.kFinalPassNoiseRatio);
}

rolling::Readings::Cursor start_cursor(const ImuSample& sample) {
  rolling::Readings::Cursor cursor;
  cursor.time_ns = sample.time_ns;
  cursor.last_rate_rad_s = sample.angular_velocity_rad_s;
  cursor.next = 1;
  return cursor;
}

/// See rolling.md (R40).
Eigen::Matrix<double, 6, 6> pose_covariance(const rolling::NodeRecord& node, const Eigen::Vector3d& arm_W) {
  Eigen::Matrix<double, 6, rolling::kReported> J = Eigen::Matrix<double, 6, rolling::kReported>::Zero();
  J.block<3, 3>(0, 0) = so3::hat(arm_W);
  J.block<3, 3>(0, 6).setIdentity();
  J.block<3, 3>(0, 9) = -node.nominal.q_WI.toRotationMatrix();
  J.block<3, 3>(3, 0).setIdentity();
  return J * node.smoothed_P * J.transpose();
}

/// While the sphere is at rest, the reported position remains constant.
void constrain_position(const rolling::PathNode& node, RollingSmoother::FinalPassState& committed,
                        RollingEstimate& estimate) {
  const bool stands = node.stands && !may_slip(node.mode) && estimate.v_WG_m_s.norm() < rolling::kConstrainSpeed_m_s;
  if (stands && !committed.position_constrained) committed.constrained_p_WG_m = estimate.p_WG_m;
  if (stands) estimate.p_WG_m = committed.constrained_p_WG_m;
  committed.position_constrained = stands;
}

RollingSmoother::EstimateCallback appending(std::vector<RollingEstimate>& out) {
  return [&out](const RollingEstimate& estimate) { out.push_back(estimate); };
}

/// The final pass starts at the last node whose estimates were reported, or at the first sample.
void start_window(const RollingParams& filter, const RollingParams& path, const RollingSmoother::State& state,
                  rolling::LastPass::Checkpoint& start) {
  const RollingSmoother::FinalPassState& last = state.committed;
  start.filter.mode = last.mode;
  if (last.started) {
    start.filter.nominal = last.nominal;
    start.filter.P = last.P;
    start.reading = {last.last_time_ns, last.last_rate_rad_s, 0, last.gap_rate_rad_s, last.gap_start_ns, last.gap_step};
    return;
  }
  const ImuSample& sample = state.samples[0];
  Eigen::Quaterniond q_WI = filter.q_WI_start.value_or(Eigen::Quaterniond::Identity());
  // The filter has already levelled with the force of this sample, so level() cannot fail.
  if (!filter.q_WI_start) (void)level(sample.specific_force_m_s2, q_WI);
  start.filter.nominal = rolling::start_nominal(path, q_WI, sample.angular_velocity_rad_s);
  rolling::set_prior(path, sample.angular_velocity_rad_s, start.filter.P);
  start.reading = start_cursor(sample);
}

struct Events {
  std::vector<bool> uncertain;
  double committed_variance_m2 = 0.0;  ///< event_start_variance_m2 (see FinalPassState) after the node `emitted`
};

Events find_events(const RollingSmoother::Params& params, std::span<const rolling::PathNode> path,
                   std::span<const double> horizontal_variance_m2, std::size_t emitted,
                   const RollingSmoother::FinalPassState& committed) {
  const std::size_t count = horizontal_variance_m2.size();
  Events out;
  out.uncertain.resize(count, false);
  double before_m2 = committed.event_start_variance_m2;
  for (std::size_t a = 0; a < count;) {
    if (!may_slip(path[a].mode)) {
      before_m2 = stated(params) * horizontal_variance_m2[a];
      if (a + 1 == emitted) out.committed_variance_m2 = before_m2;
      ++a;
      continue;
    }
    std::size_t b = a;
    while (b < count && may_slip(path[b].mode)) {
      if (b + 1 == emitted) out.committed_variance_m2 = before_m2;
      ++b;
    }
    const double after_m2 = stated(params) * horizontal_variance_m2[std::min(b, count - 1)];
    const bool grew = after_m2 - before_m2 >
                      params.filter.expert.modes.event_sigma_growth_m * params.filter.expert.modes.event_sigma_growth_m;
    for (std::size_t n = a; n < b; ++n) out.uncertain[n] = grew;
    a = b;
  }
  return out;
}

RollingEstimate estimate_at(const RollingSmoother::Params& params, const rolling::LastPass::Smoothed& at) {
  const rolling::SamplePoint& point = at.point;
  RollingEstimate estimate;
  estimate.time_ns = point.time_ns;
  estimate.q_WI = (so3::exp(at.error.head<3>()) * point.q_WI).normalized();
  const Eigen::Vector3d arm_W =
      estimate.q_WI * (params.filter.lever_arm_m + at.nominal.lever_arm_error_m + at.error.tail<3>());
  estimate.w_WI_I_rad_s = point.rate_I_rad_s - at.nominal.gyro_bias_rad_s;
  const Eigen::Vector3d w_W = estimate.q_WI * estimate.w_WI_I_rad_s;
  estimate.p_WG_m = point.p_WI_m + at.error.segment<3>(6) - arm_W;
  estimate.v_WG_m_s = point.v_WI_m_s + at.error.segment<3>(3) - w_W.cross(arm_W);
  if (at.node == nullptr) return estimate;
  estimate.covariance = stated(params) * pose_covariance(*at.node, arm_W);
  estimate.velocity_covariance_I_m2_s2 =
      stated(params) * rolling::velocity_covariance_I(at.node->nominal, estimate.w_WI_I_rad_s, at.node->smoothed_P);
  estimate.mode = at.node->path.mode;
  estimate.at_rest = at.node->path.at_rest;
  return estimate;
}

}  // namespace

struct RollingSmoother::Path {
  std::vector<rolling::PathNode> nodes;
};

bool RollingSmoother::State::operator==(const State& other) const {
  return live == other.live && committed == other.committed && steps == other.steps && constants == other.constants &&
         radius_sigma_m == other.radius_sigma_m &&
         std::equal(samples.begin(), samples.end(), other.samples.begin(), other.samples.end(), equal);
}

RollingSmoother::RollingSmoother(const Params& p) : params_(p), filter_(p.filter) {
  require_valid_fields(p);
  require_within("lag_s", p.lag_s, p.filter.expert.node_s, kWholeRun);
  final_pass_params_ = scale_noise(p.filter, p.kFinalPassNoiseRatio);
  lag_nodes_ = static_cast<std::size_t>(std::ceil(p.lag_s / p.filter.expert.node_s - 1e-9));
  block_nodes_ = static_cast<std::size_t>(std::ceil(p.kBlock_s / p.filter.expert.node_s - 1e-9));
}

std::size_t RollingSmoother::preallocated_samples() const {
  return static_cast<std::size_t>(std::ceil((params_.lag_s + params_.kBlock_s + 1.0) * params_.rate_max_hz));
}

Status RollingSmoother::step(const ImuSample& sample, State& state, std::vector<RollingEstimate>& out) const {
  if (!state.live.started && params_.lag_s < kWholeRun) {
    state.steps.reserve(std::min(lag_nodes_ + block_nodes_ + 1, kPreallocatedMax));
    state.samples.reserve(std::min(preallocated_samples(), kPreallocatedMax));
  }
  const auto closed = [&steps = state.steps](const RollingFilter::State& live) {
    NodeModes step;
    for (std::size_t k = 0; k < RollingFilter::kHypotheses; ++k) {
      step.parent[k] = static_cast<std::uint8_t>(live.hypotheses[k].parent);
      step.mode[k] = live.hypotheses[k].mode;
    }
    step.position_spread_m2 = live.pruned_position_spread_m2;
    step.rest_s = seconds(live.rest.within_bias_since_ns);
    step.at_rest = live.at_rest;
    step.spins_in_place = live.spins_in_place;
    steps.push_back(step);
  };
  const std::size_t nodes = state.steps.size();
  if (const Status bad = filter_.step(sample, state.live, closed); !bad.ok()) return bad;
  state.samples.push_back(sample);
  const EstimateCallback append = appending(out);
  while (state.steps.size() > nodes && state.steps.size() >= lag_nodes_ + block_nodes_) {
    const std::size_t before = state.steps.size();
    smooth_window(most_probable_path(state), block_nodes_, state, append);
    if (state.steps.size() == before) break;
  }
  return {};
}

void RollingSmoother::finish(State& state, const EstimateCallback& take) const {
  smooth_window(most_probable_path(state), state.steps.size() + 1, state, take);
}

void RollingSmoother::finish(State& state, std::vector<RollingEstimate>& out) const {
  finish(state, appending(out));
}

void RollingSmoother::finish(std::span<const RollingMode> known, State& state, const EstimateCallback& take) const {
  Path path = most_probable_path(state);
  if (state.samples.empty()) return;
  std::size_t n = 0;
  double node_s = 0.0;
  RollingMode mode = RollingMode::grip;
  rolling::Readings readings(params_.filter, state.samples, start_cursor(state.samples.front()));
  rolling::Reading reading;
  while (readings.next(reading) && reading.whole && n < path.nodes.size()) {
    if (node_s >= params_.filter.expert.node_s - 0.5 * reading.average.length_s) {
      path.nodes[n++].mode = less_constrained(mode, known[std::min(reading.first, known.size() - 1)]);
      mode = RollingMode::grip;
      node_s = 0.0;
    }
    for (std::size_t k = reading.first; k < std::min(reading.end, known.size()); ++k)
      mode = less_constrained(mode, known[k]);
    node_s += reading.average.length_s;
  }
  smooth_window(path, path.nodes.size() + 1, state, take);
}

/// Returns the contact modes of the most probable hypothesis, back to the last node whose estimates were reported.
RollingSmoother::Path RollingSmoother::most_probable_path(const State& state) const {
  Path path;
  path.nodes.resize(state.steps.size());
  const double constrain_after_s = std::min(rolling::kConstrainAfter_s, params_.filter.expert.rest.rest_s);
  std::size_t which = 0;
  double lasts_s = 0.0;  // duration of the rest that contains the node
  for (std::size_t n = path.nodes.size(); n-- > 0;) {
    const NodeModes& step = state.steps[n];
    rolling::PathNode& node = path.nodes[n];
    lasts_s = step.rest_s > 0.0 ? std::max(lasts_s, step.rest_s) : 0.0;
    node.stands = lasts_s > 0.0 && lasts_s >= constrain_after_s;
    node.mode = step.mode[which];
    node.at_rest = step.at_rest;
    node.spins_in_place = step.spins_in_place;
    node.position_spread_m2 = step.position_spread_m2;
    which = step.parent[which];
  }
  return path;
}

void RollingSmoother::smooth_window(const Path& path, std::size_t emitted, State& state,
                                    const EstimateCallback& take) const {
  if (state.samples.empty()) return;
  std::optional<rolling::LastPass::Distance> distance;
  if (emitted > path.nodes.size() && params_.known_distance_m > 0.0) {
    distance = {params_.known_distance_m, params_.known_distance_sigma_m};
  }
  const auto owned_pass = std::make_unique<rolling::LastPass>(final_pass_params_, state.samples, path.nodes, distance);
  rolling::LastPass& pass = *owned_pass;
  const auto start = std::make_unique<rolling::LastPass::Checkpoint>();
  start_window(params_.filter, final_pass_params_, state, *start);
  pass.run(*start, emitted);
  state.constants = pass.end().nominal;
  state.radius_sigma_m = std::sqrt(std::max(0.0, pass.end().P(rolling::kRadius, rolling::kRadius)));

  const Events events = find_events(params_, path.nodes, pass.horizontal_variance_m2(), emitted, state.committed);
  pass.give(emitted, [&](const rolling::LastPass::Smoothed& at) {
    RollingEstimate estimate = estimate_at(params_, at);
    if (at.node != nullptr) {
      estimate.uncertain = events.uncertain[at.index];
      if (params_.lag_s < kWholeRun) constrain_position(at.node->path, state.committed, estimate);
    }
    take(estimate);
  });

  if (emitted <= pass.nodes()) {
    const auto& [filter, cursor] = pass.cut();
    FinalPassState& last = state.committed;  // the constant position of the last reported node remains
    last.nominal = filter.nominal;
    last.P = filter.P;
    last.mode = filter.mode;
    last.event_start_variance_m2 = events.committed_variance_m2;
    last.last_time_ns = cursor.time_ns;
    last.last_rate_rad_s = cursor.last_rate_rad_s;
    last.gap_rate_rad_s = cursor.gap_rate_rad_s;
    last.gap_start_ns = cursor.gap_start_ns;
    last.gap_step = cursor.gap_step;
    last.started = true;
    state.samples.erase(state.samples.begin(), state.samples.begin() + static_cast<std::ptrdiff_t>(cursor.next));
    state.steps.erase(state.steps.begin(), state.steps.begin() + static_cast<std::ptrdiff_t>(emitted));
  } else {
    state.committed.gap_step = 0;  // the gap has ended
    state.samples.clear();
    state.steps.clear();
  }
}

}  // namespace tumble
