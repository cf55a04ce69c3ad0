// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

/// A sample is unclipped with certainty if the reading of every axis is below kFarShare times the largest reading of
/// this axis.
constexpr double kFarShare = 0.9, kRotating_rad_s = 0.5;

double error_norm(const Eigen::Vector3d& estimate, const Eigen::Vector3d& reference) {
  return (estimate - reference).norm();
}

double error_speed(const Eigen::Vector3d& estimate, const Eigen::Vector3d& reference) {
  return std::abs(estimate.norm() - reference.norm());
}

template <int kAxis>
double error_axis(const Eigen::Vector3d& estimate, const Eigen::Vector3d& reference) {
  return std::abs(estimate[kAxis] - reference[kAxis]);
}

using ErrorOf = double (*)(const Eigen::Vector3d&, const Eigen::Vector3d&);

template <ErrorOf kError, int kPercent, unsigned kAxes>
bool clipped_error(const ScoredEstimate& scored, double& value) {
  if (!clipping_truth(scored).is_reference()) return false;
  std::vector<double> errors;
  for (const PairedRate& pair : paired_rates(scored)) {
    if ((pair.clipped_axes() & kAxes) != 0)
      errors.push_back(kError(pair.estimate->w_WI_I_rad_s, pair.truth->rate_rad_s));
  }
  return quantile_of(errors, 0.01 * kPercent, value);
}

template <ErrorOf kError, int kPercent>
bool reference_error(const ScoredEstimate& scored, double& value) {
  const ClippingTruth& truth = clipping_truth(scored);
  if (!truth.is_reference()) return false;
  const auto& reading = scored.sensors().imus.front().gyro_rad_s;
  Eigen::Vector3d extreme = Eigen::Vector3d::Zero();
  for (const Eigen::Vector3d& w : reading) extreme = extreme.cwiseMax(w.cwiseAbs());
  std::vector<double> errors;
  for (std::size_t k = 0; k < reading.size(); ++k) {
    const bool far = (reading[k].cwiseAbs().array() < kFarShare * extreme.array()).all();
    if (!far || !truth.known(k) || truth.clipped_axes(k) != 0 || reading[k].norm() < kRotating_rad_s) continue;
    errors.push_back(kError(scored.truth().imus.front().rate_rad_s[k], reading[k]));
  }
  return quantile_of(errors, 0.01 * kPercent, value);
}

/// The standard deviation of the reference rate is 1.4826 times the median absolute difference between the reference
/// rate and the unclipped gyro readings. The factor 1.4826 converts a median absolute difference to a standard
/// deviation for normally distributed differences.
Eigen::Vector3d reference_variance(const ScoredEstimate& scored, const ClippingTruth& truth) {
  const auto& reading = scored.sensors().imus.front().gyro_rad_s;
  Eigen::Vector3d variance = Eigen::Vector3d::Zero();
  for (int j = 0; j < 3; ++j) {
    std::vector<double> sizes;
    for (std::size_t k = 0; k < reading.size(); ++k) {
      if (truth.known(k) && truth.clipped_axes(k) == 0 && reading[k].norm() >= kRotating_rad_s)
        sizes.push_back(std::abs(scored.truth().imus.front().rate_rad_s[k][j] - reading[k][j]));
    }
    const double sigma = sizes.empty() ? 0.0 : 1.4826 * quantile(sizes, 0.5);
    variance[j] = sigma * sigma;
  }
  return variance;
}

bool reference_coverage(const ScoredEstimate& scored, double& value) {
  const ClippingTruth& truth = clipping_truth(scored);
  if (!truth.is_reference()) return false;
  const Eigen::Vector3d own = reference_variance(scored, truth);
  double axes = 0.0, within = 0.0;
  for (const PairedRate& pair : paired_rates(scored)) {
    if (!pair.has_covariance()) continue;
    for (int j = 0; j < 3; ++j) {
      if ((pair.clipped_axes() & (1u << j)) == 0) continue;
      const double error = pair.error_rad_s()[j];
      axes += 1.0;
      within += error * error <= 9.0 * (pair.estimate->covariance_rad2_s2(j, j) + own[j]) ? 1.0 : 0.0;
    }
  }
  value = within / axes;
  return axes > 0.0;
}

bool called_measured(const ScoredEstimate& scored, double& value) {
  if (!clipping_truth(scored).is_reference()) return false;
  double axes = 0.0, missed = 0.0;
  for (const PairedRate& pair : paired_rates(scored)) {
    const AngularRateState& rate = *pair.estimate;
    for (unsigned j = 0; j < 3; ++j) {
      if ((pair.clipped_axes() & (1u << j)) == 0) continue;
      axes += 1.0;
      const bool is_unmeasured = rate.clipped_axes == 0 && rate.source != AngularRateSource::measured;
      missed += (rate.clipped_axes & (1u << j)) == 0 && !is_unmeasured ? 1.0 : 0.0;
    }
  }
  value = missed / axes;
  return axes > 0.0;
}

bool clipped_samples(const ScoredEstimate& scored, double& value) {
  const ClippingTruth& truth = clipping_truth(scored);
  if (!truth.is_reference()) return false;
  value = 0.0;
  for (std::size_t k = 0; k < truth.size(); ++k) value += truth.clipped_axes(k) != 0 ? 1.0 : 0.0;
  return true;
}

template <ErrorOf kError, unsigned kAxes>
void add_pair(const std::string& name, const std::string& doc, std::vector<Metric>& all) {
  all.push_back({{"rate_" + name + "_clipped_median_rad_s", Unit::rad_s, "median " + doc, Sense::lower},
                 Kind::rate,
                 clipped_error<kError, 50, kAxes>});
  all.push_back({{"rate_" + name + "_clipped_p90_rad_s", Unit::rad_s, "90th percentile of the " + doc, Sense::lower},
                 Kind::rate,
                 clipped_error<kError, 90, kAxes>});
}

template <ErrorOf kError>
void add_reference(const std::string& name, const std::string& doc, std::vector<Metric>& all) {
  all.push_back({{"rate_" + name + "_median_rad_s", Unit::rad_s, "median " + doc, Sense::none},
                 Kind::rate,
                 reference_error<kError, 50>});
  all.push_back({{"rate_" + name + "_p90_rad_s", Unit::rad_s, "90th percentile of the " + doc, Sense::none},
                 Kind::rate,
                 reference_error<kError, 90>});
}

}  // namespace

std::vector<Metric> reference_rate_metrics() {
  std::vector<Metric> all;
  all.push_back(
      {{"rate_error_clipped_p90_rad_s", Unit::rad_s,
        "90th percentile of the rate error (norm) relative to a reference, over clipped samples", Sense::lower},
       Kind::rate,
       clipped_error<error_norm, 90, 7u>});
  add_pair<error_speed, 7u>(
      "speed_error", "difference between the magnitudes of estimated rate and reference rate, over clipped samples",
      all);
  add_pair<error_axis<0>, 1u>(
      "error_x", "rate error of axis x relative to a reference, over samples in which axis x is clipped", all);
  add_pair<error_axis<1>, 2u>(
      "error_y", "rate error of axis y relative to a reference, over samples in which axis y is clipped", all);
  add_pair<error_axis<2>, 4u>(
      "error_z", "rate error of axis z relative to a reference, over samples in which axis z is clipped", all);
  add_reference<error_norm>(
      "reference_error", "norm of the difference between the rates of reference and gyro, in motion without clipping",
      all);
  add_reference<error_speed>(
      "reference_speed_error",
      "difference between the magnitudes of the rates of reference and gyro, in motion without clipping", all);
  all.push_back(
      {{"rate_reference_coverage_3sigma", Unit::share,
        "share of clipped axes whose rate error is within three combined standard deviations of method and reference",
        Sense::two_sided, Place::detail, kNormal3Sigma, Compared::by_difference},
       Kind::rate,
       reference_coverage});
  all.push_back(
      {{"rate_clipped_called_measured", Unit::share,
        "share of the axes that are clipped according to the reference, but that the method reports as measured",
        Sense::lower},
       Kind::rate,
       called_measured});
  all.push_back({{"rate_reference_clipped_samples", Unit::number,
                  "number of samples with an axis that is clipped according to the reference", Sense::none},
                 Kind::rate,
                 clipped_samples});
  return all;
}

}  // namespace tumble::scenarios
