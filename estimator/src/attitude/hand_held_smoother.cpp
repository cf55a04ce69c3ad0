// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_smoother.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "hand_held_problem.hpp"
#include "revolution_hypotheses.hpp"
#include "tumble/attitude/detail/hand_held_stream.hpp"
#include "tumble/common/detail/sample_check.hpp"
#include "tumble/common/types.hpp"

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

Status check(const HandHeldSmoother::Params& params, std::span<const ImuSample> samples,
             const SensingAxisClipSigns& clipped) {
  if (samples.empty()) return {ErrorCode::empty, "samples", 0.0, 1.0};
  const double count = static_cast<double>(samples.size());
  if (!clipped.clip_signs.empty() && clipped.clip_signs.size() != samples.size())
    return {ErrorCode::out_of_range, "signs", static_cast<double>(clipped.clip_signs.size()), count};
  const auto& recovered = clipped.recovered_covariance_rad2_s2;
  if (!recovered.empty() && recovered.size() != samples.size())
    return {ErrorCode::out_of_range, "recovered rates", static_cast<double>(recovered.size()), count};
  for (const Eigen::Matrix3d& covariance : recovered) {
    const double least = covariance.diagonal().minCoeff();
    if (!covariance.allFinite() || least < 0.0)
      return {ErrorCode::out_of_range, "covariance of a recovered rate", least, 0.0};
  }
  const double determinant = std::abs(clipped.sensing_directions.determinant());
  if (!(determinant > hand_held::kRowsMin)) return {ErrorCode::degenerate, "rows", determinant, hand_held::kRowsMin};
  return check_samples(samples, params.expert.gap_max_s);
}

std::uint8_t clipped_axes(const hand_held::GyroReadings& rates, std::size_t k) {
  const std::size_t reading = rates.reading_index_of_sample[k];
  std::uint8_t axes = 0;
  for (std::size_t j = 0; j < 3; ++j) {
    const bool in_part = rates.partial_saturation_sigma_rad_s[reading][static_cast<Eigen::Index>(j)] > 0.0;
    if (rates.clip_signs[reading].gyro[j] != 0 || in_part) axes = static_cast<std::uint8_t>(axes | (1u << j));
  }
  return axes;
}

AngularRateSource source(const AngularRateState& rate, double recovered_sigma) {
  if (rate.clipped_axes == 0) return AngularRateSource::measured;
  const double variance = rate.covariance_rad2_s2.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
  return variance < recovered_sigma * recovered_sigma ? AngularRateSource::recovered_in_contact
                                                      : AngularRateSource::lower_bound_only;
}

/// The gyro's scale error increases the attitude covariance in proportion to the rotation since the last rest:
/// carried.md (C27).
void add_rotation_covariance(const hand_held::NodeData& collected, const std::vector<AngularRateState>& rates,
                             std::vector<AttitudeState>& attitudes) {
  const double share = HandHeldSensorParams::kRecoveredScaleSigma;
  const auto turned_on = [&](std::size_t k, Eigen::Vector3d& turned) {
    if (collected.nodes[collected.samples.node_of[k]].is_stationary) return turned.setZero(), void();
    turned += seconds(rates[k].time_ns - rates[k - 1].time_ns) * rates[k].w_WI_I_rad_s;
  };
  std::vector<double> until_rad2(attitudes.size(), 0.0);
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  for (std::size_t k = attitudes.size(); k-- > 1;) {
    turned_on(k, turned);
    until_rad2[k - 1] = turned.squaredNorm();
  }
  turned.setZero();
  for (std::size_t k = 1; k < attitudes.size(); ++k) {
    turned_on(k, turned);
    attitudes[k].covariance_rad2.diagonal().array() += share * share * std::min(turned.squaredNorm(), until_rad2[k]);
  }
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

HandHeldSmoother::HandHeldSmoother(const Params& params) : params_(params) {
  require_valid_fields(params);
  RestDetector{params.expert.rest_detector};
}

Status HandHeldSmoother::estimate(std::span<const ImuSample> samples, const SensingAxisClipSigns& clipped,
                                  std::vector<AngularRateState>& rates, std::vector<AttitudeState>& attitudes,
                                  Report& report) const {
  rates.clear();
  attitudes.clear();
  report = {};
  if (const Status status = check(params_, samples, clipped); !status.ok()) return status;
  const hand_held::NodeData collected = hand_held::collect_node_data(params_, samples, clipped);
  std::vector<Node> start;
  Status status = hand_held::start_nodes(params_, clipped.sensing_directions, collected, start);
  if (!status.ok()) return status;
  hand_held::HandHeldProblem problem(params_, clipped.sensing_directions, collected, std::move(start));
  status = problem.solve(report);
  if (status.ok()) status = problem.covariances(report);
  if (!status.ok()) return status;
  hand_held::test_revolutions(problem, report);

  rates.resize(samples.size());
  attitudes.resize(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const std::size_t i = collected.samples.node_of[k];
    const Node& node = problem.nodes()[i];
    const Eigen::Matrix<double, 9, 9>& covariance = problem.covariance(i);
    const double at = static_cast<double>(i) * params_.expert.node_s;
    const double centre = collected.samples.window_centre_s[k] - at, end = collected.samples.end_s[k] - at;
    rates[k].time_ns = attitudes[k].time_ns = samples[k].time_ns;
    // A gyro reading is the mean rate over an averaging window, and therefore valid at the window's centre. The
    // reported attitude is valid at the time stamp of the reading.
    rates[k].w_WI_I_rad_s = node.w_WI_I_rad_s + centre * node.angular_acceleration_rad_s2;
    rates[k].covariance_rad2_s2 = covariance.block<3, 3>(hand_held::kRate, hand_held::kRate);
    rates[k].clipped_axes = clipped_axes(collected.rates, k);
    rates[k].source = source(rates[k], HandHeldSensorParams::kRecoveredSigma_rad_s);
    const Eigen::Vector3d turn = end * node.w_WI_I_rad_s + 0.5 * end * end * node.angular_acceleration_rad_s2;
    attitudes[k].orientation_W = node.q_WI * so3::exp(turn);
    const Eigen::Matrix3d R = node.q_WI.toRotationMatrix();
    attitudes[k].covariance_rad2 = R * covariance.topLeftCorner<3, 3>() * R.transpose();
  }
  if (!clipped.recovered_covariance_rad2_s2.empty()) add_rotation_covariance(collected, rates, attitudes);
  return {};
}

}  // namespace tumble

namespace tumble::hand_held {

using Eigen::Vector3d;

namespace {

// If the angular jerk is white noise of density q, the second difference of rate readings with period P has the
// variance `kSecondDifference` q P^3.
constexpr double kSecondDifference = 11.0 / 20.0, kJerkSpan_periods = 1.5;

bool is_free(const GyroReadings& rates, std::size_t k, Eigen::Index axis) {
  return rates.clip_signs[k].gyro[static_cast<std::size_t>(axis)] == 0 &&
         !(rates.partial_saturation_sigma_rad_s[k][axis] > 0.0);
}

struct SampleRange {
  std::size_t first = 0, last = 0;
  SampleRange(double from_s, double to_s, double node_s, std::size_t nodes)
      : first(static_cast<std::size_t>(std::max(0.0, std::ceil(from_s / node_s)))),
        last(std::min(nodes, static_cast<std::size_t>(std::max(0.0, std::floor(to_s / node_s) + 1.0)))) {}
};

// See carried.md (C24).
void add_jerk_from_curvature(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s, double node_s,
                             std::vector<double>& densities) {
  const double period_s = rates.averaging_windows.period_s, reach_s = kJerkSpan_periods * std::max(period_s, node_s);
  const double unit = kSecondDifference * period_s * period_s * period_s;
  std::vector<double> counts(densities.size(), 0.0);
  for (std::size_t k = 1; k + 1 < rates.samples.size(); ++k) {
    if (rates.averaging_windows.end_s[k + 1] - rates.averaging_windows.end_s[k - 1] > 2.0 * kLongest * period_s)
      continue;
    const Vector3d bend = rates.samples[k + 1].angular_velocity_rad_s - 2.0 * rates.samples[k].angular_velocity_rad_s +
                          rates.samples[k - 1].angular_velocity_rad_s;
    double sum = 0.0, count = 0.0;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      if (!is_free(rates, k - 1, axis) || !is_free(rates, k, axis) || !is_free(rates, k + 1, axis)) continue;
      const double along = rows.row(axis).dot(bend);
      sum += along * along - 6.0 * noise_rad_s * noise_rad_s;
      count += 1.0;
    }
    const double at_s = rates.averaging_windows.window_centre_s[k];
    const SampleRange reach(at_s - reach_s, at_s + reach_s, node_s, densities.size());
    for (std::size_t i = reach.first; i < reach.last; ++i) densities[i] += sum / unit, counts[i] += count;
  }
  for (std::size_t i = 0; i < densities.size(); ++i)
    densities[i] = counts[i] > 0.0 ? std::max(0.0, densities[i] / counts[i]) : 0.0;
}

bool unclipped_slope_of(const GyroReadings& rates, const Eigen::Matrix3d& rows, std::size_t k, Eigen::Index axis,
                        double& slope, double& at_s) {
  if (!is_free(rates, k, axis) || !is_free(rates, k + 1, axis)) return false;
  const double dt_s = rates.averaging_windows.window_centre_s[k + 1] - rates.averaging_windows.window_centre_s[k];
  if (!(dt_s > 0.0) || dt_s > kLongest * rates.averaging_windows.period_s) return false;
  slope =
      rows.row(axis).dot(rates.samples[k + 1].angular_velocity_rad_s - rates.samples[k].angular_velocity_rad_s) / dt_s;
  at_s = 0.5 * (rates.averaging_windows.window_centre_s[k] + rates.averaging_windows.window_centre_s[k + 1]);
  return true;
}

// See carried.md (C25).
void add_jerk_from_clipped_slopes(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::vector<double>& densities) {
  const std::size_t count = rates.samples.size();
  const double noise = 2.0 * noise_rad_s / rates.averaging_windows.period_s;  // noise of the difference of two slopes
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    for (std::size_t begin = 2; begin + 2 < count;) {
      if (is_free(rates, begin, axis)) {
        ++begin;
        continue;
      }
      std::size_t end = begin;
      while (end < count && !is_free(rates, end, axis)) ++end;
      double in = 0.0, out = 0.0, from_s = 0.0, to_s = 0.0;
      const bool determined = end + 1 < count && unclipped_slope_of(rates, rows, begin - 2, axis, in, from_s) &&
                              unclipped_slope_of(rates, rows, end, axis, out, to_s);
      if (determined) {
        const double density = ((out - in) * (out - in) - noise * noise) / (to_s - from_s);
        const SampleRange reach(from_s, to_s, node_s, densities.size());
        for (std::size_t i = reach.first; i < reach.last; ++i) densities[i] = std::max(densities[i], density);
      }
      begin = end;
    }
  }
}

}  // namespace

std::vector<double> estimate_jerk(const GyroReadings& rates, const Eigen::Matrix3d& rows, double noise_rad_s,
                                  double node_s, std::size_t nodes) {
  std::vector<double> out(nodes, 0.0);
  add_jerk_from_curvature(rates, rows, noise_rad_s, node_s, out);
  add_jerk_from_clipped_slopes(rates, rows, noise_rad_s, node_s, out);
  for (double& density : out) density = std::sqrt(density);
  return out;
}

}  // namespace tumble::hand_held
