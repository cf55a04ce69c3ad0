// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "tumble/angular_velocity/detail/rate_model.hpp"
#include "tumble/angular_velocity/detail/rate_observation.hpp"

namespace tumble {

namespace {

using Eigen::Vector3d;

// initial precision (inverse variance) of the lower bound from a clipped reading, (rad/s)^-2
constexpr double kStartPrecision = 0.25;

constexpr int kFlightSearchSteps = 6;
constexpr double kFlightSearchStepMax = 3.0, kFlightForceRatioMax = 0.25;

struct GaussianMoments {
  double mean = 0.0, variance = 1.0;
};

/// Gaussian factor of expectation propagation (Minka 2001), stored as precision and precision * mean.
struct GaussianLikelihoodApproximation {
  double precision = 0.0, information_mean = 0.0;
};

// Returns phi(z) / Phi(z) for the density phi and the distribution function Phi of the standard normal distribution.
// Below z = -8, where phi and Phi may underflow, the function uses an asymptotic series.
double inverse_mills_ratio(double z) {
  if (z < -8.0) return -z / (1.0 - 1.0 / (z * z) + 3.0 / (z * z * z * z));
  const double density = std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
  return density / (0.5 * std::erfc(-z / std::numbers::sqrt2));
}

// Returns the moments of a normal distribution truncated below an uncertain bound with the mean `bound` and the
// variance `bound_variance`: rate_smoother.md (R23), (R24).
GaussianMoments truncated_gaussian_moments(const GaussianMoments& from, double bound, double bound_variance) {
  const double spread2 = from.variance + bound_variance, spread = std::sqrt(spread2);
  const double z = (from.mean - bound) / spread, r = inverse_mills_ratio(z);
  return {from.mean + from.variance * r / spread,
          from.variance - from.variance * from.variance * r * (z + r) / spread2};
}

// Returns a new Gaussian factor that approximates the lower bound `bound` by expectation propagation: rate_smoother.md
// (R22), (R25). The cavity distribution is the distribution `marginal` divided by the previous factor `now`.
// `variance_max` limits the variance of the cavity distribution.
GaussianLikelihoodApproximation refined_bound_approximation(const GaussianMoments& marginal,
                                                            const GaussianLikelihoodApproximation& now, double bound,
                                                            double bound_variance, double variance_max, double share) {
  const double precision = std::max(1.0 / marginal.variance - now.precision, 1.0 / variance_max);
  const GaussianMoments cavity{(marginal.mean / marginal.variance - now.information_mean) / precision, 1.0 / precision};
  const GaussianMoments wanted = truncated_gaussian_moments(cavity, bound, bound_variance);
  const double found = std::max(0.0, 1.0 / wanted.variance - precision);
  const double shift = wanted.mean / wanted.variance - precision * cavity.mean;
  return {now.precision + share * (found - now.precision),
          now.information_mean + share * (shift - now.information_mean)};
}

}  // namespace

void AngularRateModel::search_flight_solutions(const AngularRateObservation& observation, const BodyImuConstants& rig,
                                               AngularRateEstimate& estimate) const {
  const int unmeasured_axes = observation.unmeasured_axes();
  if (unmeasured_axes == 0 || observation.clipping.accel != 0) return;
  const Vector3d reading = corrected_rate(observation, estimate);
  AngularRateEstimate flight_estimate = estimate;
  const Eigen::Matrix3d J = rig.inertia_matrix_with_trace_3();
  // If the device compensates misalignment, the saturation deficit of one sensing element (true rate minus clipped
  // reading) changes all output axes: rails.md (R51).
  Eigen::Matrix3d rows;
  for (int j = 0; j < 3; ++j) rows.row(j) = rig.gyro_sensing_direction(j);
  const Eigen::Matrix3d deficit_directions = rows.inverse();
  AngularRateFactor flight;
  for (int iteration = 0; iteration <= kFlightSearchSteps; ++iteration) {
    Vector3d& w = flight_estimate.knot.rate_rad_s;
    flight_estimate.knot.acceleration_rad_s2 = -J.llt().solve(w.cross(Vector3d(J * w)));
    flight = this->flight(observation, flight_estimate.knot, rig);
    if (iteration == kFlightSearchSteps) break;
    const Eigen::Matrix3d by_hidden = flight.jacobian_knot.leftCols<3>() * deficit_directions;
    Eigen::Matrix3d H = 1e-9 * Eigen::Matrix3d::Identity();
    Vector3d g = Vector3d::Zero();
    for (int j = 0; j < 3; ++j) {
      if ((unmeasured_axes >> j & 1) == 0) continue;
      g[j] = -by_hidden.col(j).dot(flight.residual);
      for (int i = 0; i < 3; ++i) {
        if ((unmeasured_axes >> i & 1) != 0) H(i, j) += by_hidden.col(i).dot(by_hidden.col(j));
      }
    }
    w += deficit_directions * H.llt().solve(g).cwiseMax(-kFlightSearchStepMax).cwiseMin(kFlightSearchStepMax);
    for (int j = 0; j < 3; ++j) {
      if ((unmeasured_axes & observation.clipping.gyro & 1 << j) == 0) continue;
      const double side = std::copysign(1.0, reading[j]), high = std::max(std::abs(reading[j]), params_.kRateMax_rad_s);
      const double along = rows.row(j).dot(w), held = rows.row(j).dot(reading);
      w += (side * std::clamp(side * along, std::abs(held), std::max(high, std::abs(held))) - along) *
           deficit_directions.col(j);
    }
  }
  const double gentle = kFlightForceRatioMax * observation.sample.specific_force_m_s2.norm();
  if (flight.residual.norm() > std::min(gentle, 0.5 * estimate.contact_force_m_s2.norm())) return;
  estimate.knot = flight_estimate.knot;
  estimate.contact_force_m_s2 = -flight.residual;
}

void AngularRateModel::initialise_rate_bounds(const AngularRateObservation& observation, const BodyImuConstants& rig,
                                              AngularRateEstimate& estimate) const {
  estimate.use_soft_bounds = true;
  const AngularRateFactor off =
      sensing_axis_factor(knot_at_reading(observation, estimate), rig, corrected_rate(observation, estimate));
  for (int j = 0; j < 3; ++j) {
    if ((observation.unmeasured_axes() & observation.clipping.gyro & 1u << j) == 0) continue;
    const double guess = off.residual[j];
    const bool negative = observation.sample.angular_velocity_rad_s[j] < 0.0;
    estimate.lower_bound_precision[j] = kStartPrecision;
    estimate.lower_bound_information_mean[j] =
        kStartPrecision * (negative ? std::min(guess, 0.0) : std::max(guess, 0.0));
  }
}

void AngularRateModel::update_bounds(const AngularRateObservation& observation, const BodyImuConstants& rig,
                                     const arrow::Conditional& conditional,
                                     const BodyImuConstants::Matrix& rig_covariance, double damping,
                                     AngularRateEstimate& estimate) const {
  if ((observation.unmeasured_axes() & observation.clipping.gyro) == 0) return;
  const AngularRateFactor off =
      sensing_axis_factor(knot_at_reading(observation, estimate), rig, corrected_rate(observation, estimate));
  for (int j = 0; j < 3; ++j) {
    if ((observation.unmeasured_axes() & observation.clipping.gyro & 1u << j) == 0) continue;
    const double sign = observation.sample.angular_velocity_rad_s[j] < 0.0 ? -1.0 : 1.0;
    const Vector3d row = off.jacobian_knot.row(j).head<3>();
    Eigen::Matrix<double, 1, BodyImuConstants::kSize> jacobian_calibration = off.jacobian_calibration.row(j);
    for (int i = 0; i < 3; ++i) jacobian_calibration += row[i] * conditional.border_jacobian.row(i);
    const Eigen::Matrix<double, 1, BodyImuConstants::kSize> cross = jacobian_calibration.lazyProduct(rig_covariance);
    const Vector3d by_state = conditional.state.topLeftCorner<3, 3>().lazyProduct(row);
    // See rate_smoother.md (R22), (R35).
    const GaussianMoments marginal{sign * off.residual[j], row.dot(by_state) + cross.dot(jacobian_calibration)};
    const GaussianLikelihoodApproximation site = refined_bound_approximation(
        marginal, {estimate.lower_bound_precision[j], sign * estimate.lower_bound_information_mean[j]}, 0.0,
        params_.expert.kRailSigma_rad_s * params_.expert.kRailSigma_rad_s,
        params_.kRateMax_rad_s * params_.kRateMax_rad_s, damping);
    estimate.lower_bound_precision[j] = site.precision;
    estimate.lower_bound_information_mean[j] = sign * site.information_mean;
  }
}

void mark_partial_saturation(const SaturationLimitDetector& rails, const SaturationLimitDetector::State& state,
                             double noise_rad_s, const ImuSample* before, AngularRateObservation& now,
                             const ImuSample* after) {
  now.partial_saturation_flags = 0;
  for (int j = 0; j < 3; ++j) {
    const bool flagged = (now.sample.device_clip_flags >> j & 1u) != 0 && (now.clipping.unusable_gyro >> j & 1u) == 0;
    const std::optional<double> rail = rails.saturation_limit(state, j);
    if (!flagged || !rail) continue;
    const double reading = now.sample.angular_velocity_rad_s[j], sign = std::copysign(1.0, reading);
    const double neighbour = unsaturated_neighbour_reading(std::abs(reading), *rail, j, before, after,
                                                           [&](const Vector3d& beside) { return sign * beside[j]; });
    if (neighbour > std::abs(reading)) continue;
    const PartialSaturation loss = partial_saturation(std::abs(reading), neighbour, *rail, noise_rad_s);
    if (!loss.saturated) continue;
    now.partial_saturation_flags = static_cast<std::uint8_t>(now.partial_saturation_flags | 1u << j);
    now.expected_saturation_deficit_rad_s[j] = sign * loss.expected_saturation_deficit_rad_s;
    now.saturation_deficit_sigma_rad_s[j] = loss.sigma_rad_s;
  }
}

}  // namespace tumble
