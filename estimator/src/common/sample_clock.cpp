// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/sample_clock.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

namespace tumble {

namespace {

constexpr double kOutlier = 4.0;  // largest error of an accepted time stamp, in standard deviations
// If the error of a time stamp exceeds kStray sample periods, the number of the sample is uncertain.
constexpr double kStray = 0.4;
constexpr std::size_t kConsecutiveOutliersMax = 8;
// maximum jitter of time stamps in sample periods; uniformly random time stamps have a jitter of 0.29
constexpr double kPeriodJitterMax = 0.25;
// If the correlation of successive residuals exceeds kErrorCorrelationMax, the line fitted to the time stamps does not
// follow the clock.
constexpr double kErrorCorrelationMax = 0.5;
constexpr double kStepMin_periods = 0.25;  // minimum time between two corrected time stamps, in sample periods
// maximum standard deviation of the sample number after a data gap, in sample periods
constexpr double kSampleNumberSigmaMax = 0.1;

constexpr double kPeriodMax_ns = 1e11;
constexpr TimeNs kLast_ns = TimeNs{1} << 62;  // larger stamps remain uncorrected, to avoid overflow

double difference_ns(TimeNs later_ns, TimeNs earlier_ns) {
  return static_cast<double>(static_cast<std::uint64_t>(later_ns) - static_cast<std::uint64_t>(earlier_ns));
}

struct FittedLine {
  double period_ns = 0.0, last_ns = 0.0;
  double weighted_sample_index_sum = 0.0,
         weighted_squared_sample_index_sum = 0.0;  ///< sums over the sample numbers, counted from the last time stamp
  double mean_square_error_ns2 = 0.0;
};

using StateOffsets =
    std::array<double, SampleClock::kFirstLineFitStampCount>;  // times relative to the first stamp [ns]
using Numbers = std::array<double, SampleClock::kFirstLineFitStampCount>;

FittedLine fit(const StateOffsets& x_ns, const Numbers& n) {
  constexpr auto kCount = static_cast<double>(SampleClock::kFirstLineFitStampCount);
  FittedLine line;
  double sum_x = 0.0, sum_nx = 0.0;
  for (std::size_t k = 0; k < SampleClock::kFirstLineFitStampCount; ++k) {
    const double from_last = n[k] - n.back();
    line.weighted_sample_index_sum += from_last;
    line.weighted_squared_sample_index_sum += from_last * from_last;
    sum_x += x_ns[k];
    sum_nx += from_last * x_ns[k];
  }
  const double determinant =
      kCount * line.weighted_squared_sample_index_sum - line.weighted_sample_index_sum * line.weighted_sample_index_sum;
  line.last_ns =
      (line.weighted_squared_sample_index_sum * sum_x - line.weighted_sample_index_sum * sum_nx) / determinant;
  line.period_ns = (kCount * sum_nx - line.weighted_sample_index_sum * sum_x) / determinant;
  for (std::size_t k = 0; k < SampleClock::kFirstLineFitStampCount; ++k) {
    const double residual = x_ns[k] - line.last_ns - (n[k] - n.back()) * line.period_ns;
    line.mean_square_error_ns2 += residual * residual / (kCount - 2.0);
  }
  return line;
}

double median_step(const StateOffsets& x_ns) {
  std::array<double, SampleClock::kFirstLineFitStampCount - 1> steps{};
  for (std::size_t k = 0; k + 1 < SampleClock::kFirstLineFitStampCount; ++k) steps[k] = x_ns[k + 1] - x_ns[k];
  std::nth_element(steps.begin(), steps.begin() + steps.size() / 2, steps.end());
  return steps[steps.size() / 2];
}

Numbers sample_index_from_steps(const StateOffsets& x_ns, double period_ns) {
  Numbers n{};
  for (std::size_t k = 1; k < n.size(); ++k)
    n[k] = n[k - 1] + std::max(1.0, std::round((x_ns[k] - x_ns[k - 1]) / period_ns));
  return n;
}

Numbers sample_index_from_fit(const StateOffsets& x_ns, const Numbers& before, const FittedLine& line) {
  Numbers n{};
  for (std::size_t k = 0; k < n.size(); ++k) {
    n[k] = std::round((x_ns[k] - line.last_ns) / line.period_ns + before.back());
    if (k > 0) n[k] = std::max(n[k], n[k - 1] + 1.0);
  }
  return n;
}

}  // namespace

SampleClock::SampleClock(const Params& params) : params_(params) {
  require_valid_fields(params);
}

bool SampleClock::corrects_stamps(const State& state) const {
  if (!state.line_fit_valid) return false;
  const double jitter = std::sqrt(state.mean_square_error_ns2) / state.period_ns;
  return jitter >= params_.kCorrectableJitterMin_periods && jitter <= params_.correctable_jitter_max_periods &&
         state.successive_error_product_ns2 <= kErrorCorrelationMax * state.mean_square_error_ns2;
}

std::optional<double> SampleClock::jitter_s(const State& state) {
  if (!state.line_fit_valid) return std::nullopt;
  return 1e-9 * std::sqrt(state.mean_square_error_ns2);
}

Status SampleClock::push(TimeNs stamp_ns, State& state, TimeNs& time_ns) const {
  if (state.last_stamp_ns && stamp_ns <= *state.last_stamp_ns)
    return {ErrorCode::time_order, "time_ns", double(stamp_ns), double(*state.last_stamp_ns)};
  const double step_ns = state.last_stamp_ns ? difference_ns(stamp_ns, *state.last_stamp_ns) : 0.0;
  if (state.line_fit_valid) {
    update_line(step_ns, stamp_ns, state);
  } else {
    state.first_stamps_ns[state.first_stamp_count++] = stamp_ns;
    if (state.first_stamp_count == kFirstLineFitStampCount) start_line_fit(state);
  }
  time_ns = stamp_ns;
  if (corrects_stamps(state) && std::abs(stamp_ns) < kLast_ns) {
    const double bound_ns = 0.5 * state.period_ns;
    time_ns += std::llround(std::clamp(state.line_minus_stamp_ns, -bound_ns, bound_ns));
  }
  // Corrected time stamps must increase, even after an uncorrected time stamp, or if several samples have nearly equal
  // time stamps.
  if (state.last_stamp_ns && time_ns <= state.last_sample_time_ns)
    time_ns = state.last_sample_time_ns +
              std::max<TimeNs>(1, std::llround(std::min(kStepMin_periods * state.period_ns, 0.5 * step_ns)));
  state.last_stamp_ns = stamp_ns;
  state.last_sample_time_ns = time_ns;
  return {};
}

void SampleClock::start_line_fit(State& state) const {
  StateOffsets x_ns{};
  for (std::size_t k = 0; k < kFirstLineFitStampCount; ++k)
    x_ns[k] = difference_ns(state.first_stamps_ns[k], state.first_stamps_ns.front());
  state.first_stamp_count = 0;
  Numbers numbers = sample_index_from_steps(x_ns, median_step(x_ns));
  FittedLine line = fit(x_ns, numbers);
  numbers = sample_index_from_fit(x_ns, numbers, line);
  line = fit(x_ns, numbers);
  if (!(line.period_ns > 0.0 && line.period_ns < kPeriodMax_ns)) return;
  if (!(std::sqrt(line.mean_square_error_ns2) < kPeriodJitterMax * line.period_ns)) return;
  state.line_fit_valid = true;
  state.period_ns = line.period_ns;
  state.line_minus_stamp_ns = line.last_ns - x_ns.back();
  state.sum_of_weights = kFirstLineFitStampCount;
  state.weighted_sample_index_sum = line.weighted_sample_index_sum;
  state.weighted_squared_sample_index_sum = line.weighted_squared_sample_index_sum;
  state.mean_square_error_ns2 = line.mean_square_error_ns2;
  state.successive_error_product_ns2 = state.prediction_error_ns = 0.0;
  state.consecutive_outliers = 0;
}

/// See sample_clock.md (S1), (S2), (S3). If the number of sample periods between the last two time stamps is uncertain,
/// the line fit restarts.
void SampleClock::update_line(double step_ns, TimeNs stamp_ns, State& state) const {
  const double passed_ns = step_ns - state.line_minus_stamp_ns;
  const double number = std::max(1.0, std::round(passed_ns / state.period_ns));
  const double prediction_error_ns = passed_ns - number * state.period_ns;
  const double jitter_ns =
      std::max(std::sqrt(state.mean_square_error_ns2), params_.kCorrectableJitterMin_periods * state.period_ns);
  const double before = state.sum_of_weights * state.weighted_squared_sample_index_sum -
                        state.weighted_sample_index_sum * state.weighted_sample_index_sum;
  const double extrapolation_sigma_ns = number * jitter_ns * std::sqrt(state.sum_of_weights / before);
  state.consecutive_outliers =
      std::abs(prediction_error_ns) > kStray * state.period_ns ? state.consecutive_outliers + 1 : 0;
  const bool lost = extrapolation_sigma_ns > kSampleNumberSigmaMax * state.period_ns ||
                    state.consecutive_outliers > kConsecutiveOutliersMax ||
                    jitter_ns > kPeriodJitterMax * state.period_ns;
  if (lost) {
    state.line_fit_valid = false;
    state.first_stamps_ns.front() = stamp_ns;
    state.first_stamp_count = 1;
    return;
  }
  const double limited_ns = std::clamp(prediction_error_ns, -kOutlier * jitter_ns, kOutlier * jitter_ns);
  const double forget_fraction = std::min(0.5, 1e-9 * number * state.period_ns / params_.kFitTimeConstant_s);
  state.mean_square_error_ns2 += forget_fraction * (limited_ns * limited_ns - state.mean_square_error_ns2);
  state.successive_error_product_ns2 +=
      forget_fraction * (limited_ns * state.prediction_error_ns - state.successive_error_product_ns2);
  state.prediction_error_ns = limited_ns;

  const double keep = 1.0 - forget_fraction;
  state.weighted_squared_sample_index_sum =
      keep * (state.weighted_squared_sample_index_sum - 2.0 * number * state.weighted_sample_index_sum +
              number * number * state.sum_of_weights);
  state.weighted_sample_index_sum = keep * (state.weighted_sample_index_sum - number * state.sum_of_weights);
  state.sum_of_weights = keep * state.sum_of_weights + 1.0;
  const double determinant = state.sum_of_weights * state.weighted_squared_sample_index_sum -
                             state.weighted_sample_index_sum * state.weighted_sample_index_sum;
  state.line_minus_stamp_ns = state.weighted_squared_sample_index_sum / determinant * limited_ns - prediction_error_ns;
  state.period_ns -= state.weighted_sample_index_sum / determinant * limited_ns;
}

Status correct_stamps(const SampleClock& clock, std::span<TimeNs> stamps_ns, double& corrected_jitter_s) {
  corrected_jitter_s = 0.0;
  SampleClock::State state;
  std::vector<TimeNs> times_ns(stamps_ns.size());
  double largest_s = 0.0;
  for (std::size_t k = 0; k < stamps_ns.size(); ++k) {
    if (const Status status = clock.push(stamps_ns[k], state, times_ns[k]); !status.ok()) return status;
    if (clock.corrects_stamps(state)) largest_s = std::max(largest_s, *SampleClock::jitter_s(state));
  }
  std::copy(times_ns.begin(), times_ns.end(), stamps_ns.begin());
  corrected_jitter_s = largest_s;
  return {};
}

}  // namespace tumble
