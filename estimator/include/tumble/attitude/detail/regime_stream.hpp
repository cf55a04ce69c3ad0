// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/detail/hand_held_stream.hpp"
#include "tumble/attitude/detail/regime_params.hpp"
#include "tumble/attitude/detail/spin_tracker.hpp"

namespace tumble {

/// Estimates the angular velocity of a body in flight, in contact or hand-held, sample by sample, with a fixed lag.
/// AngularRateStream estimates the rates for flight and contact, and detects the saturation limits. HandHeldRateStream
/// estimates the rates of clipped samples for hand-held motion. Both rates of a clipped sample are combined by the
/// probability of hand-held motion. Unclipped samples have the rate of AngularRateStream. SpinTracker replaces the rate
/// of a saturated axis during a steady spin.
///
/// HandHeldRateStream runs only while the probability of hand-held motion is at least `hand_held_probability_min`.
class MotionRegimeStream {
 public:
  struct Params : MotionRegimeParams {
    AngularRateStream::Params rate;
    HandHeldRateStream::Params hand_held;  ///< `rate` overrides `period_s` and `lag_s`

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("carried_", p.hand_held);
      MotionRegimeParams::fields(p, visit);
    }
  };
  struct ReportedRegimeProbability {
    TimeNs time_ns = 0;
    double hand_held = 0.0;
  };
  struct State {
    AngularRateStream::State rate;
    HandHeldRateStream::State hand_held;
    SpinTracker::State spin;
    std::size_t spin_samples = 0;       ///< saturated samples that are probably in a steady spin
    std::vector<ClipSigns> clip_signs;  ///< buffer
    RegimeProbabilities probabilities{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    RegimeProbabilities regime_probability_sum{};
    std::size_t reported_sample_count = 0;
    std::size_t combined_samples = 0;  ///< number of samples whose rate includes the result of HandHeldRateStream
    std::size_t hand_held_start_count = 0;
    std::size_t calibration_reset_count = 0;
    double calibration_reset_rate =
        0.0;  ///< number of calibration resets of AngularRateStream, decaying with the time constant `rate.lag_s`
    bool hand_held_stream_running = false;
    /// probabilities of hand-held motion in the last `kSegmentGapMax_s`; the oldest entry is the smallest
    std::vector<ReportedRegimeProbability> recent_probabilities;
    TimeNs reported_ns = 0;
    std::optional<TimeNs> clipped_ns;
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit MotionRegimeStream(const Params& params);

  /// The returned state has all memory that push() needs.
  State start() const;

  /// Processes one sample; arguments and errors are those of AngularRateStream::push().
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<AngularRateState>& out) const;
  Status push(const ImuSample& sample, State& state, std::optional<AngularRateState>& out) const {
    return push(sample, {}, state, out);
  }

  /// Appends the rates at those samples in the window that were not yet returned, oldest first.
  void flush(const State& state, std::vector<AngularRateState>& out) const;

  const AngularRateStream& rate() const { return rate_; }
  const Params& params() const { return params_; }

 private:
  SensingAxisClipSigns update_clip_signs(State& state) const;
  std::size_t index_of(const AngularRateState& rate, const State& state) const;
  bool calibration_is_unstable(const State& state) const;
  RegimeProbabilities next(const RegimeProbabilities& before, double dt_s,
                           std::span<const AngularRateStream::Knot> window, std::size_t k,
                           const BodyImuCalibration& rig, bool unstable) const;
  void update_probabilities(const AngularRateState& rate, State& state) const;
  double hand_held_weight(const AngularRateState& rate, State& state) const;
  void flush_hand_held_rates(std::span<AngularRateState> out, State& last) const;
  SpinRate track_spin(const AngularRateState& rate, State& state) const;

  Params params_;
  AngularRateStream rate_;
  MotionRegimeEvidence regime_evidence_;
  HandHeldRateStream hand_held_;
  SpinTracker spin_;
};

}  // namespace tumble
