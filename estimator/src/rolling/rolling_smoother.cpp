// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/rolling/rolling_smoother.hpp"

#include <algorithm>
#include <cmath>

#include "rolling_window.hpp"
#include "tumble/attitude/strapdown.hpp"
#include "tumble/common/so3.hpp"

namespace tumble {

namespace {

RollingParams quieter(RollingParams params, double share) {
  params.grip_sigma_m_s *= share;
  params.grip_sigma_share *= share;
  params.velocity_walk_m_s_sqrts *= share;
  params.rate_error_sqrts *= share;
  return params;
}

/// The one of two modes that says less about the contact.
RollingMode looser(RollingMode a, RollingMode b) {
  const auto rank = [](RollingMode mode) {
    if (slips(mode)) return mode == RollingMode::bump ? 3 : 2;
    return mode == RollingMode::grip ? 0 : 1;
  };
  return rank(a) >= rank(b) ? a : b;
}

bool equal(const ImuSample& a, const ImuSample& b) {
  return a.time_ns == b.time_ns && a.angular_velocity_rad_s == b.angular_velocity_rad_s &&
         a.specific_force_m_s2 == b.specific_force_m_s2;
}

/// The last pass is quieter than it believes, for the estimate's sake; what it states of itself is not.
double stated(const RollingSmoother::Params& params) {
  return 1.0 / (params.path_noise * params.path_noise);
}

/// After the first sample.
rolling::Readings::Place start_place(const ImuSample& sample) {
  rolling::Readings::Place place;
  place.time_ns = sample.time_ns;
  place.last_rate_rad_s = sample.angular_velocity_rad_s;
  place.next = 1;
  return place;
}

double horizontal_variance(const RollingSmoother::Params& params, const rolling::NodeRecord& node) {
  return stated(params) * (node.smoothed_P(6, 6) + node.smoothed_P(7, 7));
}

/// Covariance of (centre, attitude) from that of the reported states: rolling.md (R35).
Eigen::Matrix<double, 6, 6> pose_covariance(const rolling::NodeRecord& node, const Eigen::Vector3d& arm_W) {
  Eigen::Matrix<double, 6, rolling::kReported> J = Eigen::Matrix<double, 6, rolling::kReported>::Zero();
  J.block<3, 3>(0, 0) = so3::hat(arm_W);
  J.block<3, 3>(0, 6).setIdentity();
  J.block<3, 3>(0, 9) = -node.nominal.q_WI.toRotationMatrix();
  J.block<3, 3>(3, 0).setIdentity();
  return J * node.smoothed_P * J.transpose();
}

/// The position that is given out stands still while the sphere does.
void hold(const rolling::PathNode& node, RollingSmoother::Committed& committed, RollingEstimate& estimate) {
  const bool stands = node.stands && !slips(node.mode) && estimate.v_WG_m_s.norm() < rolling::kHeldSpeed_m_s;
  if (stands && !committed.held) committed.held_p_WG_m = estimate.p_WG_m;
  if (stands) estimate.p_WG_m = committed.held_p_WG_m;
  committed.held = stands;
}

}  // namespace

struct RollingSmoother::PathNode : rolling::PathNode {};

/// The last pass over the stored samples.
struct RollingSmoother::Window {
  rolling::PathFilter start;
  std::vector<rolling::NodeRecord> nodes;
  std::vector<rolling::SamplePoint> points;
  rolling::Reported smoothed_start;
  // at the end of the block that is given out
  rolling::PathFilter committed;
};

bool RollingSmoother::State::operator==(const State& other) const {
  return live == other.live && committed == other.committed && steps == other.steps && learnt == other.learnt &&
         radius_sigma_m == other.radius_sigma_m &&
         std::equal(samples.begin(), samples.end(), other.samples.begin(), other.samples.end(), equal);
}

RollingSmoother::RollingSmoother(const Params& p) : params_(p), filter_(p.filter) {
  require_fields(p);
  require_within("lag_s", p.lag_s, p.filter.node_s, kWholeRun);
  require_within("block_s", p.block_s, p.filter.node_s, 1e3);
  path_params_ = quieter(p.filter, p.path_noise);
  lag_nodes_ = static_cast<std::size_t>(std::ceil(p.lag_s / p.filter.node_s - 1e-9));
  block_nodes_ = static_cast<std::size_t>(std::ceil(p.block_s / p.filter.node_s - 1e-9));
}

Status RollingSmoother::step(const ImuSample& sample, State& state, std::vector<RollingEstimate>& out) const {
  if (!state.live.started && params_.lag_s < kWholeRun) {
    state.steps.reserve(lag_nodes_ + block_nodes_ + 1);
    state.samples.reserve(
        static_cast<std::size_t>(std::ceil((params_.lag_s + params_.block_s + 1.0) * params_.rate_max_hz)));
  }
  const auto closed = [&steps = state.steps](const RollingFilter::State& live) {
    Step step;
    for (std::size_t k = 0; k < RollingFilter::kHypotheses; ++k) {
      step.parent[k] = static_cast<std::uint8_t>(live.hypotheses[k].parent);
      step.mode[k] = live.hypotheses[k].mode;
    }
    step.spread_m2 = live.pruned_spread_m2;
    step.rest_s = live.rest_s;
    step.at_rest = live.at_rest;
    step.spins_in_place = live.spins_in_place;
    steps.push_back(step);
  };
  const std::size_t nodes = state.steps.size();
  if (const Status bad = filter_.step(sample, state.live, closed); !bad.ok()) return bad;
  state.samples.push_back(sample);
  while (state.steps.size() > nodes && state.steps.size() >= lag_nodes_ + block_nodes_) {
    const std::size_t before = state.steps.size();
    run_window(best_path(state), block_nodes_, state, out);
    if (state.steps.size() == before) break;
  }
  return {};
}

void RollingSmoother::finish(State& state, std::vector<RollingEstimate>& out) const {
  run_window(best_path(state), state.steps.size() + 1, state, out);
}

void RollingSmoother::finish(std::span<const RollingMode> known, State& state,
                             std::vector<RollingEstimate>& out) const {
  std::vector<PathNode> path = best_path(state);
  if (state.samples.empty()) return;
  std::size_t n = 0;
  double node_s = 0.0;
  RollingMode mode = RollingMode::grip;
  rolling::Readings readings(params_.filter, state.samples, start_place(state.samples.front()));
  rolling::Reading reading;
  while (readings.next(reading) && reading.whole && n < path.size()) {
    if (node_s >= params_.filter.node_s - 0.5 * reading.average.length_s) {
      path[n++].mode = looser(mode, known[std::min(reading.first, known.size() - 1)]);
      mode = RollingMode::grip;
      node_s = 0.0;
    }
    for (std::size_t k = reading.first; k < std::min(reading.end, known.size()); ++k) mode = looser(mode, known[k]);
    node_s += reading.average.length_s;
  }
  run_window(path, path.size() + 1, state, out);
}

/// Modes of the hypothesis that is best now, back to the committed node.
std::vector<RollingSmoother::PathNode> RollingSmoother::best_path(const State& state) const {
  std::vector<PathNode> path(state.steps.size());
  const double stands_after_s = std::min(rolling::kHeldAfter_s, params_.filter.rest_time_s);
  std::size_t which = 0;
  double lasts_s = 0.0;  // of the quiet that a node lies in
  for (std::size_t n = path.size(); n-- > 0;) {
    const Step& step = state.steps[n];
    lasts_s = step.rest_s > 0.0 ? std::max(lasts_s, step.rest_s) : 0.0;
    path[n].stands = lasts_s > 0.0 && lasts_s >= stands_after_s;
    path[n].mode = step.mode[which];
    path[n].at_rest = step.at_rest;
    path[n].spins_in_place = step.spins_in_place;
    path[n].spread_m2 = step.spread_m2;
    which = step.parent[which];
  }
  return path;
}

void RollingSmoother::run_window(const std::vector<PathNode>& path, std::size_t emitted, State& state,
                                 std::vector<RollingEstimate>& out) const {
  if (state.samples.empty()) return;
  Window window;
  window.nodes.reserve(path.size());
  window.points.reserve(state.samples.size());
  rolling::PathFilter& filter = window.start;
  filter = {state.committed.nominal, state.committed.P, state.committed.mode};
  const Committed& last = state.committed;
  rolling::Readings::Place place{last.last_time_ns,   last.last_rate_rad_s, 0,
                                 last.gap_rate_rad_s, last.gap_start_ns,    last.gap_piece};
  if (!last.started) {
    const ImuSample& sample = state.samples[0];
    Eigen::Quaterniond q_WI = params_.filter.q_WI_start.value_or(Eigen::Quaterniond::Identity());
    if (!params_.filter.q_WI_start) (void)level(sample.specific_force_m_s2, q_WI);  // went well in the filter
    filter.nominal = rolling::start_nominal(path_params_, q_WI, sample.angular_velocity_rad_s);
    filter.P = rolling::prior_covariance(path_params_, sample.angular_velocity_rad_s);
    place = start_place(sample);
  }
  const rolling::PathFilter start = filter;
  const TimeNs start_ns = place.time_ns;
  std::size_t taken = state.samples.size();  // samples up to the node that becomes the committed one
  rolling::Readings::Place committed_place = place;
  const auto remember = [&](TimeNs time_ns, const RollingNominal& nominal, const Eigen::Vector3d& rate_I_rad_s) {
    window.points.push_back(
        {time_ns, nominal.q_WI, nominal.v_WI_m_s, nominal.p_WI_m, rate_I_rad_s, window.nodes.size()});
  };
  if (place.next == 1) remember(place.time_ns, filter.nominal, place.last_rate_rad_s);
  RollingSums sums;
  rolling::Readings readings(path_params_, state.samples, place);
  rolling::Reading reading;
  while (readings.next(reading)) {
    const ImuAverage& average = reading.average;
    const Eigen::Vector3d& rate = average.mean.angular_velocity_rad_s;
    if (reading.whole && sums.node_s >= path_params_.node_s - 0.5 * average.length_s &&
        window.nodes.size() < path.size()) {
      window.nodes.push_back(rolling::close_node(path_params_, sums, 0.5 * (place.last_rate_rad_s + rate),
                                                 path[window.nodes.size()], filter));
      window.nodes.back().time_ns = place.time_ns;
      sums = {};
      if (window.nodes.size() == emitted) {
        window.committed = filter;
        taken = reading.first;
        committed_place = place;
      }
    }
    if (reading.in_gap) {
      rolling::integrate_gap(path_params_, average, reading.doubt, filter.nominal, sums);
      if (reading.end > reading.first) remember(reading.end_ns, filter.nominal, rate);
    } else {
      ImuAverage so_far;
      TimeNs last_ns = place.time_ns;
      for (std::size_t k = reading.first; k < reading.end; ++k) {
        const ImuSample& sample = state.samples[k];
        so_far.add(sample, seconds(sample.time_ns - last_ns));
        last_ns = sample.time_ns;
        remember(last_ns, rolling::carried_on(path_params_, so_far, filter.nominal),
                 so_far.mean.angular_velocity_rad_s);
      }
      if (reading.whole) rolling::integrate(path_params_, average, filter.nominal, sums);
    }
    place = readings.place();
  }
  const bool ended = emitted > window.nodes.size();
  rolling::Reported moved_at_end = rolling::Reported::Zero();
  if (ended && !window.nodes.empty() && params_.known_distance_m > 0.0) {
    moved_at_end = rolling::measure_distance(path_params_, params_.known_distance_m, params_.known_distance_sigma_m,
                                             window.nodes.back(), filter);
  }
  state.learnt = filter.nominal;
  state.radius_sigma_m = std::sqrt(std::max(0.0, filter.P(rolling::kRadius, rolling::kRadius)));
  window.smoothed_start = rolling::smooth_back(rolling::reported_rows(start.P), window.nodes);
  window.start = start;

  // events whose way became uncertain
  std::vector<bool> uncertain(window.nodes.size(), false);
  double before_m2 = state.committed.event_variance_m2, committed_m2 = 0.0;
  for (std::size_t a = 0; a < window.nodes.size();) {
    if (!slips(window.nodes[a].path.mode)) {
      before_m2 = horizontal_variance(params_, window.nodes[a]);
      if (a + 1 == emitted) committed_m2 = before_m2;
      ++a;
      continue;
    }
    std::size_t b = a;
    while (b < window.nodes.size() && slips(window.nodes[b].path.mode)) {
      if (b + 1 == emitted) committed_m2 = before_m2;
      ++b;
    }
    const double after_m2 = horizontal_variance(params_, window.nodes[std::min(b, window.nodes.size() - 1)]);
    const bool grew = after_m2 - before_m2 > params_.filter.uncertain_m * params_.filter.uncertain_m;
    for (std::size_t n = a; n < b; ++n) uncertain[n] = grew;
    a = b;
  }

  for (const rolling::SamplePoint& point : window.points) {
    if (point.node >= emitted) break;
    const bool inside = point.node < window.nodes.size();
    const bool at_start = point.node == 0;
    const RollingNominal& nominal = at_start ? window.start.nominal : window.nodes[point.node - 1].nominal;
    const rolling::Reported from = at_start ? window.smoothed_start : window.nodes[point.node - 1].smoothed;
    rolling::Reported error = inside ? from : rolling::Reported(from + moved_at_end);
    if (inside) {
      const rolling::NodeRecord& next = window.nodes[point.node];
      const TimeNs from_ns = at_start ? start_ns : window.nodes[point.node - 1].time_ns;
      const double length_s = seconds(next.time_ns - from_ns);
      const double share = length_s > 0.0 ? seconds(point.time_ns - from_ns) / length_s : 1.0;
      error += share * (next.smoothed + next.correction - from);
    }
    RollingEstimate estimate;
    estimate.time_ns = point.time_ns;
    estimate.q_WI = (so3::exp(error.head<3>()) * point.q_WI).normalized();
    const Eigen::Vector3d arm_W =
        estimate.q_WI * (params_.filter.lever_arm_m + nominal.lever_arm_error_m + error.tail<3>());
    const Eigen::Vector3d w_W = estimate.q_WI * (point.rate_I_rad_s - nominal.gyro_bias_rad_s);
    estimate.p_WG_m = point.p_WI_m + error.segment<3>(6) - arm_W;
    estimate.v_WG_m_s = point.v_WI_m_s + error.segment<3>(3) - w_W.cross(arm_W);
    if (!window.nodes.empty()) {
      const std::size_t n = std::min(point.node, window.nodes.size() - 1);
      estimate.covariance = stated(params_) * pose_covariance(window.nodes[n], arm_W);
      estimate.mode = window.nodes[n].path.mode;
      estimate.at_rest = window.nodes[n].path.at_rest;
      estimate.uncertain = uncertain[n];
      if (params_.lag_s < kWholeRun) hold(window.nodes[n].path, state.committed, estimate);
    }
    out.push_back(estimate);
  }

  if (emitted <= window.nodes.size()) {
    state.committed = {window.committed.nominal,       window.committed.P,
                       window.committed.mode,          committed_m2,
                       state.committed.held_p_WG_m,    state.committed.held,
                       committed_place.time_ns,        committed_place.last_rate_rad_s,
                       committed_place.gap_rate_rad_s, committed_place.gap_start_ns,
                       committed_place.gap_piece,      true};
    state.samples.erase(state.samples.begin(), state.samples.begin() + static_cast<std::ptrdiff_t>(taken));
    state.steps.erase(state.steps.begin(), state.steps.begin() + static_cast<std::ptrdiff_t>(emitted));
  } else {
    state.samples.clear();
    state.steps.clear();
  }
}

}  // namespace tumble
