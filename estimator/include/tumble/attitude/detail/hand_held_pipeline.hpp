// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/repeat_detector.hpp"
#include "tumble/angular_velocity/detail/streaming_clipping_finder.hpp"
#include "tumble/attitude/detail/hand_held_stream.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Estimates the angular velocity of a body that is known to be hand-held, from a single IMU. HandHeldPipeline detects
/// the saturation limits that HandHeldRateStream needs as input.
class HandHeldPipeline {
 public:
  struct Params {
    HandHeldRateStream::Params stream;
    StreamingClippingFinder::Params clipping_finder;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.stream);
      visit.group("clipping_", p.clipping_finder);
    }
  };
  struct State {
    HandHeldRateStream::State stream;
    StreamingClippingFinder::State clipping_state;
    RepeatDetector::State repetition_state;
    bool saturation_limits_changed = false;  ///< true if the last sample changed the known saturation limits
    std::vector<ClipSigns> clip_signs;       ///< buffer, not part of the state
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit HandHeldPipeline(const Params& params);

  State start() const;

  /// `out` is the rate of the sample that is `lag_s` old, and is empty while the window fills. On error (`non_finite`,
  /// `time_order`, `gap`), the saturation limits are unchanged and `out` is empty.
  Status push(const ImuSample& sample, State& state, std::optional<AngularRateState>& out) const;

  /// Appends the rates of the samples in the window that were not yet reported, oldest first.
  void flush(const State& state, std::vector<AngularRateState>& out) const { stream_.flush(state.stream, out); }

 private:
  void classify_window_clipping(const ImuSample& next, State& state) const;

  HandHeldRateStream stream_;
  StreamingClippingFinder clipping_finder_;
};

}  // namespace tumble
