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

/// Angular velocity of a body that flies, touches or is carried, as a stream: RateStream, which believes in flight and
/// contact, and CarriedStream, joined (`either`) where RegimeEvidence says that a hand may hold the body while its gyro
/// clips. Rails are those that RateStream learns.
///
/// The evidence is a filter over the samples as they are given out, so that each is judged by all of the past and, by
/// its rate, by the lag ahead. The share with which CarriedStream is believed is the least of what is near in the
/// segment of clipped samples, as in the batch, as far as the window shows it. While RateStream drops one rig after
/// another (in more than half of the steps of its lag), clipped samples tell nothing. CarriedStream's work is spared
/// while the evidence says that no hand holds the body (share below `carried_min`); it starts anew after that.
/// Estimates are those of RateStream where nothing clips.
///
/// Clipped rates were fitted to the very force by which they are judged, and so was the angular acceleration of
/// RateStream, also where the gyro reads the rate: where the IMU sits far from the centre of mass, gravity in a gentle
/// hand passes for the lever arm's force. The evidence therefore takes the derivative of the rates themselves.
class RegimeStream {
 public:
  struct Params {
    RateStream::Params rate;
    RegimeEvidence::Params evidence;
    CarriedStream::Params carried;  ///< `period_s` and `lag_s` are those of `rate`
    double carried_min = 0.02;      ///< a share of the carried body below this is not worth its work
    double near_s = 0.1;            ///< clipped samples so close belong to one segment, and judge each other

    /// Every number of it, stated once.
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
  /// Of a sample given out.
  struct Given {
    TimeNs time_ns = 0;
    double carried = 0.0;
  };
  struct State {
    RateStream::State rate;
    CarriedStream::State carried;
    std::vector<ClipSigns> signs;  ///< of RateStream's window: scratch space
    RegimeShares shares{1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0};
    RegimeShares sum{};          ///< of all samples given out
    std::size_t given = 0;       ///< samples given out
    std::size_t joined = 0;      ///< of these, joined with CarriedStream's
    std::size_t starts = 0;      ///< times that CarriedStream was started
    std::size_t rig_resets = 0;  ///< of RateStream, as seen last
    double resets = 0.0;         ///< times that RateStream dropped its rig, forgotten over its lag
    bool carrying = false;       ///< CarriedStream runs
    /// Of the last segment of clipped samples what is within `near_s`, but for what has a lesser share after it: the
    /// first is the least.
    std::vector<Given> near;
    TimeNs given_ns = 0;               ///< of the last sample given out
    std::optional<TimeNs> clipped_ns;  ///< last clipped sample given out
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit RegimeStream(const Params& params);

  /// A state before the first sample, with all memory that push() needs.
  State start() const;

  /// As RateStream::push.
  Status push(const ImuSample& sample, std::span<const AuxiliaryReading> auxiliary_imus, State& state,
              std::optional<RateState>& out) const;
  Status push(const ImuSample& sample, State& state, std::optional<RateState>& out) const {
    return push(sample, {}, state, out);
  }

  /// As RateStream::flush, joined with the shares as they stand.
  void flush(const State& state, std::vector<RateState>& out) const;

  const RateStream& rate() const { return rate_; }
  const Params& params() const { return params_; }

  /// What holds of every state that push() left, for one that comes from elsewhere; the first that does not.
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
