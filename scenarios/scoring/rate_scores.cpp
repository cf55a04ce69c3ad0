// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenarios/errors.hpp"
#include "scenarios/scoring/clipping.hpp"
#include "scenarios/scoring/consistency.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/statistics/statistics.hpp"

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

bool quantile_of(const std::vector<double>& values, double share, double& value) {
  const std::optional<double> found = quantile_of_all(values, share);
  if (found) value = *found;
  return found.has_value();
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

bool clipped_max(const Estimate& estimate, const ScoringInput& input, double& value) {
  return quantile_of(error_norms_rad_s(estimate, input, true), 1.0, value);
}

// A stretch: samples in a row with a clipped axis. Its error is the norm of the mean of its error vectors, an offset.
bool stretch_max(const Estimate& estimate, const ScoringInput& input, double& value) {
  const ClippingTruth truth(*input.sensors, *input.truth);
  std::vector<double> offsets;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double length = 0.0;
  const auto close = [&] {
    if (length > 0.0) offsets.push_back((sum / length).norm());
    sum.setZero();
    length = 0.0;
  };
  for (const RateState& rate : estimate.rates) {
    const auto sample = truth.at(rate.time_ns);
    if (!sample || sample->clipped_axes == 0) {
      close();
      continue;
    }
    sum += rate.w_WI_I_rad_s - sample->rate_rad_s;
    length += 1.0;
  }
  close();
  return quantile_of(offsets, 1.0, value);
}

// whether the robot touched anything while the sample that ends at time_ns was taken
bool in_contact(const ScoringInput& input, std::int64_t time_ns) {
  const sim::Truth& truth = *input.truth;
  if (truth.period_ns <= 0 || truth.label.empty()) return false;
  const auto last = static_cast<std::int64_t>(truth.label.size()) - 1;
  const std::int64_t end = std::min(last, time_ns / truth.period_ns);
  const std::int64_t begin =
      std::max<std::int64_t>(0, (time_ns - input.sensors->imus.front().period_ns) / truth.period_ns);
  for (std::int64_t k = begin; k <= end; ++k) {
    if (truth.label[static_cast<std::size_t>(k)] != sim::ContactLabel::air) return true;
  }
  return false;
}

// squared errors of clipped axes over their reported variances, of the samples in flight or of those in contact
std::vector<double> normalised_errors(const Estimate& estimate, const ScoringInput& input, bool flight, bool impact) {
  const ClippingTruth truth(*input.sensors, *input.truth);
  std::vector<double> normalised;
  for (const RateState& rate : estimate.rates) {
    const auto sample = truth.at(rate.time_ns);
    if (!sample || sample->clipped_axes == 0) continue;
    if (!(in_contact(input, rate.time_ns) ? impact : flight)) continue;
    for (int j = 0; j < 3; ++j) {
      if (!(sample->clipped_axes & (1u << j))) continue;
      const double error = rate.w_WI_I_rad_s[j] - sample->rate_rad_s[j];
      normalised.push_back(squared_over(error, rate.covariance_rad2_s2(j, j)));
    }
  }
  return normalised;
}

bool coverage_3sigma(const Estimate& estimate, const ScoringInput& input, double& value) {
  return share_within_3sigma(normalised_errors(estimate, input, true, true), value);
}

bool coverage_3sigma_flight(const Estimate& estimate, const ScoringInput& input, double& value) {
  return share_within_3sigma(normalised_errors(estimate, input, true, false), value);
}

bool coverage_3sigma_impact(const Estimate& estimate, const ScoringInput& input, double& value) {
  return share_within_3sigma(normalised_errors(estimate, input, false, true), value);
}

bool mean_of(const std::vector<double>& values, double& value) {
  if (values.empty()) return false;
  value = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return true;
}

bool nees_flight(const Estimate& estimate, const ScoringInput& input, double& value) {
  return mean_of(normalised_errors(estimate, input, true, false), value);
}

bool nees_impact(const Estimate& estimate, const ScoringInput& input, double& value) {
  return mean_of(normalised_errors(estimate, input, false, true), value);
}

}  // namespace

std::vector<Metric> rate_metrics() {
  return {
      {{"rate_error_clipped_median_rad_s", Unit::rad_s,
        "median norm of the rate error at samples where at least one gyro axis is clipped", Sense::lower,
        Place::headline},
       Kind::rate,
       clipped_median},
      {{"rate_error_clipped_p99_rad_s", Unit::rad_s,
        "99th percentile of the norm of the rate error at samples where at least one gyro axis is clipped",
        Sense::lower, Place::headline},
       Kind::rate,
       clipped_p99},
      {{"rate_error_free_median_rad_s", Unit::rad_s, "median norm of the rate error at all other samples", Sense::lower,
        Place::held},
       Kind::rate,
       free_median},
      {{"rate_coverage_3sigma", Unit::share,
        "share of clipped axes whose error lies within three reported standard deviations", Sense::two_sided,
        Place::held, kNormal3Sigma},
       Kind::rate,
       coverage_3sigma},
      {{"rate_error_clipped_max_rad_s", Unit::rad_s, "largest norm of the rate error at clipped samples", Sense::lower},
       Kind::rate,
       clipped_max},
      {{"rate_error_stretch_max_rad_s", Unit::rad_s,
        "largest, over stretches of clipped samples in a row, of the norm of the mean error: what offsets a map",
        Sense::lower},
       Kind::rate,
       stretch_max},
      {{"rate_coverage_3sigma_flight", Unit::share,
        "rate_coverage_3sigma of the samples in which the robot touched nothing", Sense::two_sided, Place::detail,
        kNormal3Sigma},
       Kind::rate,
       coverage_3sigma_flight},
      {{"rate_coverage_3sigma_impact", Unit::share, "rate_coverage_3sigma of all other samples", Sense::two_sided,
        Place::detail, kNormal3Sigma},
       Kind::rate,
       coverage_3sigma_impact},
      {{"rate_nees_flight", Unit::number,
        "mean, over clipped axes of samples in flight, of the squared error over the reported variance; 1 is honest",
        Sense::two_sided, Place::held, 1.0},
       Kind::rate,
       nees_flight},
      {{"rate_nees_impact", Unit::number, "the same over all other samples", Sense::two_sided, Place::held, 1.0},
       Kind::rate,
       nees_impact},
  };
}

}  // namespace tumble::scenarios
