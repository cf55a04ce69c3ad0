// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/regime_stream.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace tumble {

namespace {

// half of the time between two rates whose difference gives an angular acceleration; equal to kModelError_s of the rate
// model
constexpr double kAccelerationSpan_s = 0.01;
constexpr double kResetFraction = 0.5;

HandHeldRateStream::Params with_common_params(const MotionRegimeStream::Params& params) {
  HandHeldRateStream::Params out = params.hand_held;
  out.period_s = params.rate.period_s;
  out.lag_s = params.rate.lag_s;
  out.window_s = std::max(out.window_s, out.lag_s + 4.0 * out.body.expert.node_s);
  // The longest accepted data gap is limited, so that each sample is reported while the sample is in the window of
  // HandHeldRateStream.
  out.body.expert.gap_max_s = std::min(out.body.expert.gap_max_s, out.window_s - out.lag_s);
  return out;
}

bool clips(const AngularRateStream::Knot& knot) {
  return (knot.observation.unmeasured_axes() | knot.observation.partly_saturated_axes()) != 0;
}

// Possibly saturated readings count as clipped, because possibly saturated readings are also lower bounds of the rate.
ClipSigns clip_signs_of(const AngularRateObservation& observation) {
  Clipping clipping = observation.clipping;
  clipping.gyro = static_cast<std::uint8_t>(clipping.gyro | observation.partly_saturated_axes());
  return clip_signs(observation.sample, clipping);
}

// `share` is the weight of HandHeldRateStream's rate in the mixed rate.
AngularRateState mixed_rate(const AngularRateState& rate, const AngularRateState& hand_held, double share) {
  AngularRateState out = mix_rate_states(rate, hand_held, share);
  out.clipped_axes = rate.clipped_axes;
  if (rate.source == AngularRateSource::lower_bound_only && out.source == AngularRateSource::measured)
    out.source = rate.source;
  return out;
}

// Computes the angular acceleration from rate differences: carried.md (C43). The regime test compares rates with the
// specific force. The angular acceleration from AngularRateStream is unsuitable for a comparison with the specific
// force, because AngularRateStream also uses the specific force.
Eigen::Vector3d angular_acceleration(std::span<const AngularRateStream::Knot> window, std::size_t k) {
  const auto between_s = [&](std::size_t from, std::size_t to) {
    return seconds(window[to].observation.sample.time_ns - window[from].observation.sample.time_ns);
  };
  std::size_t a = k, b = k;
  while (b + 1 < window.size() && between_s(k, b) < kAccelerationSpan_s) ++b;
  while (a > 0 && between_s(a, k) < kAccelerationSpan_s) --a;
  const double dt_s = between_s(a, b);
  if (!(dt_s > 0.0)) return Eigen::Vector3d::Zero();
  return (window[b].estimate.knot.rate_rad_s - window[a].estimate.knot.rate_rad_s) / dt_s;
}

}  // namespace

MotionRegimeStream::MotionRegimeStream(const Params& params)
    : params_(params),
      rate_(params.rate),
      regime_evidence_(params.evidence),
      hand_held_(with_common_params(params)),
      spin_(params.spin) {
  require_valid_fields(params);
}

MotionRegimeStream::State MotionRegimeStream::start() const {
  State state;
  state.rate = rate_.start();
  state.hand_held = hand_held_.start();
  state.clip_signs.reserve(state.rate.window.capacity());
  state.recent_probabilities.reserve(
      static_cast<std::size_t>(std::ceil(params_.kSegmentGapMax_s / params_.rate.period_s)) + 2);
  return state;
}

Status MotionRegimeStream::push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
                                std::optional<AngularRateState>& out) const {
  if (const Status status = rate_.push(sample, auxiliary_imus, state.rate, out); !status.ok()) return status;
  double share = 0.0;
  if (out) {
    update_probabilities(*out, state);
    share = hand_held_weight(*out, state);
  }
  std::optional<AngularRateState> hand_held;
  // AngularRateStream has already accepted the sample, so HandHeldRateStream fails only if the gyro's sensing
  // directions are almost linearly dependent.
  if (state.probabilities.hand_held >= params_.hand_held_probability_min) {
    if (!state.hand_held_stream_running) {
      hand_held_.restart(state.hand_held);
      state.hand_held_stream_running = true;
      ++state.hand_held_start_count;
    }
    const bool wanted = share > params_.hand_held_probability_min;
    ImuSample without_offset = sample;
    without_offset.angular_velocity_rad_s -= params_.rate.model.nominal.gyro_bias_rad_s;
    state.hand_held_stream_running = hand_held_
                                         .push(without_offset, update_clip_signs(state), state.hand_held, hand_held,
                                               wanted, state.rate.repetition_state)
                                         .ok();
  } else {
    state.hand_held_stream_running = false;
  }
  if (share > params_.hand_held_probability_min && hand_held && hand_held->time_ns == out->time_ns) {
    *out = mixed_rate(*out, *hand_held, share);
    ++state.combined_samples;
  }
  if (out) {
    const SpinRate spin = track_spin(*out, state);
    *out = spin_.combine_with_spin_rate(*out, spin, !params_.rate.model.auxiliary_imus.empty());
    if (spin.saturated && spin.probability > 0.5) ++state.spin_samples;
  }
  return {};
}

SpinRate MotionRegimeStream::track_spin(const AngularRateState& rate, State& state) const {
  const AngularRateObservation& observation = state.rate.window[index_of(rate, state)].observation;
  const auto saturated = static_cast<std::uint8_t>(observation.unmeasured_axes() | observation.partly_saturated_axes() |
                                                   observation.clipping.accel << 3);
  return spin_.step(observation.sample, saturated, state.spin, !params_.rate.model.auxiliary_imus.empty());
}

SensingAxisClipSigns MotionRegimeStream::update_clip_signs(State& state) const {
  state.clip_signs.clear();
  for (const AngularRateStream::Knot& knot : state.rate.window)
    state.clip_signs.push_back(clip_signs_of(knot.observation));
  const SaturationPlanes& planes = state.rate.clipping_state.known_limits.gyro_planes;
  return {sensing_directions(planes, 0.0).sensing_directions, state.clip_signs};
}

RegimeProbabilities MotionRegimeStream::next(const RegimeProbabilities& before, double dt_s,
                                             std::span<const AngularRateStream::Knot> window, std::size_t k,
                                             const BodyImuCalibration& rig, bool unstable) const {
  const AngularRateStream::Knot& knot = window[k];
  // An unstable estimate of the lever arm was probably fitted to contact forces, and then agrees with the specific
  // force in any motion. Clipped samples therefore do not change the probabilities while the calibration is unstable.
  if (unstable && knot.observation.unmeasured_axes() != 0) return before;
  AngularRateState rate;
  rate.w_WI_I_rad_s = knot.estimate.knot.rate_rad_s;
  rate.covariance_rad2_s2 = knot.covariance_rad2_s2;
  rate.clipped_axes = static_cast<std::uint8_t>(knot.observation.unmeasured_axes());
  return regime_evidence_.next(before, dt_s, knot.observation.sample, rate, angular_acceleration(window, k),
                               rig.constants.lever_arm_m, rig.covariance.topLeftCorner<3, 3>());
}

std::size_t MotionRegimeStream::index_of(const AngularRateState& rate, const State& state) const {
  const std::vector<AngularRateStream::Knot>& window = state.rate.window;
  std::size_t k = 0;
  while (k + 1 < window.size() && window[k].observation.sample.time_ns < rate.time_ns) ++k;
  return k;
}

// Repeated resets of the calibration indicate motion without free flight.
bool MotionRegimeStream::calibration_is_unstable(const State& state) const {
  const AngularRateStream::Params& rate = params_.rate;
  return state.calibration_reset_rate > kResetFraction * rate.lag_s / std::max(rate.period_s, rate.step_s);
}

// Updates the probabilities of the motion regimes: forward recursion of carried.md (C37).
void MotionRegimeStream::update_probabilities(const AngularRateState& rate, State& state) const {
  const double dt_s =
      state.reported_sample_count == 0 ? MotionRegimeEvidence::kMemory_s : seconds(rate.time_ns - state.reported_ns);
  state.probabilities = next(state.probabilities, dt_s, state.rate.window, index_of(rate, state),
                             rate_.body_imu_calibration(state.rate), calibration_is_unstable(state));
  const auto dropped = static_cast<double>(state.rate.calibration_reset_count - state.calibration_reset_count);
  state.calibration_reset_count = state.rate.calibration_reset_count;
  state.calibration_reset_rate = std::exp(-dt_s / params_.rate.lag_s) * state.calibration_reset_rate + dropped;
  state.reported_ns = rate.time_ns;
  ++state.reported_sample_count;
  state.regime_probability_sum.flight += state.probabilities.flight;
  state.regime_probability_sum.contact += state.probabilities.contact;
  state.regime_probability_sum.hand_held += state.probabilities.hand_held;
}

// Returns the weight of HandHeldRateStream's rate in the reported rate, from equation (C39) of carried.md.
double MotionRegimeStream::hand_held_weight(const AngularRateState& rate, State& state) const {
  const auto near_ns = static_cast<TimeNs>(std::llround(1e9 * params_.kSegmentGapMax_s));
  const std::vector<AngularRateStream::Knot>& window = state.rate.window;
  const std::size_t here = index_of(rate, state);
  if (clips(window[here])) state.clipped_ns = rate.time_ns;
  const bool after = state.clipped_ns && rate.time_ns - *state.clipped_ns <= near_ns;
  const auto next_clipped = std::find_if(window.begin() + static_cast<std::ptrdiff_t>(here), window.end(), clips);
  const TimeNs next_ns = next_clipped == window.end() ? 0 : next_clipped->observation.sample.time_ns;
  const bool before = next_clipped != window.end() && next_ns - rate.time_ns <= near_ns;
  const bool within = after && before && next_ns - *state.clipped_ns <= near_ns;
  std::erase_if(state.recent_probabilities, [&](const ReportedRegimeProbability& reported) {
    return reported.time_ns < rate.time_ns - near_ns || (within && reported.hand_held >= state.probabilities.hand_held);
  });
  if (within) state.recent_probabilities.push_back({rate.time_ns, state.probabilities.hand_held});
  if (!after && !before) return 0.0;
  double out = state.recent_probabilities.empty() ? 1.0 : state.recent_probabilities.front().hand_held;
  if (out < params_.hand_held_probability_min || !before) return out;
  // Samples after the reported sample change only a copy of the probabilities, because the rates of these samples are
  // not final.
  RegimeProbabilities probabilities = state.probabilities;
  const BodyImuCalibration rig = rate_.body_imu_calibration(state.rate);
  const bool unstable = calibration_is_unstable(state);
  for (std::size_t k = here + 1; k < window.size(); ++k) {
    const TimeNs now_ns = window[k].observation.sample.time_ns;
    if (now_ns - rate.time_ns > near_ns) break;
    probabilities =
        next(probabilities, seconds(now_ns - window[k - 1].observation.sample.time_ns), window, k, rig, unstable);
    if (clips(window[k])) out = std::min(out, probabilities.hand_held);
  }
  return out;
}

void MotionRegimeStream::flush(const State& state, std::vector<AngularRateState>& out) const {
  const std::size_t first = out.size();
  rate_.flush(state.rate, out);
  State last = state;
  flush_hand_held_rates(std::span(out).subspan(first), last);
  for (AngularRateState& rate : std::span(out).subspan(first)) {
    const SpinRate spin = track_spin(rate, last);
    rate = spin_.combine_with_spin_rate(rate, spin, !params_.rate.model.auxiliary_imus.empty());
  }
}

void MotionRegimeStream::flush_hand_held_rates(std::span<AngularRateState> out, State& last) const {
  if (!last.hand_held_stream_running || !(last.probabilities.hand_held > params_.hand_held_probability_min)) return;
  std::vector<AngularRateState> hand_held;
  hand_held_.flush(last.hand_held, hand_held);
  const std::size_t count = std::min(out.size(), hand_held.size());
  for (std::size_t k = 0; k < count; ++k) {
    AngularRateState& rate = out[out.size() - count + k];
    const AngularRateState& other = hand_held[hand_held.size() - count + k];
    const double share = hand_held_weight(rate, last);
    if (share > params_.hand_held_probability_min && rate.time_ns == other.time_ns)
      rate = mixed_rate(rate, other, share);
  }
}

}  // namespace tumble
