// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "tumble/common/imu.hpp"
#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// The time at which a sensor that samples by a clock of its own took a sample, told causally from stamps that a host
/// put on them: the host is late by this and that, the sensor is not. At 300 rad/s^2 half a millisecond is 0.15 rad/s.
///
/// A line through the stamps against the samples' numbers, older ones counting exponentially less: the fading-memory
/// polynomial filter of first degree (N. Morrison, Introduction to Sequential Smoothing and Prediction, 1969, ch. 13).
/// Its time errs by 1.1 sqrt(T / memory_s) of the jitter at period T; a host that is always late by the same is a
/// clock's offset, which it does not see. Samples that never came are numbered too.
///
/// A stamp is left as it is, bit for bit, where there is nothing to mend or it can't be: among the first 32; where the
/// jitter is below `jitter_min` of the period (the sensor's own clock, or one rounded to microseconds); where it is
/// beyond `jitter_max`, or errors follow each other (a sensor that has no period, one whose period wanders). No time
/// lies further than half a period from its stamp.
///
/// Not modelled: a sensor that samples when it is asked, by a host that jitters and stamps exactly: its stamps look the
/// same, and are the truth. `jitter_max` 0 leaves every stamp as it is.
class SampleClock {
 public:
  struct Params {
    double memory_s = 2.0;      ///< clocks of sensors are steady for longer
    double jitter_min = 0.005;  ///< standard deviations of the stamps, in periods
    double jitter_max = 0.15;

    /// Every number of it, stated once.
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.memory_s, {"memory_s", "s", 0.01, 1e3, "time over which the sensor's clock is assumed to be steady"});
      visit(p.jitter_min,
            {"jitter_min", "1", 0.0, 1.0, "stamp jitter below which stamps are not corrected, in periods"});
      visit(p.jitter_max, {"jitter_max", "1", 0.0, 0.2,
                           "stamp jitter above which stamps are not corrected, in periods; 0: never correct"});
    }
  };

  static constexpr std::size_t kStart = 32;  ///< stamps from which the first line is made

  struct State {
    std::size_t samples = 0;                      ///< while there is no line: of `start`
    std::array<TimeNs, kStart> start{};           ///< their stamps
    std::optional<TimeNs> stamp_ns;               ///< last stamp
    TimeNs time_ns = 0;                           ///< last time given out
    bool line = false;                            ///< whether there is one: the members below
    double period_ns = 0.0;                       ///< slope of the line
    double ahead_ns = 0.0;                        ///< the line at the last sample, from its stamp
    double sum = 0.0, sum_n = 0.0, sum_nn = 0.0;  ///< of weights, by numbers of samples counted from the last one
    double square_ns2 = 0.0, product_ns2 = 0.0;  ///< mean square of what the line expected wrongly; with the one before
    double error_ns = 0.0;                       ///< the last of these
    std::size_t strays = 0;                      ///< in a row, nearly half a period off
  };

  /// Throws InvalidParams on a parameter outside of its bound.
  explicit SampleClock(const Params& params);

  /// Takes a stamp; `time_ns` is when its sample was taken, later than that of the sample before. `time_order` unless
  /// it is later than the last stamp; the state is then as it was. No allocation, O(1).
  Status push(TimeNs stamp_ns, State& state, TimeNs& time_ns) const;

  /// Standard deviation of the stamps about the line [s]; nothing where there is no line.
  static std::optional<double> jitter_s(const State& state);
  /// Whether times are those of the line.
  bool mends(const State& state) const;

  /// What holds of every state that push() left, for one that comes from elsewhere; the first that does not.
  static Status check_state(const State& state);

 private:
  void begin(State& state) const;
  void follow(double step_ns, TimeNs stamp_ns, State& state) const;

  Params params_;
};

/// Puts the times of SampleClock in the place of stamps, and gives the largest jitter that was mended [s]; 0: none, all
/// stamps are as they were. `time_order` as push(); `stamps_ns` are then as they were. O(N).
Status to_sample_times(const SampleClock& clock, std::span<TimeNs> stamps_ns, double& mended_s);

}  // namespace tumble
