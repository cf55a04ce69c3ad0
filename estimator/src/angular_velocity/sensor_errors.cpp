// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/sensor_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "../common/dense.hpp"

namespace tumble {

namespace {

using Vector = SensorErrors::Vector;
using Matrix = SensorErrors::Matrix;
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// `error_fraction` is 0 for the standard deviations of the data sheet, and 1 for the standard deviations of an
// uncalibrated device.
struct ErrorSize {
  double error_fraction, probability;
};
constexpr std::array<ErrorSize, 2> kScaleSizes = {{{0.0, 0.7}, {1.0, 0.3}}};
constexpr std::array<ErrorSize, 3> kCrossSizes = {{{0.0, 0.5}, {0.5, 0.2}, {1.0, 0.3}}};
constexpr std::array<ErrorSize, 2> kGSensitivitySizes = {{{0.0, 0.6}, {1.0, 0.4}}};
constexpr std::array<ErrorSize, 2> kDelaySizes = {{{0.0, 0.6}, {1.0, 0.4}}};

// A positive standard deviation keeps the prior covariance invertible.
constexpr double kLeast = 1e-9;

double between(double sheet, double unknown, double share) {
  return std::max(kLeast, unknown <= sheet ? sheet : sheet * std::pow(unknown / std::max(kLeast, sheet), share));
}

struct ErrorFractions {
  double scale_fraction = 1.0, cross_axis_fraction = 1.0, g_sensitivity_fraction = 1.0, delay_fraction = 1.0;
};

Vector prior_deviations(const SensorErrorPriors& s, const ErrorFractions& shares) {
  Vector out;
  const double delay = between(s.delay_s, s.delay_uncalibrated_s, shares.delay_fraction);
  out << Eigen::Matrix<double, 9, 1>::Constant(between(s.gyro, s.gyro_uncalibrated, shares.cross_axis_fraction)),
      Eigen::Matrix<double, 9, 1>::Constant(between(s.accel, s.accel_uncalibrated, shares.cross_axis_fraction)),
      Eigen::Matrix<double, 9, 1>::Constant(
          between(s.g_sensitivity_s_m, s.g_sensitivity_uncalibrated_s_m, shares.g_sensitivity_fraction)),
      delay, delay * delay;
  for (int i = 0; i < 3; ++i) {
    out[4 * i] = between(s.gyro, s.gyro_uncalibrated, shares.scale_fraction);
    out[SensorErrors::kAccel + 4 * i] = between(s.accel, s.accel_uncalibrated, shares.scale_fraction);
  }
  return out;
}

constexpr double kPlain = 0.05;

// Errors of the free-flight model are correlated over several samples, so the information of the readings is reduced.
constexpr double kSensorErrorEvidenceWeight = 0.03;

struct Hypothesis {
  ErrorFractions error_fractions;
  double log_odds = 0.0;
  Vector mean;
  Matrix covariance;
};

// See rate_smoother.md (R40), (R41), (R43).
Hypothesis posterior(const Matrix& information, const Matrix& earlier_runs, const Vector& h, const Vector& deviation,
                     double log_prior) {
  constexpr int kRest = SensorErrors::kSize - SensorErrors::kGSensitivity;
  const Matrix scaled = deviation.asDiagonal() * (information + earlier_runs) * deviation.asDiagonal();
  const Matrix scaled_weighted =
      deviation.asDiagonal() * (kSensorErrorEvidenceWeight * information + earlier_runs) * deviation.asDiagonal();
  const Vector scaled_h = deviation.cwiseProduct(h);
  Hypothesis out;
  const Matrix sharp = Matrix::Identity() + scaled;
  const dense::Cholesky all(sharp), weighted(Matrix::Identity() + scaled_weighted);
  Vector sharpened = scaled_h;
  all.solve_vector(sharpened);
  out.log_odds = log_prior + 0.5 * scaled_h.dot(sharpened) - all.half_log_determinant();
  // In the residuals, errors of the free-flight model look like scale and misalignment errors. As a heuristic, the
  // function assumes zero mean for scale and misalignment errors.
  Vector mean = Vector::Zero();
  mean.tail<kRest>() = scaled_h.tail<kRest>();
  dense::Cholesky(sharp.bottomRightCorner<kRest, kRest>()).solve_vector(mean.tail<kRest>());
  out.mean = deviation.cwiseProduct(mean);
  out.covariance = deviation.asDiagonal() * weighted.inverse<Matrix>() * deviation.asDiagonal();
  return out;
}

Matrix prior_scaled_evidence(const Matrix& information, const SensorErrorPriors& sizes) {
  const Vector unit = prior_deviations(sizes, {});
  const Matrix scaled = unit.asDiagonal() * (0.5 * (information + information.transpose())) * unit.asDiagonal();
  Vector values;
  Matrix vectors;
  dense::decompose(scaled, values, vectors);
  const Matrix positive = vectors * values.cwiseMax(0.0).asDiagonal() * vectors.transpose();
  return unit.cwiseInverse().asDiagonal() * positive * unit.cwiseInverse().asDiagonal();
}

}  // namespace

Vector SensorErrors::vector() const {
  Vector v;
  const RowMajor g = gyro, a = accel, f = g_sensitivity_s_m;
  v << g.reshaped<Eigen::RowMajor>(), a.reshaped<Eigen::RowMajor>(), f.reshaped<Eigen::RowMajor>(), accel_delay_s,
      accel_filter_time_variance_s2;
  return v;
}

SensorErrors SensorErrors::from(const Vector& v) {
  SensorErrors out;
  out.gyro = v.segment<9>(0).reshaped<Eigen::RowMajor>(3, 3);
  out.accel = v.segment<9>(kAccel).reshaped<Eigen::RowMajor>(3, 3);
  out.g_sensitivity_s_m = v.segment<9>(kGSensitivity).reshaped<Eigen::RowMajor>(3, 3);
  out.accel_delay_s = v[kDelay];
  out.accel_filter_time_variance_s2 = v[kAccelFilterTimeVariance];
  return out;
}

Status check_known_errors(const KnownSensorErrors& earlier_runs) {
  const auto exceeds = [](double most) { return [most](double value) { return !(std::abs(value) <= most); }; };
  const Vector errors = earlier_runs.errors.vector();
  const auto error = std::find_if(errors.begin(), errors.end(), exceeds(0.2));
  if (error != errors.end()) return {ErrorCode::out_of_range, "learnt errors", *error, 0.2};
  const auto all = earlier_runs.covariance.reshaped();
  const auto entry = std::find_if(all.begin(), all.end(), exceeds(1.0));
  if (entry != all.end()) return {ErrorCode::out_of_range, "learnt errors' covariance", *entry, 1.0};
  const Vector pivots = earlier_runs.covariance.ldlt().vectorD();
  const double least = -1e-9 * pivots.maxCoeff();
  if (pivots.minCoeff() >= least) return {};
  return {ErrorCode::out_of_range, "minimum pivot of the covariance of the estimated sensor errors", pivots.minCoeff(),
          least};
}

void require_valid_known_errors(const KnownSensorErrors& earlier_runs) {
  const Status status = check_known_errors(earlier_runs);
  if (!status.ok()) throw InvalidParams(status.field, status.value, "at most " + std::to_string(status.bound));
}

Vector prior_sigmas(const SensorErrorPriors& sizes, double share) {
  return prior_deviations(sizes, {share, share, share, share});
}

void discount_unobservable(double share, SensorErrorInformation& evidence) {
  if (share >= 1.0) return;
  // orthonormal directions in which the readings do not determine the sensor errors
  Eigen::Matrix<double, SensorErrors::kSize, 5> unobservable = Eigen::Matrix<double, SensorErrors::kSize, 5>::Zero();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    unobservable(4 * i, 0) = unobservable(SensorErrors::kAccel + 4 * i, 1) = std::sqrt(1.0 / 3.0);
    unobservable(3 * j + k, 2 + i) = unobservable(SensorErrors::kAccel + 3 * j + k, 2 + i) = 0.5;
    unobservable(3 * k + j, 2 + i) = unobservable(SensorErrors::kAccel + 3 * k + j, 2 + i) = -0.5;
  }
  // Reduces the information along the unobservable directions. No full matrix is stored, because the thread that runs
  // AngularRateStream may have a small stack.
  Eigen::Matrix<double, 5, SensorErrors::kSize> components = unobservable.transpose().lazyProduct(evidence.information);
  evidence.information.noalias() -= (1.0 - share) * unobservable.lazyProduct(components);
  components = unobservable.transpose().lazyProduct(evidence.information.transpose());
  evidence.information.noalias() -= (1.0 - share) * components.transpose().lazyProduct(unobservable.transpose());
  const Eigen::Matrix<double, 5, 1> pulled = unobservable.transpose().lazyProduct(evidence.gradient);
  evidence.gradient.noalias() -= (1.0 - share) * unobservable.lazyProduct(pulled);
}

SensorErrorFit fit_sensor_errors(const SensorErrorInformation& evidence, const SensorErrorPriors& sizes,
                                 const SensorErrorInformation& earlier_runs) {
  const Matrix information = prior_scaled_evidence(evidence.information, sizes);
  const Vector h = evidence.gradient + information * evidence.linearisation_point.vector() + earlier_runs.gradient +
                   earlier_runs.information * earlier_runs.linearisation_point.vector();
  const bool one_matrix = sizes.gyro_uncalibrated <= sizes.gyro && sizes.accel_uncalibrated <= sizes.accel;
  const bool one_g_sensitivity = sizes.g_sensitivity_uncalibrated_s_m <= sizes.g_sensitivity_s_m,
             one_delay = sizes.delay_uncalibrated_s <= sizes.delay_s;
  std::vector<Hypothesis> all;
  for (std::size_t i = 0; i < (one_matrix ? 1 : kScaleSizes.size()); ++i) {
    for (std::size_t m = 0; m < (one_matrix ? 1 : kCrossSizes.size()); ++m) {
      for (std::size_t f = 0; f < (one_g_sensitivity ? 1 : kGSensitivitySizes.size()); ++f) {
        for (std::size_t d = 0; d < (one_delay ? 1 : kDelaySizes.size()); ++d) {
          const ErrorSize scale = kScaleSizes[i], cross = kCrossSizes[m], g_sensitivity = kGSensitivitySizes[f],
                          delay = kDelaySizes[d];
          const ErrorFractions shares{scale.error_fraction, cross.error_fraction, g_sensitivity.error_fraction,
                                      delay.error_fraction};
          const double prior = scale.probability * cross.probability * g_sensitivity.probability * delay.probability;
          all.push_back(
              posterior(information, earlier_runs.information, h, prior_deviations(sizes, shares), std::log(prior)));
          all.back().error_fractions = shares;
        }
      }
    }
  }
  double best = all.front().log_odds, sum = 0.0;
  for (const Hypothesis& one : all) best = std::max(best, one.log_odds);
  for (Hypothesis& one : all) sum += one.log_odds = std::exp(one.log_odds - best);
  SensorErrorFit out{{}, 0.0, 0.0};
  for (Hypothesis& one : all) {
    one.log_odds /= sum;
    if (one.error_fractions.scale_fraction == 0.0) out.data_sheet_probability += one.log_odds;
    if (one.error_fractions.delay_fraction == 0.0) out.synchronous_triads_probability += one.log_odds;
  }
  Vector mean = Vector::Zero();
  double kept = 0.0;
  for (const Hypothesis& one : all) {
    if (out.synchronous_triads_probability > kPlain && one.error_fractions.delay_fraction > 0.0) continue;
    mean += one.log_odds * one.mean;
    kept += one.log_odds;
  }
  mean /= std::max(kept, 1e-300);
  // See rate_smoother.md (R42).
  for (const Hypothesis& one : all) {
    const Vector off = one.mean - mean;
    out.fitted_errors.covariance += one.log_odds * (one.covariance + off * off.transpose());
  }
  out.fitted_errors.errors = SensorErrors::from(mean);
  return out;
}

// See rate_smoother.md (R43).
SensorErrorInformation evidence_from_earlier_runs(const KnownSensorErrors& earlier_runs,
                                                  const SensorErrorPriors& sizes) {
  const Vector unit = prior_deviations(sizes, {});
  const Matrix symmetric = 0.5 * (earlier_runs.covariance + earlier_runs.covariance.transpose());
  const Matrix scaled = unit.cwiseInverse().asDiagonal() * symmetric * unit.cwiseInverse().asDiagonal();
  Vector values;
  Matrix vectors;
  dense::decompose(scaled, values, vectors);
  // If a loaded variance equals the prior variance for a linear combination of sensor errors, the loaded calibration
  // contains no information about this linear combination.
  const Vector precision_ratio = values.cwiseMax(1e-12).cwiseInverse();
  const Vector of_mean = (precision_ratio.array() > 1.0).select(precision_ratio, Vector::Zero());
  const auto in_units = [&](const Vector& kept_values) -> Matrix {
    const Matrix kept = vectors * kept_values.asDiagonal() * vectors.transpose();
    return unit.cwiseInverse().asDiagonal() * kept * unit.cwiseInverse().asDiagonal();
  };
  SensorErrorInformation out;
  out.information = in_units((precision_ratio.array() - 1.0).cwiseMax(0.0));
  out.gradient = in_units(of_mean) * earlier_runs.errors.vector();
  return out;
}

}  // namespace tumble
