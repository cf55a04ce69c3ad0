// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/angular_velocity/detail/truncated_normal.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tumble {

namespace {

// Returns phi(z) / Phi(z), by an asymptotic series below z = -8, where phi and Phi may underflow.
double inverse_mills_ratio(double z) {
  if (z < -8.0) return -z / (1.0 - 1.0 / (z * z) + 3.0 / (z * z * z * z));
  const double density = std::exp(-0.5 * z * z) * std::numbers::inv_sqrtpi / std::numbers::sqrt2;
  return density / (0.5 * std::erfc(-z / std::numbers::sqrt2));
}

}  // namespace

// See rate_smoother.md (R23), (R24).
GaussianMoments truncated_gaussian_moments(const GaussianMoments& from, double bound, double bound_variance) {
  const double spread2 = from.variance + bound_variance, spread = std::sqrt(spread2);
  const double z = (from.mean - bound) / spread, r = inverse_mills_ratio(z);
  return {from.mean + from.variance * r / spread,
          from.variance - from.variance * from.variance * r * (z + r) / spread2};
}

// See rate_smoother.md (R22), (R25).
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

}  // namespace tumble
