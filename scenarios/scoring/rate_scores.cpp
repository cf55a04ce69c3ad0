// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/sweep/statistics.hpp"

namespace tumble::scenarios {

namespace {

// errors of the estimate at samples with (or without) a clipped axis
std::vector<double> error_norms_rad_s(const Estimate& estimate, const ScoringInput& input, bool clipped) {
  std::vector<double> norms;
  const ClippingTruth truth(*input.sensors, *input.truth);
  for (const RateState& rate : estimate.rates) {
    const auto sample = truth.at(rate.time_ns);
    if (sample && (sample->clipped_axes != 0) == clipped) {
      norms.push_back((rate.w_WI_I_rad_s - sample->rate_rad_s).norm());
    }
  }
  return norms;
}

// one NaN spoils the figure instead of leaving it
bool quantile_of(const std::vector<double>& values, double share, double& value) {
  if (values.empty()) return false;
  const bool finite = std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
  value = finite ? quantile(values, share) : std::numeric_limits<double>::quiet_NaN();
  return true;
}

bool clipped_median(const Estimate& estimate, const ScoringInput& input, double& value) {
  return quantile_of(error_norms_rad_s(estimate, input, true), 0.5, value);
}

bool clipped_p99(const Estimate& estimate, const ScoringInput& input, double& value) {
  return quantile_of(error_norms_rad_s(estimate, input, true), 0.99, value);
}

bool free_median(const Estimate& estimate, const ScoringInput& input, double& value) {
  return quantile_of(error_norms_rad_s(estimate, input, false), 0.5, value);
}

bool coverage_3sigma(const Estimate& estimate, const ScoringInput& input, double& value) {
  const ClippingTruth truth(*input.sensors, *input.truth);
  double within = 0.0;
  double total = 0.0;
  for (const RateState& rate : estimate.rates) {
    const auto sample = truth.at(rate.time_ns);
    if (!sample) continue;
    for (int j = 0; j < 3; ++j) {
      if (!(sample->clipped_axes & (1u << j))) continue;
      const double error = rate.w_WI_I_rad_s[j] - sample->rate_rad_s[j];
      total += 1.0;
      if (error * error <= 9.0 * rate.covariance_rad2_s2(j, j)) within += 1.0;
    }
  }
  if (total == 0.0) return false;
  value = within / total;
  return true;
}

}  // namespace

std::vector<Metric> rate_metrics() {
  return {
      {"rate_error_clipped_median_rad_s", Kind::rate, "rad/s",
       "median norm of the rate error at samples where at least one gyro axis is clipped", clipped_median},
      {"rate_error_clipped_p99_rad_s", Kind::rate, "rad/s", "99th percentile of the same", clipped_p99},
      {"rate_error_free_median_rad_s", Kind::rate, "rad/s", "median norm of the rate error at all other samples",
       free_median},
      {"rate_coverage_3sigma", Kind::rate, "1",
       "share of clipped axes whose error lies within three reported standard deviations", coverage_3sigma},
  };
}

}  // namespace tumble::scenarios
