// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_stream.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "hand_held_problem.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

using Eigen::Vector3d;
using hand_held::Node;
using hand_held::System;

namespace {

constexpr double kRotationMax_rad = 0.8;
constexpr int kFirstNodes = 100;  // number of first nodes, during which the attitude converges

System::BorderVector constants_difference(const hand_held::Constants& from, const hand_held::Constants& to) {
  System::BorderVector out;
  out << to.gyro_bias_rad_s - from.gyro_bias_rad_s, to.accel_bias_m_s2 - from.accel_bias_m_s2,
      to.lever_arm_m - from.lever_arm_m;
  return out;
}

bool has_clipped_reading(const HandHeldRateStream::State& state) {
  return std::any_of(state.window.begin(), state.window.end(),
                     [](const auto& knot) { return hand_held::clips(knot.readings); });
}

bool equal_clip_signs(const ClipSigns& a, const ClipSigns& b) {
  return a.gyro == b.gyro && a.accel == b.accel;
}

}  // namespace

HandHeldRateStream::HandHeldRateStream(const Params& params)
    : params_((HandHeldSmoother(params.body), params)),
      rest_detector_(params.body.expert.rest_detector),
      motion_(hand_held::motion_params(params.body)),
      inflated_motion_(hand_held::motion_params(params.body, params.body.expert.jerk_inflation)),
      noise_(hand_held::reading_noise(params.body, params.period_s)),
      g_W_m_s2_(0.0, 0.0, -params.body.gravity_m_s2) {
  require_valid_fields(params);
  require_in_interval("lag_s", params.lag_s, 2.0 * params.period_s, 10.0);
  require_in_interval("window_s", params.window_s, params.lag_s + 4.0 * params.body.expert.node_s, 20.0);
  nodes_max_ = static_cast<std::size_t>(std::lround(params.window_s / params.body.expert.node_s)) + 1;
  delay_ = static_cast<std::size_t>(std::lround(params.lag_s / params.period_s));
  // If samples arrive at more than twice the nominal sample rate, the stream drops the oldest readings.
  readings_max_ = 2 * static_cast<std::size_t>(std::ceil(params.window_s / params.period_s)) + 4;
}

HandHeldRateStream::State HandHeldRateStream::start() const {
  State state;
  state.readings.reserve(readings_max_ + 1);
  state.window.reserve(nodes_max_ + 1);
  state.work_blocks.resize(nodes_max_ + 1);
  return state;
}

void HandHeldRateStream::restart(State& state) const {
  State fresh;
  fresh.readings.swap(state.readings);
  fresh.window.swap(state.window);
  fresh.work_blocks.swap(state.work_blocks);
  fresh.readings.clear();
  fresh.window.clear();
  fresh.failures = state.failures;
  fresh.revolutions_ambiguous = state.revolutions_ambiguous;
  state = std::move(fresh);
}

Status HandHeldRateStream::push(const ImuSample& sample, const SensingAxisClipSigns& known, State& state,
                                std::optional<AngularRateState>& out, bool wanted,
                                const RepeatDetector::State& repeated) const {
  out.reset();
  if (const Status status = check_sample(sample); !status.ok()) return status;
  if (state.samples > 0) {
    const TimeNs before_ns = state.readings.back().sample.time_ns;
    const Status status = check_stamp_order(sample.time_ns, before_ns, params_.body.expert.gap_max_s);
    if (!status.ok()) return status;
  }
  if (known.clip_signs.empty()) return {ErrorCode::out_of_range, "signs", 0.0, 1.0};
  const double determinant = std::abs(known.sensing_directions.determinant());
  if (!(determinant > hand_held::kRowsMin)) return {ErrorCode::degenerate, "rows", determinant, hand_held::kRowsMin};

  append_reading(sample, repeated, state);
  if (update_clip_signs(known, state)) rebuild_window(state);
  const Reading& latest = state.readings.back();
  const auto end = [&] { return state.first_node + static_cast<std::int64_t>(state.window.size()); };
  const bool begun = latest.node >= end();
  while (latest.node > end()) {  // creates time steps (nodes) without samples
    extend_nodes(state);
    predict_newest(state);
  }
  if (begun) extend_nodes(state);
  add(latest, state);
  if (begun) predict_newest(state);
  // While the gyro is unsaturated, the predicted states are accurate, so fewer optimisation steps suffice.
  const bool due =
      begun && (latest.node % hand_held::kFreeNodes == 0 || latest.node < kFirstNodes || has_clipped_reading(state));
  const bool factorised = due && step(state);
  if (due && !factorised) ++state.failures;
  if (wanted && state.readings.size() > delay_) {
    const std::size_t at = state.readings.size() - 1 - delay_;
    out = compute_report(at, due, due && factorised, state);
    count_revolutions(at, *out, state);
  }
  return {};
}

void HandHeldRateStream::extend_nodes(State& state) const {
  if (state.window.size() == nodes_max_) marginalise_oldest(state);
  state.window.emplace_back();
}

void HandHeldRateStream::predict_newest(State& state) const {
  Knot& newest = state.window.back();
  if (state.window.size() == 1) {
    newest.node = first_node(state);
  } else {
    predict(state.window[state.window.size() - 2].node, state.sensing_directions, newest);
  }
}

void HandHeldRateStream::append_reading(const ImuSample& sample, const RepeatDetector::State& repeated,
                                        State& state) const {
  Reading reading;
  reading.sample = sample;
  reading.gyro = repeated.for_triad(Triad::gyro);
  reading.accel = repeated.for_triad(Triad::accelerometer);
  const double period_s = params_.period_s;
  if (state.samples == 0) {
    state.start_ns = sample.time_ns;
    state.stationary_state = {};
  }
  const double since_s = state.samples == 0 ? period_s : seconds(sample.time_ns - state.readings.back().sample.time_ns);
  reading.end_s = seconds(sample.time_ns - state.start_ns) + 0.5 * period_s;
  reading.window_centre_s = reading.end_s - 0.5 * std::min(since_s, 1.5 * period_s);
  const std::int64_t nearest = std::llround(reading.window_centre_s / params_.body.expert.node_s);
  reading.node = std::max(nearest, state.samples == 0 ? 0 : state.readings.back().node);
  reading.is_stationary = rest_detector_.detect_stationary(sample, state.stationary_state);
  if (state.readings.size() == readings_max_) state.readings.erase(state.readings.begin());
  state.readings.push_back(reading);
  ++state.samples;
}

// Returns whether the sensing directions in `known`, or the clip signs of an earlier sample in `known`, differ from
// `state`.
bool HandHeldRateStream::update_clip_signs(const SensingAxisClipSigns& known, State& state) const {
  bool changed = state.sensing_directions != known.sensing_directions;
  state.sensing_directions = known.sensing_directions;
  const std::size_t count = std::min(known.clip_signs.size(), state.readings.size());
  for (std::size_t k = 0; k < count; ++k) {
    Reading& reading = state.readings[state.readings.size() - 1 - k];
    const ClipSigns& signs = known.clip_signs[known.clip_signs.size() - 1 - k];
    changed = changed || (k > 0 && !equal_clip_signs(reading.clip_signs, signs));
    reading.clip_signs = signs;
  }
  return changed;
}

// Adds all readings to the window except the newest reading, which push() adds.
void HandHeldRateStream::rebuild_window(State& state) const {
  for (Knot& knot : state.window) knot.readings = {};
  for (const Reading& reading : std::span(state.readings).first(state.readings.size() - 1)) add(reading, state);
}

// The averaging window of a slow sensor ended at an unknown time after the previous sample: rate_stream.md (R95). A
// slow accelerometer averages over an unknown part of its period: carried.md (C12).
void HandHeldRateStream::add(const Reading& reading, State& state) const {
  const double node_s = params_.body.expert.node_s;
  const auto readings_at = [&](std::int64_t node) -> hand_held::NodeReadings* {
    const std::int64_t at = node - state.first_node;
    const bool inside = at >= 0 && at < static_cast<std::int64_t>(state.window.size());
    return inside ? &state.window[static_cast<std::size_t>(at)].readings : nullptr;
  };
  const auto centre = [&](const RepeatedReading& repeated, double share) {
    const double back = repeated.age_samples + share * repeated.reading_period_samples;
    return repeated.is_slower_than_samples() ? reading.end_s - back * params_.period_s : reading.window_centre_s;
  };
  const auto node_of = [&](const RepeatedReading& repeated, double centre_s) {
    return repeated.is_slower_than_samples() ? std::min(reading.node, std::int64_t{std::llround(centre_s / node_s)})
                                             : reading.node;
  };
  const double rate_s = centre(reading.gyro, 0.5), force_s = centre(reading.accel, 0.25);
  const std::int64_t rate_node = node_of(reading.gyro, rate_s), force_node = node_of(reading.accel, force_s);
  hand_held::NodeReadings* const rates = reading.gyro.repeats_reading ? nullptr : readings_at(rate_node);
  hand_held::NodeReadings* const forces = reading.accel.repeats_reading ? nullptr : readings_at(force_node);
  if (rates != nullptr) {
    const double share =
        reading.gyro.is_slower_than_samples() ? hand_held::kAge_samples / reading.gyro.reading_period_samples : 0.0;
    const Vector3d subsample_sigma_rad_s = share * (state.sensing_directions * reading.gyro.reading_change).cwiseAbs();
    hand_held::add_rate(reading.sample, state.sensing_directions, reading.clip_signs,
                        rate_s - static_cast<double>(rate_node) * node_s, subsample_sigma_rad_s, *rates);
  }
  if (forces != nullptr) {
    const double share = reading.accel.is_slower_than_samples()
                             ? std::hypot(hand_held::kWindowCentreSigmaRatio,
                                          hand_held::kAge_samples / reading.accel.reading_period_samples)
                             : 0.0;
    hand_held::add_force(reading.sample, reading.clip_signs, force_s - static_cast<double>(force_node) * node_s,
                         *forces);
    forces->force_timing_sigma_m_s2 =
        std::max(forces->force_timing_sigma_m_s2, share * reading.accel.reading_change.norm());
  }
  if (hand_held::NodeReadings* const own = readings_at(reading.node))
    own->is_stationary = own->is_stationary || reading.is_stationary;
}

hand_held::ReadingNoise HandHeldRateStream::adapted_noise(const State& state) const {
  const RepeatedReading& gyro = state.readings.back().gyro;
  return gyro.is_slower_than_samples()
             ? hand_held::reading_noise(params_.body, gyro.reading_period_samples * params_.period_s)
             : noise_;
}

Node HandHeldRateStream::first_node(const State& state) const {
  const ImuSample& sample = state.readings.front().sample;
  Node out;
  out.q_WI = so3::shortest_arc(sample.specific_force_m_s2.normalized(), Vector3d::UnitZ());
  out.w_WI_I_rad_s = sample.angular_velocity_rad_s;
  out.a_W_m_s2 = out.q_WI * sample.specific_force_m_s2 + g_W_m_s2_;
  return out;
}

// The rate component of a clipped sensing element is predicted from the previous time step. The magnitude of the
// predicted rate component must be between the saturation level and kFillRatioMax times the saturation level.
void HandHeldRateStream::predict(const Node& before, const Eigen::Matrix3d& rows, Knot& knot) const {
  const double h = params_.body.expert.node_s;
  Node& node = knot.node;
  node = before;
  Vector3d elements = rows * (before.w_WI_I_rad_s + h * before.angular_acceleration_rad_s2);
  for (int j = 0; j < 3; ++j) {
    const hand_held::SensingAxisSums& e = knot.readings.gyro[static_cast<std::size_t>(j)];
    if (e.clipped_reading_count > 0.0) {
      const double rail = std::abs(e.mean_saturation_limit);
      elements[j] =
          e.saturated_side * std::clamp(e.saturated_side * elements[j], rail, hand_held::kFillRatioMax * rail);
    } else if (e.count > 0.0) {
      elements[j] = e.reading_sum / e.count;
    }
  }
  node.w_WI_I_rad_s = rows.inverse() * elements;
  node.q_WI = (before.q_WI * so3::exp(hand_held::rotation_between_nodes(before, node, h))).normalized();
  node.v_W_m_s += h * before.a_W_m_s2;
  node.p_W_m += h * before.v_W_m_s;
  if (knot.readings.force_reading_count > 0.0) node.a_W_m_s2 = node.q_WI * knot.readings.force_m_s2 + g_W_m_s2_;
}

// See carried.md (C40).
double HandHeldRateStream::hand_acceleration_power_ratio(const State& state) const {
  return std::max(
      params_.body.expert.hand_motion.kHandNoiseFloorRatio,
      1.0 + params_.body.expert.hand_motion.hand_noise_adaptation * (state.hand_acceleration_power_ratio - 1.0));
}

// See rate_stream.md (R91).
void HandHeldRateStream::add_prior(const State& state, System::StateBlock& block, System::BorderBlock& corner) const {
  if (state.first_node == 0) {
    (void)motion_.add_initial_prior(state.window.front().node, block);
    (void)hand_held::add_constants_prior(params_.body, state.constants, corner);
    return;
  }
  const System::StateVector x = hand_held::node_difference(state.prior_node, state.window.front().node);
  const System::BorderVector c = constants_difference(state.prior_constants, state.constants);
  block.diagonal += state.prior.diagonal;
  block.border_coupling += state.prior.border_coupling;
  block.gradient += state.prior.gradient - state.prior.diagonal * x - state.prior.border_coupling * c;
  corner.matrix += state.prior_border_block.matrix;
  corner.gradient += state.prior_border_block.gradient - state.prior_border_block.matrix * c -
                     state.prior.border_coupling.transpose() * x;
}

// Replaces the oldest time step by a prior: carried.md (C17), (C40), rate_stream.md (R90).
void HandHeldRateStream::marginalise_oldest(State& state) const {
  store_oldest_rates(state);
  const Knot& oldest = state.window[0];
  const Node& next = state.window[1].node;
  System::StateBlock block, after;
  System::BorderBlock corner;
  add_prior(state, block, corner);
  (void)hand_held::add_node(oldest.readings, state.sensing_directions, adapted_noise(state), g_W_m_s2_, motion_,
                            oldest.node, state.constants, block, corner);
  (void)motion_.add_motion_model(oldest.node, next, hand_acceleration_power_ratio(state), block, after);
  if (System::eliminate(block, &after, corner)) {
    state.prior = after;
    state.prior_border_block = corner;
  } else {
    state.prior = {};
    state.prior_border_block = {};
    (void)motion_.add_initial_prior(next, state.prior);
    (void)hand_held::add_constants_prior(params_.body, state.constants, state.prior_border_block);
    ++state.failures;
  }
  state.prior_node = next;
  state.prior_constants = state.constants;
  const double assumed = 3.0 * params_.body.hand_sigma_m_s2 * params_.body.hand_sigma_m_s2;
  const double share = std::min(1.0, 2.0 * params_.body.expert.node_s / params_.body.expert.hand_motion.kHandWindow_s);
  state.hand_acceleration_power_ratio +=
      share * (oldest.node.a_W_m_s2.squaredNorm() / assumed - state.hand_acceleration_power_ratio);
  ++state.first_node;
  state.window.erase(state.window.begin());
  prune_output_samples(state);
}

void HandHeldRateStream::prune_output_samples(State& state) const {
  std::size_t gone = 0;
  const std::size_t given = first_unreported_reading(state);
  while (gone < given && state.readings[gone].node < state.first_node) ++gone;
  state.readings.erase(state.readings.begin(), state.readings.begin() + static_cast<std::ptrdiff_t>(gone));
}

// See carried.md (C17), (C18).
bool HandHeldRateStream::factorise(const hand_held::Motion& motion, const hand_held::ReadingNoise& noise, State& state,
                                   System::BorderVector& step) const {
  const std::size_t count = state.window.size();
  const double lively = hand_acceleration_power_ratio(state);
  System::BorderBlock corner;
  state.work_blocks[0] = {};
  add_prior(state, state.work_blocks[0], corner);
  for (std::size_t i = 0; i < count; ++i) {
    const Knot& knot = state.window[i];
    System::StateBlock& block = state.work_blocks[i];
    const bool last = i + 1 == count;
    (void)hand_held::add_node(knot.readings, state.sensing_directions, noise, g_W_m_s2_, motion, knot.node,
                              state.constants, block, corner);
    if (!last) {
      state.work_blocks[i + 1] = {};
      (void)motion.add_motion_model(knot.node, state.window[i + 1].node, lively, block, state.work_blocks[i + 1]);
    }
    if (!System::eliminate(block, last ? nullptr : &state.work_blocks[i + 1], corner)) return false;
  }
  return System::solve_border_block(corner, step, state.constants_covariance);
}

// See carried.md (C19).
bool HandHeldRateStream::step(State& state) const {
  System::BorderVector border;
  if (!factorise(motion_, adapted_noise(state), state, border)) return false;
  double turn = 0.0;
  for (std::size_t i = state.window.size(); i-- > 0;) {
    System::StateVector* const next = i + 1 < state.window.size() ? &state.work_blocks[i + 1].gradient : nullptr;
    state.work_blocks[i].gradient = System::back_substitute(state.work_blocks[i], next, border).eval();
    turn = std::max(turn, state.work_blocks[i].gradient.segment<3>(hand_held::kAttitudeError).norm());
  }
  if (!std::isfinite(turn)) return false;
  const double share = turn > kRotationMax_rad ? kRotationMax_rad / turn : 1.0;
  for (std::size_t i = 0; i < state.window.size(); ++i)
    state.window[i].node.move(share * state.work_blocks[i].gradient);
  state.constants.move(share * border);
  return true;
}

}  // namespace tumble
