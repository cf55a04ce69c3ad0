// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/sensor_errors.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "../common/dense.hpp"

namespace tumble {

namespace {

using Vector = SensorErrors::Vector;
using Matrix = SensorErrors::Matrix;
using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

// Sizes between data sheet (0) and uncalibrated (1), and their prior probabilities.
struct Size {
  double share, probability;
};
constexpr std::array<Size, 2> kScaleSizes = {{{0.0, 0.7}, {1.0, 0.3}}};
constexpr std::array<Size, 3> kCrossSizes = {{{0.0, 0.5}, {0.5, 0.2}, {1.0, 0.3}}};
constexpr std::array<Size, 2> kFeltSizes = {{{0.0, 0.6}, {1.0, 0.4}}};
constexpr std::array<Size, 2> kDelaySizes = {{{0.0, 0.6}, {1.0, 0.4}}};

// minimum standard deviation, so that each prior can be inverted
constexpr double kLeast = 1e-9;

double between(double sheet, double unknown, double share) {
  return std::max(kLeast, unknown <= sheet ? sheet : sheet * std::pow(unknown / std::max(kLeast, sheet), share));
}

struct Shares {
  double scale = 1.0, cross = 1.0, felt = 1.0, delay = 1.0;
};

Vector deviations(const SensorErrorSizes& s, const Shares& shares) {
  Vector out;
  const double delay = between(s.delay_s, s.delay_unknown_s, shares.delay);
  out << Eigen::Matrix<double, 9, 1>::Constant(between(s.gyro, s.gyro_unknown, shares.cross)),
      Eigen::Matrix<double, 9, 1>::Constant(between(s.accel, s.accel_unknown, shares.cross)),
      Eigen::Matrix<double, 9, 1>::Constant(between(s.felt_s_m, s.felt_unknown_s_m, shares.felt)), delay, delay * delay;
  for (int i = 0; i < 3; ++i) {
    out[4 * i] = between(s.gyro, s.gyro_unknown, shares.scale);
    out[SensorErrors::kAccel + 4 * i] = between(s.accel, s.accel_unknown, shares.scale);
  }
  return out;
}

// Probability of the data sheet's values below which the readings clearly contradict it.
constexpr double kPlain = 0.05;

// Weight of the evidence about the errors' values in the covariance. Sample errors are correlated, because errors of
// the flight model last longer than a sample. The evidence for the kind of device has full weight.
constexpr double kBelieved = 0.03;

struct Hypothesis {
  Shares shares;
  double log_odds = 0.0;
  Vector mean;
  Matrix covariance;
};

// Evidence in units of the prior's standard deviations, h = gamma + information * errors: rate_smoother.md (R40),
// (R41), (R43).
Hypothesis posterior(const Matrix& information, const Matrix& learnt, const Vector& h, const Vector& deviation,
                     double log_prior) {
  constexpr int kRest = SensorErrors::kSize - SensorErrors::kFelt;
  const Matrix scaled = deviation.asDiagonal() * (information + learnt) * deviation.asDiagonal();
  const Matrix scaled_believed = deviation.asDiagonal() * (kBelieved * information + learnt) * deviation.asDiagonal();
  const Vector scaled_h = deviation.cwiseProduct(h);
  Hypothesis out;
  const Matrix sharp = Matrix::Identity() + scaled;
  const dense::Cholesky all(sharp), believed(Matrix::Identity() + scaled_believed);
  Vector sharpened = scaled_h;
  all.solve_vector(sharpened);
  out.log_odds = log_prior + 0.5 * scaled_h.dot(sharpened) - all.half_log_determinant();
  // scale and misalignment are not corrected, because errors of the flight model look like them
  Vector mean = Vector::Zero();
  mean.tail<kRest>() = scaled_h.tail<kRest>();
  dense::Cholesky(sharp.bottomRightCorner<kRest, kRest>()).solve_vector(mean.tail<kRest>());
  out.mean = deviation.cwiseProduct(mean);
  out.covariance = deviation.asDiagonal() * believed.inverse<Matrix>() * deviation.asDiagonal();
  return out;
}

Matrix evidence_of(const Matrix& information, const SensorErrorSizes& sizes) {
  const Vector unit = deviations(sizes, {});
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
  const RowMajor g = gyro, a = accel, f = felt_s_m;
  v << g.reshaped<Eigen::RowMajor>(), a.reshaped<Eigen::RowMajor>(), f.reshaped<Eigen::RowMajor>(), accel_delay_s,
      accel_blur_s2;
  return v;
}

SensorErrors SensorErrors::from(const Vector& v) {
  SensorErrors out;
  out.gyro = v.segment<9>(0).reshaped<Eigen::RowMajor>(3, 3);
  out.accel = v.segment<9>(kAccel).reshaped<Eigen::RowMajor>(3, 3);
  out.felt_s_m = v.segment<9>(kFelt).reshaped<Eigen::RowMajor>(3, 3);
  out.accel_delay_s = v[kDelay];
  out.accel_blur_s2 = v[kBlur];
  return out;
}

void require_known(const KnownSensorErrors& learnt) {
  for (const double value : learnt.errors.vector()) require_within("learnt errors", value, -0.2, 0.2);
  for (const double value : learnt.covariance.reshaped()) require_within("learnt errors' covariance", value, -1.0, 1.0);
  const Vector pivots = learnt.covariance.ldlt().vectorD();
  require_within("learnt errors' covariance, least pivot", pivots.minCoeff(), -1e-9 * pivots.maxCoeff(), 1.0);
}

Vector error_deviations(const SensorErrorSizes& sizes, double share) {
  return deviations(sizes, {share, share, share, share});
}

void discount_untold(double share, SensorErrorEvidence& evidence) {
  if (share >= 1.0) return;
  // orthonormal columns
  Eigen::Matrix<double, SensorErrors::kSize, 5> untold = Eigen::Matrix<double, SensorErrors::kSize, 5>::Zero();
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    untold(4 * i, 0) = untold(SensorErrors::kAccel + 4 * i, 1) = std::sqrt(1.0 / 3.0);
    untold(3 * j + k, 2 + i) = untold(SensorErrors::kAccel + 3 * j + k, 2 + i) = 0.5;
    untold(3 * k + j, 2 + i) = untold(SensorErrors::kAccel + 3 * k + j, 2 + i) = -0.5;
  }
  // (I - d U U') on both sides, by U's few columns, because a stream's thread may have a small stack
  Eigen::Matrix<double, 5, SensorErrors::kSize> said = untold.transpose().lazyProduct(evidence.information);
  evidence.information.noalias() -= (1.0 - share) * untold.lazyProduct(said);
  said = untold.transpose().lazyProduct(evidence.information.transpose());
  evidence.information.noalias() -= (1.0 - share) * said.transpose().lazyProduct(untold.transpose());
  const Eigen::Matrix<double, 5, 1> pulled = untold.transpose().lazyProduct(evidence.gradient);
  evidence.gradient.noalias() -= (1.0 - share) * untold.lazyProduct(pulled);
}

SensorErrorFit fit_sensor_errors(const SensorErrorEvidence& evidence, const SensorErrorSizes& sizes,
                                 const SensorErrorEvidence& learnt) {
  const Matrix information = evidence_of(evidence.information, sizes);
  const Vector h = evidence.gradient + information * evidence.about.vector() + learnt.gradient +
                   learnt.information * learnt.about.vector();
  const bool one_matrix = sizes.gyro_unknown <= sizes.gyro && sizes.accel_unknown <= sizes.accel;
  const bool one_felt = sizes.felt_unknown_s_m <= sizes.felt_s_m, one_delay = sizes.delay_unknown_s <= sizes.delay_s;
  std::vector<Hypothesis> all;
  for (std::size_t i = 0; i < (one_matrix ? 1 : kScaleSizes.size()); ++i) {
    for (std::size_t m = 0; m < (one_matrix ? 1 : kCrossSizes.size()); ++m) {
      for (std::size_t f = 0; f < (one_felt ? 1 : kFeltSizes.size()); ++f) {
        for (std::size_t d = 0; d < (one_delay ? 1 : kDelaySizes.size()); ++d) {
          const Size scale = kScaleSizes[i], cross = kCrossSizes[m], felt = kFeltSizes[f], delay = kDelaySizes[d];
          const Shares shares{scale.share, cross.share, felt.share, delay.share};
          const double prior = scale.probability * cross.probability * felt.probability * delay.probability;
          all.push_back(posterior(information, learnt.information, h, deviations(sizes, shares), std::log(prior)));
          all.back().shares = shares;
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
    if (one.shares.scale == 0.0) out.calibrated += one.log_odds;
    if (one.shares.delay == 0.0) out.together += one.log_odds;
  }
  // the data sheet determines the corrections until readings clearly contradict it
  Vector mean = Vector::Zero();
  double kept = 0.0;
  for (const Hypothesis& one : all) {
    if (out.together > kPlain && one.shares.delay > 0.0) continue;
    mean += one.log_odds * one.mean;
    kept += one.log_odds;
  }
  mean /= std::max(kept, 1e-300);
  // relative to the mean in use: rate_smoother.md (R42)
  for (const Hypothesis& one : all) {
    const Vector off = one.mean - mean;
    out.known.covariance += one.log_odds * (one.covariance + off * off.transpose());
  }
  out.known.errors = SensorErrors::from(mean);
  return out;
}

// rate_smoother.md (R43)
SensorErrorEvidence learnt_evidence(const KnownSensorErrors& learnt, const SensorErrorSizes& sizes) {
  const Vector unit = deviations(sizes, {});
  const Matrix symmetric = 0.5 * (learnt.covariance + learnt.covariance.transpose());
  const Matrix scaled = unit.cwiseInverse().asDiagonal() * symmetric * unit.cwiseInverse().asDiagonal();
  Vector values;
  Matrix vectors;
  dense::decompose(scaled, values, vectors);
  // directions with their prior variance contain no information
  const Vector told = values.cwiseMax(1e-12).cwiseInverse();
  const Vector of_mean = (told.array() > 1.0).select(told, Vector::Zero());
  const auto in_units = [&](const Vector& kept_values) -> Matrix {
    const Matrix kept = vectors * kept_values.asDiagonal() * vectors.transpose();
    return unit.cwiseInverse().asDiagonal() * kept * unit.cwiseInverse().asDiagonal();
  };
  SensorErrorEvidence out;
  out.information = in_units((told.array() - 1.0).cwiseMax(0.0));
  out.gradient = in_units(of_mean) * learnt.errors.vector();
  return out;
}

}  // namespace tumble
