// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "rolling_filter_states.hpp"
#include "tumble/common/so3.hpp"
#include "tumble/rolling/rolling_filter.hpp"

namespace tumble {

namespace {

constexpr double kDropped = -120.0;   // log weight below the best at which a hypothesis is given up
constexpr double kRestFloor = -60.0;  // least log likelihood of a node at rest: one bad node must not decide
constexpr double kSettled_s = 1.0;    // after so long in one mode it does not matter when it began
constexpr double kSteady_m_s = 0.01, kJump_m_s = 0.08, kSteadyShare = 0.7;  // change of u per node, horizontal
constexpr double kRise_m_s = 0.03, kHit_m_s = 0.3;                          // and vertical, on a bump
constexpr std::int64_t kAgesApart = 4;
constexpr RollingMode kModes[] = {RollingMode::grip, RollingMode::slip, RollingMode::bump};

double log_normal(double value, double variance) {
  return -0.5 * (value * value / variance + std::log(2.0 * std::numbers::pi * variance));
}

/// log of a mixture of two isotropic normal densities of `dimension` components with squared length `square`.
double log_mixture(double square, double narrow, double wide, int dimension) {
  const auto density = [&](double sigma) {
    return std::exp(-0.5 * square / (sigma * sigma)) *
           std::pow(2.0 * std::numbers::pi * sigma * sigma, -0.5 * dimension);
  };
  return std::log(kSteadyShare * density(narrow) + (1.0 - kSteadyShare) * density(wide) + 1e-300);
}

}  // namespace

/// Contact velocity of the nominal trajectory and its derivative by the error state.
struct RollingFilter::Contact {
  Eigen::Vector3d u_W_m_s;
  Eigen::Matrix<double, 3, kStates> H;
  double grip_variance = 0.0;
};

struct RollingFilter::Candidate {
  double log_weight = 0.0;
  int parent = 0;
  RollingMode mode = RollingMode::grip;
  std::int64_t switched_node = 0;
};

RollingFilter::Contact RollingFilter::contact(const Eigen::Vector3d& rate_I_rad_s, const State& state) const {
  const Eigen::Matrix3d R = state.q_nominal.toRotationMatrix();
  const Eigen::Vector3d w_W = R * (rate_I_rad_s - state.gyro_bias_rad_s - state.gyro_scale * rate_I_rad_s);
  const Eigen::Vector3d arm_W = R * (params_.lever_arm_m + state.lever_arm_error_m);
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ();
  const Eigen::Matrix3d rZ = params_.radius_m * so3::hat(z);
  Contact out;
  out.u_W_m_s = state.v_WI_m_s - w_W.cross(arm_W) + rZ * w_W;
  out.H.setZero();
  out.H.middleCols<3>(kVelocity).setIdentity();
  out.H.middleCols<3>(kAttitude) = -rZ * so3::hat(w_W);
  out.H.middleCols<3>(kGyroBias) = -rZ * R;
  for (int axis = 0; axis < 3; ++axis) out.H.middleCols<3>(kGyroScale + 3 * axis) = -rate_I_rad_s[axis] * rZ * R;
  out.H.middleCols<3>(kLeverArm) = -so3::hat(w_W) * R;
  out.grip_variance =
      squared(params_.grip_sigma_m_s) + squared(params_.grip_sigma_share * params_.radius_m * w_W.norm());
  return out;
}

double RollingFilter::log_transition(RollingMode from, RollingMode to, double h_s) const {
  const auto rate = [this](RollingMode a, RollingMode b) {
    if (a == RollingMode::grip) return b == RollingMode::slip ? params_.slip_begins_per_s : params_.bump_begins_per_s;
    if (b == RollingMode::grip) return a == RollingMode::slip ? params_.slip_ends_per_s : params_.bump_ends_per_s;
    return params_.slip_bump_per_s;
  };
  if (from != to) return std::log(rate(from, to) * h_s);
  double leaving = 0.0;
  for (const RollingMode other : kModes) leaving += other == from ? 0.0 : rate(from, other);
  return -leaving * h_s;
}

RollingFilter::Candidate RollingFilter::judge(int parent, RollingMode mode, const Contact& c,
                                              const State& state) const {
  const Hypothesis& h = state.hypotheses[static_cast<std::size_t>(parent)];
  const Eigen::Vector3d u = c.u_W_m_s + c.H * h.x;
  const Eigen::Vector3d change = u - h.u_W_m_s;
  const double horizontal = change.head<2>().squaredNorm();
  double likelihood = 0.0;
  if (mode == RollingMode::grip) {
    Eigen::Matrix3d S = c.H * h.P * c.H.transpose();
    S.diagonal() += Eigen::Vector3d(c.grip_variance, c.grip_variance, squared(params_.vertical_sigma_m_s));
    const Eigen::LLT<Eigen::Matrix3d> factor(S);
    const double log_det = 2.0 * factor.matrixLLT().diagonal().array().log().sum();
    likelihood = -0.5 * (factor.matrixL().solve(u).squaredNorm() + log_det + 3.0 * std::log(2.0 * std::numbers::pi));
  } else if (mode == RollingMode::slip) {
    const double vertical = c.H.row(2) * h.P * c.H.row(2).transpose() + squared(params_.vertical_sigma_m_s);
    likelihood = log_mixture(horizontal, kSteady_m_s, kJump_m_s, 2) + log_normal(u.z(), vertical);
  } else {
    likelihood =
        log_mixture(horizontal, kSteady_m_s, kJump_m_s, 2) + log_mixture(squared(change.z()), kRise_m_s, kHit_m_s, 1);
  }
  const double weight = h.log_weight + log_transition(h.mode, mode, state.node_s) + likelihood;
  return {weight, parent, mode, mode == h.mode ? h.switched_node : state.node};
}

void RollingFilter::choose_modes(const Eigen::Vector3d& rate_I_rad_s, State& state) const {
  const Contact c = contact(rate_I_rad_s, state);
  std::array<Candidate, 3 * kHypotheses> candidates;
  std::size_t total = 0;
  const auto shortest = static_cast<std::int64_t>(std::ceil(params_.event_shortest_s / state.node_s - 1e-9));
  for (int parent = 0; parent < state.count; ++parent) {
    const Hypothesis& h = state.hypotheses[static_cast<std::size_t>(parent)];
    for (const RollingMode mode : kModes) {
      const bool bound = h.mode != RollingMode::grip && state.node - h.switched_node < shortest;
      if (mode == h.mode || !bound) candidates[total++] = judge(parent, mode, c, state);
    }
  }
  std::stable_sort(candidates.begin(), candidates.begin() + static_cast<std::ptrdiff_t>(total),
                   [](const Candidate& a, const Candidate& b) { return a.log_weight > b.log_weight; });

  const auto settled = static_cast<std::int64_t>(kSettled_s / state.node_s);
  // two beginnings of the same mode are one the sooner, the longer they are past
  const auto since = [&](const Candidate& k) {
    const std::int64_t age = std::min(state.node - k.switched_node, settled);
    std::int64_t width = 1;
    while (width * kAgesApart < age) width *= 2;
    return k.switched_node >= state.node - settled ? k.switched_node / width * width : state.node - settled;
  };
  std::array<Hypothesis, kHypotheses> next;
  std::array<Candidate, kHypotheses> kept;
  std::size_t count = 0;
  for (std::size_t k = 0; k < total && count < kHypotheses; ++k) {
    const Candidate& candidate = candidates[k];
    if (candidate.log_weight < candidates[0].log_weight + kDropped) break;
    const auto same = [&](const Candidate& other) {
      return other.mode == candidate.mode && since(other) == since(candidate);
    };
    if (std::any_of(kept.begin(), kept.begin() + static_cast<std::ptrdiff_t>(count), same)) continue;
    Hypothesis& h = next[count];
    h = state.hypotheses[static_cast<std::size_t>(candidate.parent)];
    if (candidate.mode == RollingMode::grip) {
      for (int axis = 0; axis < 2; ++axis) update(c.H.row(axis), -c.u_W_m_s[axis], c.grip_variance, h);
    }
    if (candidate.mode != RollingMode::bump) update(c.H.row(2), -c.u_W_m_s.z(), squared(params_.vertical_sigma_m_s), h);
    h.u_W_m_s = c.u_W_m_s + c.H * h.x;
    h.log_weight = candidate.log_weight - candidates[0].log_weight;
    h.mode = candidate.mode;
    h.switched_node = candidate.switched_node;
    kept[count++] = candidate;
  }
  for (std::size_t k = 0; k < count; ++k) state.hypotheses[k] = next[k];
  // what is not in use is blank, so that equal estimates are equal states
  for (std::size_t k = count; k < static_cast<std::size_t>(state.count); ++k) state.hypotheses[k] = Hypothesis{};
  state.count = static_cast<int>(count);
}

/// Every hypothesis stands still: velocity and rate are zero, the contact grips.
void RollingFilter::correct_at_rest(State& state) const {
  for (int k = 0; k < state.count; ++k) {
    Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    double likelihood = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double variance = squared(params_.rest_velocity_sigma_m_s);
      const double v = state.v_WI_m_s[axis] + h.x[kVelocity + axis];
      likelihood += log_normal(v, h.P(kVelocity + axis, kVelocity + axis) + variance);
      update(kVelocity + axis, -state.v_WI_m_s[axis], variance, h);
      const double bias = state.w_I_rad[axis] / state.node_s;  // already without the nominal bias
      update(kGyroBias + axis, bias, squared(params_.rest_rate_sigma_rad_s), h);
    }
    h.log_weight += std::max(likelihood, kRestFloor);
    if (h.mode != RollingMode::grip) h.switched_node = state.node;
    h.mode = RollingMode::grip;
    h.u_W_m_s.setZero();
  }
  std::stable_sort(state.hypotheses.begin(), state.hypotheses.begin() + state.count,
                   [](const Hypothesis& a, const Hypothesis& b) { return a.log_weight > b.log_weight; });
  // they agree about the present, so after a while one is enough; what they disagree in about the past is where they
  // are
  if (state.rest_s > kSettled_s && state.count > 1) {
    state.hypotheses[0].P.block<3, 3>(kPosition, kPosition) += position_spread(state);
  }
  const double best = state.hypotheses[0].log_weight;
  int kept = 0;
  for (int k = 0; k < state.count; ++k) {
    Hypothesis& h = state.hypotheses[static_cast<std::size_t>(k)];
    h.log_weight -= best;
    const bool settled = state.rest_s > kSettled_s;
    if (k == 0 || (!settled && h.log_weight > kDropped)) kept = k + 1;
  }
  for (int k = kept; k < state.count; ++k) state.hypotheses[static_cast<std::size_t>(k)] = Hypothesis{};
  state.count = kept;
}

}  // namespace tumble
