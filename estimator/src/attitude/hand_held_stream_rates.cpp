// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "hand_held_problem.hpp"
#include "revolution_hypotheses.hpp"
#include "tumble/attitude/detail/hand_held_stream.hpp"

namespace tumble {

using hand_held::Node;
using hand_held::System;

namespace {

constexpr double kUnknown_rad2_s2 = 1e6;  // variance of a rate if the equations have no solution
// Near a clipped reading, the covariance is computed with a larger density of the angular jerk.
constexpr double kNear_s = 0.1;

std::uint8_t clipped_axes(const ClipSigns& signs) {
  std::uint8_t axes = 0;
  for (std::size_t j = 0; j < 3; ++j)
    if (signs.gyro[j] != 0) axes = static_cast<std::uint8_t>(axes | (1u << j));
  return axes;
}

}  // namespace

AngularRateState HandHeldRateStream::compute_report(std::size_t at, bool due, bool factorised, State& state) const {
  const Reading& reading = state.readings[at];
  if (reading.smoothed) return *reading.smoothed;
  const bool known = state.reported_node >= 0 && reading.node - state.reported_node < hand_held::kFreeNodes;
  if (reading.node == state.reported_node || (known && !due))
    return rate_state_of_reading(reading, state, state.reported_covariance_rad2_s2);
  AngularRateState rate;
  report_rates(at, at, factorised, state, {&rate, 1});
  state.reported_node = reading.node;
  state.reported_covariance_rad2_s2 = rate.covariance_rad2_s2;
  return rate;
}

std::size_t HandHeldRateStream::first_unreported_reading(const State& state) const {
  return state.readings.size() - std::min(state.readings.size(), delay_ + 1);
}

// If the sample rate is lower than the user has stated, a time step (node) may leave the window before its rate is
// reported.
void HandHeldRateStream::store_oldest_rates(State& state) const {
  const std::size_t first = first_unreported_reading(state);
  for (std::size_t k = first; k < state.readings.size() && state.readings[k].node <= state.first_node; ++k) {
    if (state.readings[k].smoothed) continue;
    AngularRateState rate;
    report_rates(k, k, false, state, {&rate, 1});
    state.readings[k].smoothed = rate;
  }
}

AngularRateState HandHeldRateStream::rate_state_of_reading(const Reading& reading, const State& state,
                                                           const Eigen::Matrix3d& covariance) const {
  const auto at = static_cast<std::size_t>(std::max<std::int64_t>(0, reading.node - state.first_node));
  const Node& node = state.window[at].node;
  AngularRateState out;
  out.time_ns = reading.sample.time_ns;
  const double t = reading.window_centre_s - static_cast<double>(reading.node) * params_.body.expert.node_s;
  out.w_WI_I_rad_s = node.w_WI_I_rad_s + t * node.angular_acceleration_rad_s2;
  out.covariance_rad2_s2 = covariance;
  out.clipped_axes = clipped_axes(reading.clip_signs);
  if (out.clipped_axes == 0) return out;
  const double variance = covariance.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
  const double recovered = HandHeldSensorParams::kRecoveredSigma_rad_s * HandHeldSensorParams::kRecoveredSigma_rad_s;
  out.source = variance < recovered ? AngularRateSource::recovered_in_contact : AngularRateSource::lower_bound_only;
  return out;
}

// Increments the counter of clipped segments whose number of revolutions is ambiguous: carried.md (C42).
void HandHeldRateStream::count_revolutions(std::size_t at, const AngularRateState& rate, State& state) const {
  const Reading& reading = state.readings[at];
  const double since_s = at > 0 ? reading.end_s - state.readings[at - 1].end_s : params_.period_s;
  const auto open = [&](Eigen::Index j) {
    return state.clipped_angle_sigma_rad[j] > hand_held::kAngleShare * std::numbers::pi &&
           hand_held::revolution_cost(state.clipped_duration_s[j], params_.body.jerk_rad_s3_sqrts) <
               2.0 * hand_held::kLogOdds;
  };
  for (Eigen::Index j = 0; j < 3; ++j) {
    if (reading.clip_signs.gyro[static_cast<std::size_t>(j)] == 0) {
      state.clipped_duration_s[j] = state.clipped_angle_sigma_rad[j] = 0.0;
      continue;
    }
    const Eigen::RowVector3d m = state.sensing_directions.row(j);
    const bool before = open(j);
    state.clipped_duration_s[j] += since_s;
    state.clipped_angle_sigma_rad[j] +=
        since_s * std::sqrt(std::max(0.0, m.dot(rate.covariance_rad2_s2 * m.transpose())));
    if (!before && open(j)) ++state.revolutions_ambiguous;
  }
}

// See carried.md (C23), (C41). `factorised` states whether the normal equations are already factorised for the assumed
// jerk density.
void HandHeldRateStream::report_rates(std::size_t first, std::size_t last, bool factorised, State& state,
                                      std::span<AngularRateState> out) const {
  const auto of = [&](std::size_t k) {
    return static_cast<std::size_t>(std::max<std::int64_t>(0, state.readings[k].node - state.first_node));
  };
  const auto near = static_cast<std::size_t>(std::lround(kNear_s / params_.body.expert.node_s));
  const std::size_t from = of(first) > near ? of(first) - near : 0;
  const std::size_t to = std::min(state.window.size(), of(last) + near + 1);
  bool clipped = false;
  for (std::size_t i = from; i < to; ++i) clipped = clipped || hand_held::clips(state.window[i].readings);
  System::BorderVector unused;
  hand_held::ReadingNoise noise = adapted_noise(state);
  // See carried.md (C41).
  if (clipped) noise.bound = noise.force_bound_weight = 0.0;
  const bool known = (factorised && !clipped) || factorise(clipped ? inflated_motion_ : motion_, noise, state, unused);
  System::StateGivenNextState here, next;
  Eigen::Matrix3d covariance = kUnknown_rad2_s2 * Eigen::Matrix3d::Identity();
  std::size_t k = last + 1;
  for (std::size_t i = state.window.size(); i-- > of(first);) {
    if (known) {
      here = System::state_given_next_state(state.work_blocks[i], i + 1 < state.window.size() ? &next : nullptr);
      const auto rows = here.border_jacobian.middleRows<3>(hand_held::kRate);
      covariance = here.state.block<3, 3>(hand_held::kRate, hand_held::kRate) +
                   rows * state.constants_covariance * rows.transpose();
    }
    for (; k > first && of(k - 1) == i; --k)
      out[k - 1 - first] = rate_state_of_reading(state.readings[k - 1], state, covariance);
    next = here;
  }
}

void HandHeldRateStream::flush(const State& state, std::vector<AngularRateState>& out) const {
  const std::size_t left = std::min(delay_, state.readings.size());
  if (left == 0) return;
  std::size_t first = state.readings.size() - left;
  for (; first < state.readings.size() && state.readings[first].smoothed; ++first) {
    out.push_back(*state.readings[first].smoothed);
  }
  if (first == state.readings.size()) return;
  State last = state;
  std::vector<AngularRateState> rates(state.readings.size() - first);
  report_rates(first, state.readings.size() - 1, false, last, rates);
  out.insert(out.end(), rates.begin(), rates.end());
}

}  // namespace tumble
