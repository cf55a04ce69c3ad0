// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>

#include "tumble/common/parameters.hpp"
#include "tumble/common/status.hpp"
#include "tumble/common/types.hpp"

namespace tumble {

/// Estimates the time of each sensor sample from delayed time stamps that a host computer assigned. SampleClock is
/// causal, and assumes a sensor with a regular sample period and a host with a varying delay.
///
/// SampleClock fits a line to the time stamps as a function of the sample number, with exponentially decreasing weights
/// of older time stamps. Source: fading-memory polynomial filter of first degree (Morrison, Introduction to Sequential
/// Smoothing and Prediction, 1969, ch. 13). For the sample period T, the standard deviation of an estimated time is 1.1
/// sqrt(T / kFitTimeConstant_s) times the jitter of the time stamps. An estimated time differs from the time stamp by
/// at most half a sample period. A constant delay between sensor and host is not observable, and remains in the
/// estimated times.
///
/// SampleClock does not change the first 31 time stamps. SampleClock also keeps later time stamps unchanged while their
/// jitter is outside of [kCorrectableJitterMin_periods, correctable_jitter_max_periods] sample periods. SampleClock
/// also keeps the time stamps unchanged while successive deviations of the time stamps from the fitted line are
/// strongly correlated. Set `correctable_jitter_max_periods` to 0 if a host computer triggers the samples at irregular
/// times and assigns exact time stamps.
class SampleClock {
 public:
  struct Params {
    static constexpr double kFitTimeConstant_s = 2.0;  ///< time constant of the weights in the line fit
    /// minimum jitter of time stamps that are corrected, in sample periods
    static constexpr double kCorrectableJitterMin_periods = 0.005;
    /// maximum jitter of time stamps that are corrected, in sample periods; 0: SampleClock corrects no time stamps
    double correctable_jitter_max_periods = 0.15;

    template <class Self, class Visitor>
    static void fields(Self& p, Visitor& visit) {
      visit(p.correctable_jitter_max_periods,
            {"jitter_max", "1", 0.0, 0.2,
             "maximum jitter of time stamps that are corrected, in sample periods; 0: never correct"});
    }
  };

  static constexpr std::size_t kFirstLineFitStampCount = 32;  ///< number of time stamps used for the first line fit

  struct State {
    std::size_t first_stamp_count = 0;  ///< number of valid entries of `first_stamps_ns` before the first fit
    std::array<TimeNs, kFirstLineFitStampCount> first_stamps_ns{};  ///< time stamps collected for the first fit
    std::optional<TimeNs> last_stamp_ns;
    TimeNs last_sample_time_ns = 0;
    bool line_fit_valid = false;       ///< the first line was fitted
    double period_ns = 0.0;            ///< slope of the line: estimated sample period
    double line_minus_stamp_ns = 0.0;  ///< value of the line at the last sample minus the time stamp
    /// Sums of the weights, and of weighted sample numbers and squared sample numbers, counted from the last sample.
    double sum_of_weights = 0.0, weighted_sample_index_sum = 0.0, weighted_squared_sample_index_sum = 0.0;
    double mean_square_error_ns2 = 0.0,
           successive_error_product_ns2 = 0.0;  ///< mean square prediction error; mean product of successive errors
    double prediction_error_ns = 0.0;           ///< newest time stamp minus its predicted time, with limited magnitude
    std::size_t consecutive_outliers = 0;       ///< number of consecutive prediction errors close to half a period
  };

  /// Throws InvalidParams if a parameter is out of bounds.
  explicit SampleClock(const Params& params);

  /// Estimates `time_ns`, the time at which the sensor took the sample with the time stamp `stamp_ns`. Estimated times
  /// increase strictly. Returns `time_order` and leaves the state unchanged if the time stamp is not later than the
  /// previous time stamp. Cost: O(1), no allocation.
  Status push(TimeNs stamp_ns, State& state, TimeNs& time_ns) const;

  /// Returns the standard deviation of the time stamps about the fitted line [s], or an empty value before the first
  /// fit.
  static std::optional<double> jitter_s(const State& state);
  bool corrects_stamps(const State& state) const;

 private:
  void start_line_fit(State& state) const;
  void update_line(double step_ns, TimeNs stamp_ns, State& state) const;

  Params params_;
};

/// Replaces the time stamps of a recording with the sample times that SampleClock estimates. `corrected_jitter_s`
/// receives the largest jitter of the corrected time stamps [s], or 0 if no time stamp was corrected. Returns
/// `time_order` and leaves `stamps_ns` unchanged if the time stamps do not increase. Cost: O(N).
Status correct_stamps(const SampleClock& clock, std::span<TimeNs> stamps_ns, double& corrected_jitter_s);

}  // namespace tumble
