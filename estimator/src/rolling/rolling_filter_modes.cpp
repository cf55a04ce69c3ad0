// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <span>
#include <tuple>
#include <utility>

#include "rolling_node.hpp"
#include "tumble/rolling/detail/rolling_filter.hpp"

namespace tumble {

namespace {

constexpr double kSpeedMax_m_s = 2.5;  // maximum speed of the sphere; grip at a higher speed is rejected
// mean velocity change by unexplained impacts per filter step, while the sphere remains on the floor
constexpr double kUnexplainedImpact_m_s = 0.03;
// rate of transitions from slip to bump, and from bump to slip
constexpr double kSlipBumpPerS = 0.2;
constexpr double kInclineEndsPerS = 0.1;                         // rate of changes from a slope to the level floor
constexpr double kRoughBeginsPerS = 0.02, kRoughEndsPerS = 0.1;  // rates of changes to and from a rough floor

constexpr double kPruneLogWeight = -120.0;       // minimum log weight of a hypothesis, relative to the best hypothesis
constexpr double kRestLogLikelihoodMin = -60.0;  // limits the effect of a single outlier at rest (log likelihood)
constexpr double kModeAgeMax_s = 1.0;            // contact modes that started longer ago count as equally old
// During slip, the change of the contact velocity per filter step is modelled by a mixture of three Gaussians. The
// standard deviations of the Gaussians are kPlateau_m_s, kSteady_m_s and kJump_m_s. Because kPlateau_m_s is less than
// the noise of the contact velocity during grip, slip is a more probable explanation of a constant contact velocity
// than grip.
constexpr double kPlateau_m_s = 0.004, kSteady_m_s = 0.01, kJump_m_s = 0.08, kPlateauFraction = 0.4,
                 kSteadyFraction = 0.35;
constexpr double kRollOverSigma_m_s = 0.03, kHitSigma_m_s = 0.3, kRollOverFraction = 0.7;
constexpr std::int64_t kAgesApart = 4;
// A slip at constant angular rate is indistinguishable from grip until the slip ends. At the end of a slip at constant
// angular rate, about a hundred wrong hypotheses have higher weights than the correct hypothesis. The filter therefore
// reserves memory for kMinDissentingHypotheses hypotheses whose current mode started before the current mode of the
// best hypothesis.
constexpr std::size_t kMinDissentingHypotheses = 6;
constexpr double kRoughCost = 0.2;
// The start of a ramp is detected as a bump, so a transition to a slope is more probable after a bump.
constexpr double kInclineAfterBump = 4.0;
constexpr ContactMode kModes[] = {ContactMode::grip, ContactMode::slip, ContactMode::bump_or_flight,
                                  ContactMode::incline, ContactMode::rough};
static_assert(std::size(kModes) == kContactModes);

double gaussian_log_density(double value, double variance) {
  return -0.5 * (value * value / variance + std::log(2.0 * std::numbers::pi * variance));
}

/// See m1 of rolling.md (R25).
double log_floor_rise(double change) {
  const auto density = [&](double sigma) {
    return std::exp(-0.5 * change * change / (sigma * sigma)) / (sigma * std::sqrt(2.0 * std::numbers::pi));
  };
  return std::log(kRollOverFraction * density(kRollOverSigma_m_s) + (1.0 - kRollOverFraction) * density(kHitSigma_m_s) +
                  1e-300);
}

/// See m2 of rolling.md (R24).
double log_normalised_square(double square) {
  double density = 0.0;
  for (const auto& [share, sigma] : {std::pair(kPlateauFraction, kPlateau_m_s), std::pair(kSteadyFraction, kSteady_m_s),
                                     std::pair(1.0 - kPlateauFraction - kSteadyFraction, kJump_m_s)}) {
    density += share * std::exp(-0.5 * square / (sigma * sigma)) / (2.0 * std::numbers::pi * sigma * sigma);
  }
  return std::log(density + 1e-300);
}

/// See rolling.md (R23).
double log_likelihood_stationary(const rolling::Contact& c, const RollingFilter::Hypothesis& h, ContactMode mode) {
  RollingFilter::Vector x = h.x;
  Eigen::Matrix<double, 3, rolling::kStates> H = c.measurement_jacobian;
  const bool slope_reset = rolling::resets_floor_slope(h.mode, mode);
  if (slope_reset) {
    x.segment<2>(rolling::kSlope) = -c.floor_slope;
    H.middleCols<2>(rolling::kSlope).setZero();
  }
  Eigen::Matrix3d S = H * h.covariance * H.transpose();
  if (slope_reset && mode == ContactMode::incline) {
    const Eigen::Matrix<double, 3, 2> by_slope = c.measurement_jacobian.middleCols<2>(rolling::kSlope);
    S += squared(RollingContactParams::kSlopeSigma) * by_slope * by_slope.transpose();
  }
  const auto log_det_with = [&](const Eigen::Vector3d& variance, Eigen::LLT<Eigen::Matrix3d>& factor) {
    factor.compute(S + Eigen::Matrix3d(variance.asDiagonal()));
    return 2.0 * factor.matrixLLT().diagonal().array().log().sum();
  };
  Eigen::LLT<Eigen::Matrix3d> factor;
  double log_det = 0.0, cost = 0.0;
  if (mode == ContactMode::rough) {
    // In the mode rough, the contact velocity has a larger variance, which would reduce the likelihood of every filter
    // step on a rough floor. The likelihood of the mode rough is therefore normalised with the variance of the mode
    // grip. The logarithm of the likelihood of the mode rough is reduced by kRoughCost.
    log_det = log_det_with(rolling::contact_variance(c, ContactMode::grip), factor);
    cost = kRoughCost;
  }
  const double own = log_det_with(rolling::contact_variance(c, mode), factor);
  if (mode != ContactMode::rough) log_det = own;
  const double square = factor.matrixL().solve(c.velocity(x)).squaredNorm();
  return -cost - 0.5 * (square + log_det + 3.0 * std::log(2.0 * std::numbers::pi));
}

/// See rolling.md (R24), (R25).
double log_likelihood_moving(const rolling::Contact& c, const RollingFilter::Hypothesis& h, ContactMode mode,
                             const Eigen::Vector3d& u) {
  const Eigen::Vector3d change = u - h.contact_velocity_W_m_s;
  const double horizontal = log_normalised_square(change.head<2>().squaredNorm());
  if (mode == ContactMode::bump_or_flight) return horizontal + log_floor_rise(change.z());
  const double check_gravity_direction =
      c.measurement_jacobian.row(2) * h.covariance * c.measurement_jacobian.row(2).transpose() +
      squared(RollingContactParams::kVerticalSigma_m_s);
  return horizontal + gaussian_log_density(u.z(), check_gravity_direction);
}

/// See rolling.md (R22).
double log_transition(const RollingParams& params, ContactMode from, ContactMode to, double h_s) {
  const auto& modes = params.expert.modes;
  const auto rate = [&](ContactMode a, ContactMode b) {
    if (b == ContactMode::incline) {
      return modes.incline_begins_per_s * (a == ContactMode::bump_or_flight ? kInclineAfterBump : 1.0);
    }
    if (b == ContactMode::rough) return kRoughBeginsPerS;
    if (b == ContactMode::slip) return a == ContactMode::bump_or_flight ? kSlipBumpPerS : modes.slip_begins_per_s;
    if (b == ContactMode::bump_or_flight) return a == ContactMode::slip ? kSlipBumpPerS : modes.bump_begins_per_s;
    if (a == ContactMode::incline) return kInclineEndsPerS;
    if (a == ContactMode::rough) return kRoughEndsPerS;
    return a == ContactMode::slip ? modes.kSlipEndsPerS : modes.kBumpEndsPerS;
  };
  if (from != to) return std::log(rate(from, to) * h_s);
  double leaving = 0.0;
  for (const ContactMode other : kModes) leaving += other == from ? 0.0 : rate(from, other);
  return -leaving * h_s;
}

struct ModeCandidate {
  double log_weight = 0.0;
  int parent = 0;
  ContactMode mode = ContactMode::grip;
  std::int64_t first_step_of_mode = 0;
};
using Candidates = std::array<ModeCandidate, kContactModes * RollingFilter::kHypotheses>;

/// Returns all pairs of a hypothesis and a possible next contact mode, most probable pair first.
std::span<const ModeCandidate> propose_mode_changes(const RollingParams& params, const rolling::Contact& c,
                                                    const RollingFilter::State& state, Candidates& out) {
  const double node_s = state.node_integrals.node_interval_s;
  const bool in_gap = state.node_integrals.gap_s > 0.0;
  const bool too_fast = c.rolling_speed_m_s > kSpeedMax_m_s;
  const auto shortest = static_cast<std::int64_t>(std::ceil(params.expert.modes.kEventShortest_s / node_s - 1e-9));
  std::size_t total = 0;
  for (int parent = 0; parent < state.hypothesis_count; ++parent) {
    const RollingFilter::Hypothesis& h = state.hypotheses[static_cast<std::size_t>(parent)];
    const Eigen::Vector3d u = c.velocity(h.x);
    for (const ContactMode mode : kModes) {
      const bool bound = may_slip(h.mode) && state.step_count - h.first_step_of_mode < shortest;
      if (mode != h.mode && bound) continue;
      if (too_fast && !may_slip(mode)) continue;
      double likelihood = 0.0;  // a data gap gives no evidence for a contact mode
      if (!in_gap)
        likelihood = may_slip(mode) ? log_likelihood_moving(c, h, mode, u) : log_likelihood_stationary(c, h, mode);
      const double impact = mode == ContactMode::bump_or_flight
                                ? 0.0
                                : state.node_integrals.unexplained_impact_m_s / kUnexplainedImpact_m_s;
      out[total++] = {h.log_weight + log_transition(params, h.mode, mode, node_s) + likelihood - impact, parent, mode,
                      mode == h.mode ? h.first_step_of_mode : state.step_count};
    }
  }
  // std::stable_sort would allocate memory. For a unique order, candidates of equal weight are sorted by hypothesis and
  // mode.
  std::sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(total),
            [](const ModeCandidate& a, const ModeCandidate& b) {
              return std::tuple(-a.log_weight, a.parent, a.mode) < std::tuple(-b.log_weight, b.parent, b.mode);
            });
  return {out.data(), total};
}

/// Rounds the index of the filter step at which a contact mode started, more coarsely for older modes. After rounding,
/// hypotheses count as equal if their contact modes started at similar times.
std::int64_t mode_beginning_node(std::int64_t mode_start_node, std::int64_t node, double node_s) {
  const auto mode_age_max_nodes = static_cast<std::int64_t>(kModeAgeMax_s / node_s);
  const std::int64_t age = std::min(node - mode_start_node, mode_age_max_nodes);
  std::int64_t width = 1;
  while (width * kAgesApart < age) width *= 2;
  return mode_start_node >= node - mode_age_max_nodes ? mode_start_node / width * width : node - mode_age_max_nodes;
}

struct KeptHypotheses {
  std::array<ModeCandidate, RollingFilter::kHypotheses> candidates;
  std::size_t count = 0;
};

KeptHypotheses keep_probable_candidates(std::span<const ModeCandidate> candidates, std::int64_t node, double node_s) {
  KeptHypotheses kept;
  for (const ModeCandidate& candidate : candidates) {
    if (kept.count == kept.candidates.size() || candidate.log_weight < candidates[0].log_weight + kPruneLogWeight)
      break;
    const bool has_earlier_mode = candidate.first_step_of_mode < candidates[0].first_step_of_mode;
    if (kept.count + kMinDissentingHypotheses >= kept.candidates.size() && !has_earlier_mode) continue;
    const std::int64_t since = mode_beginning_node(candidate.first_step_of_mode, node, node_s);
    const auto same = [&](const ModeCandidate& other) {
      return other.mode == candidate.mode && mode_beginning_node(other.first_step_of_mode, node, node_s) == since;
    };
    if (std::any_of(kept.candidates.begin(), kept.candidates.begin() + static_cast<std::ptrdiff_t>(kept.count), same))
      continue;
    kept.candidates[kept.count++] = candidate;
  }
  return kept;
}

using Origins = std::array<std::size_t, RollingFilter::kHypotheses>;

/// Replaces each hypothesis k by a copy of hypothesis from[k] in place, because a second array would need 420 KiB of
/// stack.
void rearrange_hypotheses(const Origins& from, std::size_t count, std::span<RollingFilter::Hypothesis> all) {
  std::array<int, RollingFilter::kHypotheses> readers{};  // number of pending copies that read from each slot
  std::array<bool, RollingFilter::kHypotheses> waits{};
  for (std::size_t k = 0; k < count; ++k) {
    waits[k] = from[k] != k;
    readers[from[k]] += waits[k] ? 1 : 0;
  }
  for (std::size_t first = 0; first < count; ++first) {
    for (std::size_t k = first; k < count && waits[k] && readers[k] == 0; k = from[k]) {
      all[k] = all[from[k]];
      waits[k] = false;
      --readers[from[k]];
    }
  }
  // The remaining copies form cycles, and each cycle needs one temporary copy of a hypothesis.
  for (std::size_t first = 0; first < count; ++first) {
    if (!waits[first]) continue;
    const RollingFilter::Hypothesis kept = all[first];
    std::size_t k = first;
    for (; from[k] != first; k = from[k]) {
      all[k] = all[from[k]];
      waits[k] = false;
    }
    all[k] = kept;
    waits[k] = false;
  }
}

}  // namespace

/// See rolling.md (R26).
void RollingFilter::choose_modes(const Eigen::Vector3d& rate_I_rad_s, bool heading_lost, State& state) const {
  rolling::Contact c = rolling::contact(params_, state.nominal, rate_I_rad_s, state.node_integrals);
  if (heading_lost) rolling::remove_heading_component(c);
  const double node_s = state.node_integrals.node_interval_s;
  Candidates candidates;
  const std::span<const ModeCandidate> ordered = propose_mode_changes(params_, c, state, candidates);
  const KeptHypotheses kept = keep_probable_candidates(ordered, state.step_count, node_s);
  Origins parents{};
  for (std::size_t k = 0; k < kept.count; ++k) parents[k] = static_cast<std::size_t>(kept.candidates[k].parent);
  rearrange_hypotheses(parents, kept.count, state.hypotheses);
  for (std::size_t k = 0; k < kept.count; ++k) {
    const ModeCandidate& candidate = kept.candidates[k];
    Hypothesis& h = state.hypotheses[k];
    rolling::update_slope_for_mode(h.mode, candidate.mode, node_s, state.nominal, h.x, h.covariance);
    rolling::contact_measurement_rows(c, candidate.mode, node_s, state.nominal.v_WI_m_s, h.x, h.covariance,
                                      [&](const auto& row, double measured, double variance) {
                                        rolling::update(row, measured, variance, h.x, h.covariance);
                                      });
    h.contact_velocity_W_m_s = c.velocity(h.x);
    h.log_weight = candidate.log_weight - ordered[0].log_weight;
    h.mode = candidate.mode;
    h.first_step_of_mode = candidate.first_step_of_mode;
    h.parent = candidate.parent;
  }
  keep_most_probable_hypotheses(kept.count, state);
}

/// Clears the unused hypotheses, so that equal estimates have bit-identical states.
void RollingFilter::keep_most_probable_hypotheses(std::size_t count, State& state) {
  const auto begin = state.hypotheses.begin();
  const auto first = begin + static_cast<std::ptrdiff_t>(count);
  if (first < begin + state.hypothesis_count) std::fill(first, begin + state.hypothesis_count, Hypothesis{});
  state.hypothesis_count = static_cast<int>(count);
}

/// See rolling.md (R28).
void RollingFilter::correct_at_rest(State& state) const {
  for (int k = 0; k < state.hypothesis_count; ++k) {
    Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    double likelihood = 0.0;
    rolling::stationary_measurement_rows(
        state.node_integrals, state.nominal, state.spins_in_place, [&](int index, double measured, double variance) {
          // only the velocity, and not the gyro bias, contributes to the likelihood of a contact mode
          if (index < rolling::kPosition)
            likelihood += gaussian_log_density(measured - h.x[index], h.covariance(index, index) + variance);
          rolling::update(index, measured, variance, h.x, h.covariance);
        });
    h.log_weight += std::max(likelihood, kRestLogLikelihoodMin);
    h.parent = k;
    if (may_slip(h.mode)) {
      h.first_step_of_mode = state.step_count;
      h.mode = ContactMode::grip;
    }
    h.contact_velocity_W_m_s.setZero();
  }
  const auto count = static_cast<std::size_t>(state.hypothesis_count);
  Origins order{};
  std::iota(order.begin(), order.begin() + state.hypothesis_count, std::size_t{0});
  std::sort(order.begin(), order.begin() + state.hypothesis_count, [&](std::size_t a, std::size_t b) {
    return std::tuple(-state.hypotheses[a].log_weight, a) < std::tuple(-state.hypotheses[b].log_weight, b);
  });
  rearrange_hypotheses(order, count, state.hypotheses);
  // After kModeAgeMax_s at rest, the motion of all hypotheses is equal, so only the best hypothesis is kept.
  const bool rested = seconds(state.stationary_state.small_rate_since_ns) > kModeAgeMax_s;
  if (rested && state.hypothesis_count > 1)
    state.pruned_position_covariance_m2 = hypothesis_position_covariance(state, rolling::kPosition);
  const double best = state.hypotheses[0].log_weight;
  std::size_t kept = 0;
  for (std::size_t k = 0; k < count; ++k) {
    Hypothesis& h = state.hypotheses[k];
    h.log_weight -= best;
    if (k == 0 || (!rested && h.log_weight > kPruneLogWeight)) kept = k + 1;
  }
  keep_most_probable_hypotheses(kept, state);
}

}  // namespace tumble
