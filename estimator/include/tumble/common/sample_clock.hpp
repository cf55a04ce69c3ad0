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

/// Estimates when a sensor with its own clock took each sample, causally, from time stamps that a host computer
/// assigned. SampleClock assumes that the delay of the host varies, and that the sample period of the sensor is
/// regular. For example, at an angular acceleration of 300 rad/s^2, a timing error of 0.5 ms causes a rate error of
/// 0.15 rad/s.
///
/// SampleClock fits a line to the stamps as a function of the sample number. The weights of older samples decrease
/// exponentially. The method is the fading-memory polynomial filter of first degree (Morrison, Introduction to
/// Sequential Smoothing and Prediction, 1969, ch. 13). The error of an estimated time is 1.1 sqrt(T / memory_s) times
/// the jitter of the stamps, with the sample period T. A constant delay of the host is not observable. The sample
/// number also counts dropped samples.
///
/// SampleClock returns a stamp unchanged, bit for bit, in three cases. First, the first 32 stamps are unchanged.
/// Second, a stamp is unchanged if the jitter is below `jitter_min` of the period, which indicates stamps of the
/// sensor's own clock. Third, a stamp is unchanged if the jitter is above `jitter_max` or successive errors are
/// correlated, which indicates a variable sample period.
///
/// The estimated time differs from the stamp by at most half a period.
///
/// SampleClock does not model a sensor that takes samples on irregular requests of a host computer that assigns exact
/// stamps. Stamps of a sensor sampled on request look like delayed stamps but are correct. Set `jitter_max` to 0 to
/// keep every stamp unchanged.
class SampleClock {
 public:
  struct Params {
    double memory_s = 2.0;      ///< time constant of the fit; sensor clocks are stable for longer
    double jitter_min = 0.005;  ///< minimum standard deviation of corrected stamps, in periods
    double jitter_max = 0.15;

    /// Calls the visitor with the value, name, unit, bounds and meaning of every parameter (common/parameters.hpp).
    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.memory_s,
            {"memory_s", "s", 0.01, 1e3, "time over which the rate of the sensor's clock is assumed to be constant"});
      visit(p.jitter_min,
            {"jitter_min", "1", 0.0, 1.0, "minimum jitter of time stamps that are corrected, in sample periods"});
      visit(p.jitter_max, {"jitter_max", "1", 0.0, 0.2,
                           "maximum jitter of time stamps that are corrected, in sample periods; 0: never correct"});
    }
  };

  static constexpr std::size_t kFirstFitStamps = 32;  ///< number of stamps used for the first fit

  struct State {
    std::size_t samples = 0;                      ///< number of valid entries of `start` while no line is fitted
    std::array<TimeNs, kFirstFitStamps> start{};  ///< stamps collected for the first fit
    std::optional<TimeNs> stamp_ns;               ///< last stamp
    TimeNs time_ns = 0;                           ///< last estimated sample time
    bool line_fitted = false;                     ///< whether a line is fitted; the members below describe it
    double period_ns = 0.0;                       ///< slope of the line
    double fit_residual_ns = 0.0;                 ///< value of the line at the last sample minus its stamp
    double sum = 0.0, weighted_number_sum = 0.0,
           weighted_number_squared_sum = 0.0;  ///< sums of weights; sample numbers count from the last sample
    double mean_square_error_ns2 = 0.0,
           lag_one_error_product_ns2 = 0.0;  ///< mean square prediction error; mean product of successive errors
    double prediction_error_ns = 0.0;        ///< last prediction error
    std::size_t outliers = 0;                ///< consecutive errors close to half a period
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit SampleClock(const Params& params);

  /// Processes a stamp and computes `time_ns`, the time at which the sensor took the sample. Returned times increase
  /// strictly. If the stamp is not later than the previous stamp, push() returns `time_order` and leaves the state
  /// unchanged. Cost: O(1), no allocation.
  Status push(TimeNs stamp_ns, State& state, TimeNs& time_ns) const;

  /// Returns the standard deviation of the stamps about the fitted line [s]. The result is empty while no line is
  /// fitted.
  static std::optional<double> jitter_s(const State& state);
  /// Returns whether push() currently corrects stamps.
  bool corrects_stamps(const State& state) const;

  /// Checks the invariants of a state that was loaded from a file. Returns the first violated invariant.
  static Status check_state(const State& state);

 private:
  void begin(State& state) const;
  void update_line(double step_ns, TimeNs stamp_ns, State& state) const;

  Params params_;
};

/// Replaces the stamps of a recording by the sample times that SampleClock estimates. Cost: O(N). `corrected_jitter_s`
/// returns the largest jitter that was corrected [s]; 0 means that all stamps are unchanged. If the stamps do not
/// increase, the function returns `time_order` and leaves `stamps_ns` unchanged.
Status correct_stamps(const SampleClock& clock, std::span<TimeNs> stamps_ns, double& corrected_jitter_s);

}  // namespace tumble
