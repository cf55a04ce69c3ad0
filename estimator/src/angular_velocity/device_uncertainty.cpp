// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/sensor_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

namespace tumble {

namespace {

using Matrix = SensorErrors::Matrix;
using Vector = SensorErrors::Vector;

constexpr double kOddsEvidenceWeight = 0.3;

void set_normal_equations(const SensorErrorInformation& evidence, const Vector& deviation, double share,
                          Matrix& system) {
  for (int j = 0; j < SensorErrors::kSize; ++j) {
    for (int i = 0; i < SensorErrors::kSize; ++i) {
      const double system_evidence = 0.5 * (evidence.information(i, j) + evidence.information(j, i));
      system(i, j) = (i == j ? 1.0 : 0.0) + share * deviation[i] * deviation[j] * system_evidence;
    }
  }
}

// See rate_stream.md (R102).
double log_odds(const SensorErrorInformation& evidence, const Vector& deviation, Matrix& system) {
  set_normal_equations(evidence, deviation, kOddsEvidenceWeight, system);
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(system);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  const Vector z = kOddsEvidenceWeight * deviation.cwiseProduct(evidence.gradient);
  return 0.5 * z.dot(factor.solve(z)) - system.diagonal().array().log().sum();
}

// Computes the second moment (covariance plus squared mean) of one device's sensor errors: rate_stream.md (R102).
bool corrected_covariance(const SensorErrorInformation& evidence, const Vector& deviation,
                          SensorErrorUncertainty::WorkMatrices& work) {
  constexpr int kRest = SensorErrors::kSize - SensorErrors::kGSensitivity;
  constexpr double kSensorErrorEvidenceWeight = SensorErrorUncertainty::kSensorErrorEvidenceWeight;
  set_normal_equations(evidence, deviation, kSensorErrorEvidenceWeight, work.normal_matrix);
  // In the residuals, errors of the free-flight model look like scale and misalignment errors. As a heuristic, the
  // function assumes zero mean for scale and misalignment errors.
  Vector mean = Vector::Zero();
  const Eigen::Matrix<double, kRest, kRest> rest = work.normal_matrix.bottomRightCorner<kRest, kRest>();
  mean.tail<kRest>() =
      rest.llt().solve(kSensorErrorEvidenceWeight * deviation.cwiseProduct(evidence.gradient).tail<kRest>());
  mean = deviation.cwiseProduct(mean).eval();
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(work.normal_matrix);
  if (factor.info() != Eigen::Success) return false;
  for (int j = 0; j < SensorErrors::kSize;
       ++j) {  // solved column by column, because a product of all columns would use more stack
    const Vector column = factor.solve(deviation[j] * Vector::Unit(j));
    work.corrected_covariance.col(j) = deviation.cwiseProduct(column) + mean[j] * mean;
  }
  return work.corrected_covariance.allFinite();
}

}  // namespace

SensorErrorUncertainty::SensorErrorUncertainty(const SensorErrorPriors& sizes, double uncalibrated)
    : data_sheet_sigma_(prior_sigmas(sizes, 0.0)),
      uncalibrated_sigma_(prior_sigmas(sizes, 1.0)),
      uncalibrated_prior_(uncalibrated) {}

void SensorErrorUncertainty::reset(Posterior& posterior) const {
  posterior.uncalibrated_probability = uncalibrated_prior_;
  posterior.covariance = ((1.0 - uncalibrated_prior_) * data_sheet_sigma_.cwiseAbs2() +
                          uncalibrated_prior_ * uncalibrated_sigma_.cwiseAbs2())
                             .asDiagonal();
}

void SensorErrorUncertainty::update(const SensorErrorInformation& evidence, WorkMatrices& work, Posterior& posterior,
                                    bool unlike_sheet) const {
  if (unlike_sheet) {
    if (!corrected_covariance(evidence, uncalibrated_sigma_, work))
      work.corrected_covariance = uncalibrated_sigma_.cwiseAbs2().asDiagonal();
    posterior.covariance = work.corrected_covariance;
    posterior.uncalibrated_probability = 1.0;
    return;
  }
  const double odds = std::log(uncalibrated_prior_ / (1.0 - uncalibrated_prior_)) +
                      log_odds(evidence, uncalibrated_sigma_, work.normal_matrix) -
                      log_odds(evidence, data_sheet_sigma_, work.normal_matrix);
  const double unlike = 1.0 / (1.0 + std::exp(-odds));
  bool known = std::isfinite(unlike) && corrected_covariance(evidence, data_sheet_sigma_, work);
  if (known) posterior.covariance = (1.0 - unlike) * work.corrected_covariance;
  known = known && corrected_covariance(evidence, uncalibrated_sigma_, work);
  if (!known) return reset(posterior);
  posterior.covariance += unlike * work.corrected_covariance;
  posterior.uncalibrated_probability = unlike;
}

double SensorErrorUncertainty::data_sheet_odds(double delay_s, double sigma_s) const {
  const auto variance = [&](const Vector& deviation) {
    return sigma_s * sigma_s + deviation[SensorErrors::kDelay] * deviation[SensorErrors::kDelay];
  };
  const double sheet = variance(data_sheet_sigma_), unknown = variance(uncalibrated_sigma_);
  const double log_odds = 0.5 * delay_s * delay_s * (1.0 / unknown - 1.0 / sheet) + 0.5 * std::log(unknown / sheet);
  return (1.0 - uncalibrated_prior_) / uncalibrated_prior_ * std::exp(log_odds);
}

double SensorErrorUncertainty::delay_correction_s(const SensorErrorInformation& evidence, double reach_s) const {
  constexpr int kFirst = SensorErrors::kGSensitivity, kRest = SensorErrors::kSize - kFirst,
                kAt = SensorErrors::kDelay - kFirst;
  using Rest = Eigen::Matrix<double, kRest, kRest>;
  Eigen::Matrix<double, kRest, 1> deviation = uncalibrated_sigma_.tail<kRest>();
  deviation[kAt] = reach_s;
  const Rest system_evidence = evidence.information.bottomRightCorner<kRest, kRest>(),
             both = 0.5 * (system_evidence + system_evidence.transpose());
  const Rest system =
      Rest::Identity() + deviation.asDiagonal() * (kSensorErrorEvidenceWeight * both) * deviation.asDiagonal();
  const Eigen::LLT<Rest> factor(system);
  if (factor.info() != Eigen::Success) return 0.0;
  const Eigen::Matrix<double, kRest, 1> z =
      kSensorErrorEvidenceWeight * deviation.cwiseProduct(evidence.gradient.tail<kRest>());
  const double out = reach_s * factor.solve(z)[kAt];
  return std::isfinite(out) ? std::clamp(out, -reach_s, reach_s) : 0.0;
}

double SensorErrorUncertainty::common_delay_variance_s2(const Posterior& posterior) const {
  const double delay_s = uncalibrated_sigma_[SensorErrors::kDelay];
  return delay_s > data_sheet_sigma_[SensorErrors::kDelay]
             ? 0.5 * posterior.uncalibrated_probability * delay_s * delay_s
             : 0.0;
}

}  // namespace tumble
