// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <vector>

#include "scenarios/estimates/findings.hpp"
#include "scenarios/scoring/beside_truth.hpp"
#include "scenarios/scoring/families.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kWrongDeviations = 5.0;
// If the median relative rate error or the median tilt error exceeds its limit, the estimate counts as wrong, even if
// the error agrees with the covariance.
constexpr double kWrongRateShare = 0.2, kWrongTilt_rad = 0.5;
constexpr double kMoves_rad_s = 1.0;  // smaller rates do not count

/// `deviations` contains errors divided by their standard deviations. `gross` contains relative rate errors or tilt
/// errors [rad].
struct Errors {
  std::vector<double> deviations, gross;
};

double deviations_of(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance) {
  return std::sqrt(error.dot(covariance.ldlt().solve(error)));
}

/// Returns a quantile divided by `limit`, or 0 without values.
double relative_quantile(double limit, std::vector<double> values, double share) {
  if (values.empty()) return 0.0;
  for (double& value : values) value = std::isnan(value) ? HUGE_VAL : value;
  return quantile(values, share) / limit;
}

/// Computes rate errors, normalised by the covariance without the increase that health findings cause. With the
/// increase, a health finding could make a wrong estimate consistent with its covariance.
Errors rate_errors(const ScoredEstimate& scored) {
  const std::vector<Eigen::Matrix3d>& suspect = scored.estimate().suspect_rad2_s2;
  const std::vector<PairedRate>& pairs = paired_rates(scored);
  Errors out;
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    if (!pairs[k].truth || !(pairs[k].truth->rate_rad_s.norm() > kMoves_rad_s)) continue;
    Eigen::Matrix3d covariance = pairs[k].estimate->covariance_rad2_s2;
    if (k < suspect.size()) covariance -= suspect[k];
    const Eigen::Vector3d error = pairs[k].error_rad_s();
    out.deviations.push_back(deviations_of(error, covariance));
    out.gross.push_back(error.norm() / pairs[k].truth->rate_rad_s.norm());
  }
  return out;
}

Errors tilt_errors(const ScoredEstimate& scored) {
  const TruthTrack& truth = truth_track(scored);
  Errors out;
  for (const AttitudeState& attitude : scored.estimate().attitudes) {
    if (!truth.covers_attitude(attitude.time_ns) || truth.at_rest(attitude.time_ns)) continue;
    const Eigen::Vector2d error = tilt_error_rad(attitude.orientation_W, truth.pose(attitude.time_ns).orientation_W);
    out.deviations.push_back(deviations_of(error, attitude.covariance_rad2.topLeftCorner<2, 2>()));
    out.gross.push_back(error.norm());
  }
  return out;
}

double error_ratio(const Errors& errors, double gross_limit) {
  return std::max(relative_quantile(kWrongDeviations, errors.deviations, 0.9),
                  relative_quantile(gross_limit, errors.gross, 0.5));
}

std::optional<double> pose_error_ratio(const ScoredEstimate& scored, Kind kind) {
  double nees = 0.0;
  for (const Metric& metric : metrics()) {
    if (metric.kind == kind && metric.info.name == "pose_nees" && metric.compute(scored, nees))
      return std::sqrt(nees) / kWrongDeviations;
  }
  const std::vector<PairedPose>& poses = paired_track(scored).poses;
  if (poses.empty() || scored.estimate().poses.back().covariance.isZero(0.0)) return std::nullopt;
  const double error_m = (poses.back().estimate.position_W_m - poses.back().truth.position_W_m).norm();
  const double sigma_m = std::sqrt(scored.estimate().poses.back().covariance.topLeftCorner<3, 3>().trace());
  return error_m / (kWrongDeviations * sigma_m);
}

/// Returns the error divided by the limit beyond which the estimate is wrong.
template <Kind kind>
std::optional<double> relative_error(const ScoredEstimate& scored) {
  if constexpr (kind == Kind::rate) return error_ratio(rate_errors(scored), kWrongRateShare);
  if constexpr (kind == Kind::attitude) {
    const bool reported = has_finding(HealthFinding::Kind::attitude_unknown, scored.estimate());
    return error_ratio(tilt_errors(scored), reported ? HUGE_VAL : kWrongTilt_rad);
  }
  std::optional<double> out = pose_error_ratio(scored, kind);
  if (out && std::isnan(*out)) out = HUGE_VAL;
  return out;
}

template <Kind kind>
bool wrong(const ScoredEstimate& scored, double& value) {
  const std::optional<double>& error = scored.once(relative_error<kind>);
  value = error.value_or(0.0) > 1.0 ? 1.0 : 0.0;
  return error.has_value();
}

bool is_reported(const Estimate& estimate) {
  return estimate.faults.invalidates_estimate() || has_implausible_readings(estimate);
}

bool reported(const ScoredEstimate& scored, double& value) {
  value = is_reported(scored.estimate()) ? 1.0 : 0.0;
  return true;
}

template <Kind kind>
bool unreported_error(const ScoredEstimate& scored, double& value) {
  const std::optional<double>& error = scored.once(relative_error<kind>);
  value = is_reported(scored.estimate()) ? 0.0 : error.value_or(0.0);
  return error.has_value();
}

template <Kind kind>
void add(std::vector<Metric>& out) {
  out.push_back({{"health_wrong", Unit::verdict,
                  "1 if the estimate is wrong. Rates or attitudes are wrong if 10 % of the errors in motion exceed "
                  "five reported standard deviations. Rates are also wrong if the median relative error exceeds 20 %, "
                  "and attitudes if the median tilt error exceeds 0.5 rad. Poses are wrong if the error of the last "
                  "pose exceeds five reported standard deviations",
                  Sense::none},
                 kind,
                 wrong<kind>});
  out.push_back({{"health_reported", Unit::verdict,
                  "1 if the method reports that the sensor readings are implausible or that the estimate is invalid",
                  Sense::none},
                 kind,
                 reported});
  out.push_back({{"health_unreported_error", Unit::number,
                  "error divided by the limit of health_wrong, or 0 if the method reports a fault (health_reported is "
                  "1). Above 1, "
                  "the estimate is wrong without a report",
                  Sense::lower, Place::detail, kNoTarget, Compared::by_ratio, true},
                 kind,
                 unreported_error<kind>});
}

}  // namespace

std::vector<Metric> health_metrics() {
  std::vector<Metric> out;
  add<Kind::rate>(out);
  add<Kind::attitude>(out);
  add<Kind::position>(out);
  add<Kind::slam>(out);
  return out;
}

}  // namespace tumble::scenarios
