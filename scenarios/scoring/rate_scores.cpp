// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/consistency.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

struct ErrorNorms {
  std::vector<double> clipped_rad_s, free_rad_s;
};

ErrorNorms error_norms(const ScoredEstimate& scored) {
  ErrorNorms norms;
  for (const PairedRate& pair : paired_rates(scored)) {
    if (!pair.truth) continue;
    (pair.clipped_axes() != 0 ? norms.clipped_rad_s : norms.free_rad_s).push_back(pair.error_rad_s().norm());
  }
  return norms;
}

bool clipped_median(const ScoredEstimate& scored, double& value) {
  return quantile_of(scored.once(error_norms).clipped_rad_s, 0.5, value);
}

bool clipped_p99(const ScoredEstimate& scored, double& value) {
  return quantile_of(scored.once(error_norms).clipped_rad_s, 0.99, value);
}

bool free_median(const ScoredEstimate& scored, double& value) {
  return quantile_of(scored.once(error_norms).free_rad_s, 0.5, value);
}

bool clipped_max(const ScoredEstimate& scored, double& value) {
  return quantile_of(scored.once(error_norms).clipped_rad_s, 1.0, value);
}

// The rate exceeds the gyro's range by the difference between unclipped and delivered reading.
bool beyond_range_share(const ScoredEstimate& scored, double& value) {
  const ClippingTruth& truth = clipping_truth(scored);
  std::vector<double> shares;
  for (const PairedRate& pair : paired_rates(scored)) {
    if (pair.clipped_axes() != 0) shares.push_back(pair.error_rad_s().norm() / truth.lost_rad_s(pair.sample).norm());
  }
  return quantile_of(shares, 0.5, value);
}

// A clipping interval is a sequence of samples with at least one clipped axis. The error of a clipping interval is the
// norm of the mean error vector, because random errors cancel in the mean.
bool segment_max(const ScoredEstimate& scored, double& value) {
  std::vector<double> offsets;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double length = 0.0;
  const auto close = [&] {
    if (length > 0.0) offsets.push_back((sum / length).norm());
    sum.setZero();
    length = 0.0;
  };
  for (const PairedRate& pair : paired_rates(scored)) {
    if (pair.clipped_axes() == 0) {
      close();
      continue;
    }
    sum += pair.error_rad_s();
    length += 1.0;
  }
  close();
  return quantile_of(offsets, 1.0, value);
}

bool in_contact(const ScoredEstimate& scored, std::int64_t time_ns) {
  const sim::Truth& truth = scored.truth();
  if (truth.period_ns <= 0 || truth.label.empty()) return false;
  const auto last = static_cast<std::int64_t>(truth.label.size()) - 1;
  const std::int64_t end = std::min(last, time_ns / truth.period_ns);
  const std::int64_t begin =
      std::max<std::int64_t>(0, (time_ns - scored.sensors().imus.front().period_ns) / truth.period_ns);
  for (std::int64_t k = begin; k <= end; ++k) {
    if (truth.label[static_cast<std::size_t>(k)] != sim::ContactLabel::air) return true;
  }
  return false;
}

// NormalisedErrors contains squared rate errors divided by their reported variances. `impact` contains the errors of
// clipped axes while the robot is in contact, and `flight` contains the errors without contact. `cross_axis` contains
// the errors of unclipped axes that a clipped sensing element disturbs.
struct NormalisedErrors {
  std::vector<double> all, flight, impact, cross_axis;
};

NormalisedErrors normalised_rate_errors(const ScoredEstimate& scored) {
  NormalisedErrors normalised;
  for (const PairedRate& pair : paired_rates(scored)) {
    if (pair.clipped_axes() == 0 || !pair.has_covariance()) continue;
    const Eigen::Vector3d error = pair.error_rad_s();
    std::vector<double>& part = in_contact(scored, pair.estimate->time_ns) ? normalised.impact : normalised.flight;
    for (int j = 0; j < 3; ++j) {
      const double square = squared_over(error[j], pair.estimate->covariance_rad2_s2(j, j));
      if (pair.cross_axes() & (1u << j)) normalised.cross_axis.push_back(square);
      if (!(pair.clipped_axes() & (1u << j))) continue;
      normalised.all.push_back(square);
      part.push_back(square);
    }
  }
  return normalised;
}

bool rate_coverage_3sigma(const ScoredEstimate& scored, double& value) {
  return share_within_3sigma(scored.once(normalised_rate_errors).all, value);
}

bool coverage_3sigma_flight(const ScoredEstimate& scored, double& value) {
  return share_within_3sigma(scored.once(normalised_rate_errors).flight, value);
}

bool coverage_3sigma_impact(const ScoredEstimate& scored, double& value) {
  return share_within_3sigma(scored.once(normalised_rate_errors).impact, value);
}

bool coverage_3sigma_cross_axis(const ScoredEstimate& scored, double& value) {
  return share_within_3sigma(scored.once(normalised_rate_errors).cross_axis, value);
}

bool mean_of(const std::vector<double>& values, double& value) {
  if (values.empty()) return false;
  value = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  return true;
}

bool nees_flight(const ScoredEstimate& scored, double& value) {
  return mean_of(scored.once(normalised_rate_errors).flight, value);
}

bool nees_impact(const ScoredEstimate& scored, double& value) {
  return mean_of(scored.once(normalised_rate_errors).impact, value);
}

}  // namespace

std::vector<Metric> rate_metrics() {
  return {
      {{"rate_error_clipped_median_rad_s", Unit::rad_s,
        "median rate error (norm) over samples with at least one clipped gyro axis", Sense::lower, Place::headline},
       Kind::rate,
       clipped_median},
      {{"rate_error_clipped_p99_rad_s", Unit::rad_s,
        "99th percentile of the rate error (norm) over samples with at least one clipped gyro axis", Sense::lower,
        Place::headline},
       Kind::rate,
       clipped_p99},
      {{"rate_error_free_median_rad_s", Unit::rad_s,
        "median rate error (norm) over samples without a clipped gyro axis", Sense::lower, Place::held},
       Kind::rate,
       free_median},
      {{"rate_coverage_3sigma", Unit::share,
        "share of clipped axes whose rate error is within three reported standard deviations", Sense::two_sided,
        Place::held, kNormal3Sigma, Compared::by_difference},
       Kind::rate,
       rate_coverage_3sigma},
      {{"rate_error_clipped_max_rad_s", Unit::rad_s, "largest rate error (norm) over clipped samples", Sense::lower},
       Kind::rate,
       clipped_max},
      {{"rate_error_beyond_range_share", Unit::share,
        "median, over samples with at least one clipped gyro axis, of the rate error (norm) divided by the amount by "
        "which the rate exceeds the gyro's range (norm of unclipped minus delivered reading); for raw readings, 1",
        Sense::lower},
       Kind::rate,
       beyond_range_share},
      {{"rate_error_segment_max_rad_s", Unit::rad_s,
        "largest mean rate error (norm) of a segment of consecutive clipped samples", Sense::lower},
       Kind::rate,
       segment_max},
      {{"rate_coverage_3sigma_flight", Unit::share,
        "share of clipped axes whose rate error is within three reported standard deviations, in samples without "
        "contact",
        Sense::two_sided, Place::detail, kNormal3Sigma, Compared::by_difference},
       Kind::rate,
       coverage_3sigma_flight},
      {{"rate_coverage_3sigma_impact", Unit::share,
        "share of clipped axes whose rate error is within three reported standard deviations, in samples with contact",
        Sense::two_sided, Place::detail, kNormal3Sigma, Compared::by_difference},
       Kind::rate,
       coverage_3sigma_impact},
      {{"rate_coverage_3sigma_cross_axis", Unit::share,
        "share of rate errors within three reported standard deviations, for unclipped axes with an error caused by a "
        "clipped axis (cross-axis error)",
        Sense::two_sided, Place::detail, kNormal3Sigma, Compared::by_difference},
       Kind::rate,
       coverage_3sigma_cross_axis},
      {{"rate_nees_flight", Unit::number,
        "mean ratio of squared rate error to reported variance, for clipped axes in samples without contact; the ideal "
        "is 1",
        Sense::two_sided, Place::held, 1.0},
       Kind::rate,
       nees_flight},
      {{"rate_nees_impact", Unit::number,
        "mean ratio of squared rate error to reported variance, for clipped axes in samples with contact; the ideal is "
        "1",
        Sense::two_sided, Place::held, 1.0},
       Kind::rate,
       nees_impact},
  };
}

}  // namespace tumble::scenarios
