// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/hand_held_stream.hpp"
#include "tumble/attitude/regimes.hpp"
#include "tumble/attitude/spin_tracker.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Estimates the angular velocity of a body in flight, in contact, hand-held or in a steady spin, sample by sample.
/// RateStream estimates the rates under the assumption of flight and contact, and detects the saturation limits.
/// HandHeldStream estimates the rates again where the body is probably hand-held while the gyro clips. RegimeStream
/// combines the two rate estimates by the probability of hand-held motion. SpinTracker then replaces the rate of a
/// saturated axis during a steady spin, from the samples up to the reported sample.
///
/// A filter over the reported samples estimates the probabilities of flight, contact and hand-held motion. The
/// probabilities depend on earlier samples and, through the smoothed rate, on later samples within the lag. The weight
/// of HandHeldStream is the smallest probability of hand-held motion in the clipped segment, as in RegimeSmoother. If
/// RateStream resets its calibration in more than half of the steps within its lag, the body is probably not in flight.
/// Clipped samples then do not change the probabilities. HandHeldStream pauses while the probability of hand-held
/// motion is below `hand_held_probability_min`, and then restarts. RegimeStream reports RateStream's rate for each
/// unclipped sample.
///
/// RateStream fits angular accelerations to the measured force. In gentle hand-held motion, such an angular
/// acceleration can wrongly explain gravity. RegimeStream therefore estimates the probabilities with the time
/// derivative of the rates instead of RateStream's angular accelerations.
class RegimeStream {
 public:
  struct Params {
    RateStream::Params rate;
    RegimeEvidence::Params evidence;
    HandHeldStream::Params hand_held;  ///< `rate` overrides `period_s` and `lag_s`
    SpinTracker::Params spin;
    double hand_held_probability_min = 0.02;  ///< minimum probability of hand-held motion for which HandHeldStream runs
    double segment_gap_max_s = 0.1;           ///< clipped samples closer together than this form one segment

    /// Calls `visit` once for each parameter, with its value, name, unit, bounds and meaning.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("evidence_", p.evidence);
      visit.group("carried_", p.hand_held);
      visit.group("spin_", p.spin);
      visit(p.hand_held_probability_min,
            {"hand_held_probability_min", "1", 0.0, 1.0,
             "the smoother for hand-held motion runs if the probability of hand-held motion exceeds this value"});
      visit(p.segment_gap_max_s, {"segment_gap_max_s", "s", 0.0, 10.0,
                                  "clipped samples that are less than this time apart belong to one segment"});
    }
  };
  /// ReportedProbability is the probability of hand-held motion at the time of a reported sample.
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
    /// Samples that may determine the smallest probability of hand-held motion within the last `segment_gap_max_s`. The
    /// oldest entry of `near` has the smallest probability.
    std::vector<ReportedProbability> near;
    TimeNs reported_ns = 0;            ///< time of the last reported sample
    std::optional<TimeNs> clipped_ns;  ///< last reported clipped sample
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RegimeStream(const Params& params);

  /// Returns the state before the first sample, with all memory that push() needs.
  State start() const;

  /// Processes one sample like RateStream::push(), and combines the rate with the rate of HandHeldStream.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<RateState>& out) const;
  Status push(const ImuSample& sample, State& state, std::optional<RateState>& out) const {
    return push(sample, {}, state, out);
  }

  /// Appends the rates of the samples in the window to `out`, combined by the current probabilities.
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
