// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/device_doubt.hpp"

#include <Eigen/Cholesky>
#include <cmath>
#include <limits>
#include <optional>

namespace tumble {

namespace {

using Matrix = SensorErrors::Matrix;
using Vector = SensorErrors::Vector;

// Share of the devices that nobody has calibrated, as fit_sensor_errors() has it of scales.
constexpr double kUnlike = 0.3;

// Samples err in common: what the model of flight misses lasts longer than one of them. Of what they say of where the
// errors lie this share is believed, as in fit_sensor_errors(), and of whether there are any ten times as much: with
// all of it half the devices that are as on their sheet are taken for others, by a rig that is not known yet.
constexpr double kBelieved = 0.03, kBelievedOfOdds = 0.3;

struct Device {
  double log_odds = 0.0;
  Matrix about_corrected = Matrix::Zero();
};

// I + share U L U
Matrix scaled_system(const SensorErrorEvidence& evidence, const Vector& deviation, double share) {
  const Matrix told = deviation.asDiagonal() * evidence.information * deviation.asDiagonal();
  return Matrix::Identity() + 0.5 * share * (told + told.transpose());
}

// rate_stream.md (R103); no number where the evidence is indefinite
double log_odds(const SensorErrorEvidence& evidence, const Vector& deviation) {
  Matrix system = scaled_system(evidence, deviation, kBelievedOfOdds);
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(system);
  if (factor.info() != Eigen::Success) return std::numeric_limits<double>::quiet_NaN();
  const Vector z = kBelievedOfOdds * deviation.cwiseProduct(evidence.gradient);
  return 0.5 * z.dot(factor.solve(z)) - system.diagonal().array().log().sum();
}

// rate_stream.md (R103)
std::optional<Device> posterior(const SensorErrorEvidence& evidence, const Vector& deviation, double prior) {
  constexpr int kRest = SensorErrors::kSize - SensorErrors::kFelt;
  Matrix system = scaled_system(evidence, deviation, kBelieved);
  // scale and misalignment stay what they are held for: what the model of flight misses looks like them
  Vector mean = Vector::Zero();
  const Eigen::Matrix<double, kRest, kRest> rest = system.bottomRightCorner<kRest, kRest>();
  mean.tail<kRest>() = rest.llt().solve(kBelieved * deviation.cwiseProduct(evidence.gradient).tail<kRest>());
  mean = deviation.cwiseProduct(mean).eval();
  const Eigen::LLT<Eigen::Ref<Matrix>> factor(system);
  if (factor.info() != Eigen::Success) return std::nullopt;
  Device out;
  out.log_odds = std::log(prior) + log_odds(evidence, deviation);
  out.about_corrected = deviation.asDiagonal();
  factor.solveInPlace(out.about_corrected);
  out.about_corrected = (deviation.asDiagonal() * out.about_corrected).eval();
  out.about_corrected += mean * mean.transpose();
  return std::isfinite(out.log_odds) && out.about_corrected.allFinite() ? std::optional(out) : std::nullopt;
}

}  // namespace

DeviceDoubt::DeviceDoubt(const SensorErrorSizes& sizes)
    : sheet_(error_deviations(sizes, 0.0)), unknown_(error_deviations(sizes, 1.0)) {}

DeviceDoubt::Open DeviceDoubt::open(const SensorErrorEvidence& evidence) const {
  const std::optional<Device> sheet = posterior(evidence, sheet_, 1.0 - kUnlike);
  const std::optional<Device> unknown = posterior(evidence, unknown_, kUnlike);
  if (!sheet || !unknown) return evidence.information.isZero() ? Open{} : open({});
  Open out;
  out.unlike = 1.0 / (1.0 + std::exp(sheet->log_odds - unknown->log_odds));
  out.covariance = (1.0 - out.unlike) * sheet->about_corrected + out.unlike * unknown->about_corrected;
  return out;
}

double DeviceDoubt::shared_delay_s2(const Open& open) const {
  const double delay_s = unknown_[SensorErrors::kDelay];
  return delay_s > sheet_[SensorErrors::kDelay] ? 0.5 * open.unlike * delay_s * delay_s : 0.0;
}

}  // namespace tumble
