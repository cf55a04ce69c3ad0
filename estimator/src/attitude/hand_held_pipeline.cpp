// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_pipeline.hpp"

#include "tumble/common/types.hpp"

namespace tumble {

namespace {

/// A sensing element without a known plane of saturated readings is assumed to be parallel to its output axis.
Eigen::Matrix3d sensing_directions_of(const SaturationPlanes& planes) {
  Eigen::Matrix3d out = Eigen::Matrix3d::Identity();
  for (int j = 0; j < 3; ++j) {
    const std::optional<SaturationPlane>& plane = planes.sensing_axis[static_cast<std::size_t>(j)];
    if (plane) out.row(j) = plane->row.transpose();
  }
  return out;
}

}  // namespace

HandHeldPipeline::HandHeldPipeline(const Params& params)
    : stream_(params.stream), clipping_finder_(params.clipping_finder) {}

HandHeldPipeline::State HandHeldPipeline::start() const {
  State state;
  state.stream = stream_.start();
  state.clipping_state = clipping_finder_.start();
  return state;
}

Status HandHeldPipeline::push(const ImuSample& sample, State& state, std::optional<AngularRateState>& out) const {
  out.reset();
  if (const Status status = check_sample(sample); !status.ok()) return status;
  state.clip_signs.clear();
  classify_window_clipping(sample, state);
  const ImuSample* const latest = state.stream.readings.empty() ? nullptr : &state.stream.readings.back().sample;
  const Clipping judged = clipping_finder_.classify_clipping(latest, sample, state.clipping_state);
  state.clip_signs.push_back(clip_signs(sample, judged));
  RepeatDetector::State repeat_state = state.repetition_state;
  RepeatDetector().observe_reading(sample, (judged.gyro | judged.unusable_gyro) != 0, repeat_state);
  const SensingAxisClipSigns known{sensing_directions_of(state.clipping_state.known_limits.gyro_planes),
                                   state.clip_signs};
  const Status status = stream_.push(sample, known, state.stream, out, true, repeat_state);
  if (!status.ok()) return status;
  state.repetition_state = repeat_state;
  state.saturation_limits_changed = clipping_finder_.observe_reading(sample, state.clipping_state);
  clipping_finder_.axis_limit_detector().classify_clipping(sample, state.clipping_state.known_limits.axis_limit_state);
  return status;
}

/// After a change of the saturation levels, all samples in the window of HandHeldRateStream are classified again.
void HandHeldPipeline::classify_window_clipping(const ImuSample& next, State& state) const {
  const std::vector<HandHeldRateStream::Reading>& window = state.stream.readings;
  SaturationLimitDetector::State& axis_aligned_rails = state.clipping_state.known_limits.axis_limit_state;
  if (state.saturation_limits_changed) {
    for (SaturationLimitDetector::Channel& channel : axis_aligned_rails.channels) channel.is_clipped = false;
  }
  for (std::size_t k = state.saturation_limits_changed || window.empty() ? 0 : window.size() - 1; k < window.size();
       ++k) {
    const ImuSample* const before = k > 0 ? &window[k - 1].sample : nullptr;
    const ImuSample& after = k + 1 < window.size() ? window[k + 1].sample : next;
    state.clip_signs.push_back(clip_signs(
        window[k].sample, clipping_finder_.classify_clipping(before, window[k].sample, state.clipping_state, &after)));
    if (state.saturation_limits_changed)
      clipping_finder_.axis_limit_detector().classify_clipping(window[k].sample, axis_aligned_rails);
  }
}

}  // namespace tumble
