// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "tumble/angular_velocity/rate_stream.hpp"
#include "tumble/attitude/carried_stream.hpp"
#include "tumble/attitude/regimes.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// Estimates the angular velocity of a body in flight, in contact or hand-held, sample by sample. RateStream assumes
/// flight and contact. CarriedStream is combined with it (`either`) where RegimeEvidence indicates hand-held motion
/// while the gyro clips. Saturation levels are those that RateStream detects.
///
/// The evidence is a filter over the reported samples. Each sample is therefore judged by the past and, through its
/// rate, by the lag ahead. The weight of CarriedStream is the smallest nearby value in the segment of clipped samples,
/// as in RegimeSmoother, within the window. While RateStream resets its calibration repeatedly (in more than half of
/// the steps of its lag), clipped samples are not used. CarriedStream is paused while the hand-held probability is
/// below `carried_min`, and restarts afterwards. Unclipped estimates are those of RateStream.
///
/// RateStream fits clipped rates, and all angular accelerations, to the same force by which the regime is judged. For
/// an IMU far from the centre of mass, gravity in gentle hand-held motion is then mistaken for the lever arm's force.
/// The evidence therefore uses the time derivative of the rates instead.
class RegimeStream {
 public:
  struct Params {
    RateStream::Params rate;
    RegimeEvidence::Params evidence;
    CarriedStream::Params carried;  ///< `period_s` and `lag_s` are those of `rate`
    double carried_min = 0.02;      ///< minimum probability of hand-held motion for which CarriedStream runs
    double near_s = 0.1;            ///< clipped samples within this time form one segment and affect each other

    /// Visits every parameter: its value, name, unit, bounds and meaning (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.rate);
      visit.group("evidence_", p.evidence);
      visit.group("carried_", p.carried);
      visit(p.carried_min,
            {"carried_min", "1", 0.0, 1.0, "least probability of hand-held motion for which its smoother runs"});
      visit(p.near_s, {"near_s", "s", 0.0, 10.0, "clipped samples within this time belong to one segment"});
    }
  };
  /// Data of a reported sample.
  struct Given {
    TimeNs time_ns = 0;
    double carried = 0.0;
  };
  struct State {
    RateStream::State rate;
    CarriedStream::State carried;
    std::vector<ClipSigns> signs;  ///< of RateStream's window; buffer
    RegimeShares shares{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    RegimeShares sum{};          ///< sum over all reported samples
    std::size_t given = 0;       ///< number of reported samples
    std::size_t joined = 0;      ///< of these, combined with CarriedStream
    std::size_t starts = 0;      ///< number of starts of CarriedStream
    std::size_t rig_resets = 0;  ///< last value of RateStream's counter
    double resets = 0.0;         ///< resets of RateStream's calibration, decaying over its lag
    bool carrying = false;       ///< CarriedStream is running
    /// Samples of the last clipped segment within `near_s`, without those followed by a smaller probability. The first
    /// has the smallest.
    std::vector<Given> near;
    TimeNs given_ns = 0;               ///< of the last reported sample
    std::optional<TimeNs> clipped_ns;  ///< last reported clipped sample
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit RegimeStream(const Params& params);

  /// Returns the state before the first sample, with all memory that push() needs.
  State start() const;

  /// Same as RateStream::push.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<RateState>& out) const;
  Status push(const ImuSample& sample, State& state, std::optional<RateState>& out) const {
    return push(sample, {}, state, out);
  }

  /// Same as RateStream::flush, combined with the current probabilities.
  void flush(const State& state, std::vector<RateState>& out) const;

  const RateStream& rate() const { return rate_; }
  const Params& params() const { return params_; }

  /// Checks the invariants of a state that was loaded from outside. Returns the first violation.
  Status check_state(const State& state) const;

 private:
  ClippedElements known_of(State& state) const;
  std::size_t index_of(const RateState& rate, const State& state) const;
  bool doubts(const State& state) const;
  RegimeShares next(const RegimeShares& before, double dt_s, std::span<const RateStream::Knot> window, std::size_t k,
                    const RigCalibration& rig, bool doubted) const;
  void judge(const RateState& rate, State& state) const;
  double share_of(const RateState& rate, State& state) const;

  Params params_;
  RateStream rate_;
  RegimeEvidence evidence_;
  CarriedStream carried_;
};

}  // namespace tumble
