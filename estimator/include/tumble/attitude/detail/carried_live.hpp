// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "tumble/angular_velocity/detail/hold_watch.hpp"
#include "tumble/angular_velocity/detail/rail_watch.hpp"
#include "tumble/attitude/carried_stream.hpp"
#include "tumble/common/parameters.hpp"

namespace tumble {

/// CarriedStream, which has to be told what is at a rail, with what its samples have shown of the rails: angular
/// velocity of a body that is known to be carried, from one IMU alone. With each rail that becomes known the window is
/// read again. Not modelled: a body that flies or touches, which RegimeStream tells apart.
class CarriedLive {
 public:
  struct Params {
    CarriedStream::Params stream;
    RailWatch::Params rails;

    /// Visits every parameter: its value, name, unit, bounds and meaning (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit.group("", p.stream);
      visit.group("clipping_", p.rails);
    }
  };
  struct State {
    CarriedStream::State stream;
    RailWatch::State rails;
    HoldWatch::State holds;
    bool news = false;             ///< of the rails, by the last sample
    std::vector<ClipSigns> signs;  ///< scratch space, no part of the state proper
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit CarriedLive(const Params& params);

  /// A state before the first sample.
  State start() const;

  /// Takes one sample; `out`: rate of the sample that is `lag_s` old, empty while the window fills. Trouble:
  /// `non_finite`, `time_order`, `gap`; of the rails no more is learnt then, and `out` is empty.
  Status push(const ImuSample& sample, State& state, std::optional<RateState>& out) const;

  /// Rates of the samples that push() has not given out, oldest first, appended to `out`.
  void flush(const State& state, std::vector<RateState>& out) const { stream_.flush(state.stream, out); }

  /// What holds of every state that push() left, for one that comes from elsewhere; the first that does not.
  Status check_state(const State& state) const;

 private:
  void judge_window(const ImuSample& next, State& state) const;

  CarriedStream stream_;
  RailWatch watch_;
};

}  // namespace tumble
