// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/detail/hand_held_stream.hpp"
#include "tumble/attitude/detail/regime_params.hpp"
#include "tumble/attitude/detail/regimes.hpp"
#include "tumble/attitude/detail/spin_tracker.hpp"

namespace tumble {

/// Estimates the angular velocity of a body in flight, in contact or hand-held, sample by sample, with a fixed lag.
/// RateStream estimates the rates for flight and contact, and detects the saturation limits. Where the body is probably
/// hand-held while the gyro clips, HandHeldStream estimates the rates for hand-held motion. RegimeStream combines the
/// rates of RateStream and HandHeldStream by the probability of hand-held motion. An unclipped sample always has the
/// rate of RateStream.
/// SpinTracker replaces the rate of a saturated axis during a steady spin.
///
/// HandHeldStream runs only while the probability of hand-held motion is at least `hand_held_probability_min`.
class RegimeStream {
 public:
  struct Params : RegimeParams {
    RateStream::Params rate;
    HandHeldStream::Params hand_held;  ///< `rate` overrides `period_s` and `lag_s`

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("carried_", p.hand_held);
      RegimeParams::fields(p, visit);
    }
  };
  struct ReportedProbability {
    TimeNs time_ns = 0;
    double hand_held = 0.0;
  };
  struct State {
    RateStream::State rate;
    HandHeldStream::State hand_held;
    SpinTracker::State spin;
    std::size_t spin_samples = 0;  ///< number of reported saturated samples that are probably in a steady spin
    std::vector<ClipSigns> signs;  ///< clip signs of RateStream's window; buffer
    RegimeProbabilities probabilities{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    RegimeProbabilities sum{};         ///< sum over all reported samples
    std::size_t reported = 0;          ///< number of reported samples
    std::size_t combined_samples = 0;  ///< number of reported samples combined with HandHeldStream
    std::size_t starts = 0;            ///< number of starts of HandHeldStream
    std::size_t rig_resets = 0;        ///< last value of RateStream's counter of calibration resets
    double resets = 0.0;  ///< number of calibration resets of RateStream, decaying with the time constant `rate.lag_s`
    bool hand_held_running = false;  ///< true if HandHeldStream is running
    /// probabilities of hand-held motion in the last `segment_gap_max_s`; the oldest entry is the smallest
    std::vector<ReportedProbability> near;
    TimeNs reported_ns = 0;            ///< time of the last reported sample
    std::optional<TimeNs> clipped_ns;  ///< last reported clipped sample
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RegimeStream(const Params& params);

  /// The returned state has all memory that push() needs.
  State start() const;

  /// Processes one sample like RateStream::push(), and combines the rates of RateStream and HandHeldStream.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<RateState>& out) const;
  Status push(const ImuSample& sample, State& state, std::optional<RateState>& out) const {
    return push(sample, {}, state, out);
  }

  /// Appends the rates of the samples in the window that were not yet reported, oldest first.
  void flush(const State& state, std::vector<RateState>& out) const;

  const RateStream& rate() const { return rate_; }
  const Params& params() const { return params_; }

 private:
  ClippedElements update_clip_signs(State& state) const;
  std::size_t index_of(const RateState& rate, const State& state) const;
  bool calibration_is_unstable(const State& state) const;
  RegimeProbabilities next(const RegimeProbabilities& before, double dt_s, std::span<const RateStream::Knot> window,
                           std::size_t k, const RigCalibration& rig, bool unstable) const;
  void update_probabilities(const RateState& rate, State& state) const;
  double hand_held_weight(const RateState& rate, State& state) const;
  void flush_hand_held(std::span<RateState> out, State& last) const;
  SpinRate track_spin(const RateState& rate, State& state) const;

  Params params_;
  RateStream rate_;
  RegimeEvidence evidence_;
  HandHeldStream hand_held_;
  SpinTracker spin_;
};

}  // namespace tumble
