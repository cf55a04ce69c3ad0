// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/hand_held_pipeline.hpp"

#include "tumble/common/imu.hpp"

namespace tumble {

namespace {

/// A sensing element without a known plane of saturated readings is assumed to be parallel to its output axis.
Eigen::Matrix3d rows_of(const RailPlanes& planes) {
  Eigen::Matrix3d out = Eigen::Matrix3d::Identity();
  for (int j = 0; j < 3; ++j) {
    const std::optional<RailPlane>& plane = planes.element[static_cast<std::size_t>(j)];
    if (plane) out.row(j) = plane->row.transpose();
  }
  return out;
}

}  // namespace

HandHeldPipeline::HandHeldPipeline(const Params& params) : stream_(params.stream), clipping_finder_(params.rails) {}

HandHeldPipeline::State HandHeldPipeline::start() const {
  State state;
  state.stream = stream_.start();
  state.rails = clipping_finder_.start();
  return state;
}

Status HandHeldPipeline::push(const ImuSample& sample, State& state, std::optional<RateState>& out) const {
  out.reset();
  if (const Status status = check_sample(sample); !status.ok()) return status;
  state.signs.clear();
  classify_window(sample, state);
  const ImuSample* const latest = state.stream.readings.empty() ? nullptr : &state.stream.readings.back().sample;
  const Clipping judged = clipping_finder_.classify(latest, sample, state.rails);
  state.signs.push_back(clip_signs(sample, judged));
  RepeatDetector::State repeat_state = state.repeat_state;
  RepeatDetector().observe(sample, (judged.gyro | judged.unusable_gyro) != 0, repeat_state);
  const ClippedElements known{rows_of(state.rails.known.planes), state.signs};
  const Status status = stream_.push(sample, known, state.stream, out, true, repeat_state);
  if (!status.ok()) return status;
  state.repeat_state = repeat_state;
  state.levels_changed = clipping_finder_.observe(sample, state.rails);
  clipping_finder_.axis_aligned_rails().classify(sample, state.rails.known.axis_aligned_rails);
  return status;
}

/// After a change of the saturation levels, all samples in the window of HandHeldStream are classified again.
void HandHeldPipeline::classify_window(const ImuSample& next, State& state) const {
  const std::vector<HandHeldStream::Reading>& window = state.stream.readings;
  RailDetector::State& axis_aligned_rails = state.rails.known.axis_aligned_rails;
  if (state.levels_changed) {
    for (RailDetector::Channel& channel : axis_aligned_rails.channels) channel.clipped = false;
  }
  for (std::size_t k = state.levels_changed || window.empty() ? 0 : window.size() - 1; k < window.size(); ++k) {
    const ImuSample* const before = k > 0 ? &window[k - 1].sample : nullptr;
    const ImuSample& after = k + 1 < window.size() ? window[k + 1].sample : next;
    state.signs.push_back(
        clip_signs(window[k].sample, clipping_finder_.classify(before, window[k].sample, state.rails, &after)));
    if (state.levels_changed) clipping_finder_.axis_aligned_rails().classify(window[k].sample, axis_aligned_rails);
  }
}

}  // namespace tumble
