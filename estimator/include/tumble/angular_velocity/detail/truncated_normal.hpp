// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

struct GaussianMoments {
  double mean = 0.0, variance = 1.0;
};

/// Returns the moments of a normal distribution truncated below `bound`, which has the variance `bound_variance`.
GaussianMoments truncated_gaussian_moments(const GaussianMoments& from, double bound, double bound_variance);

/// Gaussian factor of expectation propagation (Minka 2001), stored as precision and precision * mean.
struct GaussianLikelihoodApproximation {
  double precision = 0.0, information_mean = 0.0;
};

/// Returns the Gaussian factor that gives `marginal` the moments of a distribution truncated at `bound`. `now` is the
/// current Gaussian factor, and `share` in (0, 1] is the weight of the new one. The standard deviation of `marginal`
/// without its current factor is limited to sqrt(`variance_max`).
GaussianLikelihoodApproximation refined_bound_approximation(const GaussianMoments& marginal,
                                                            const GaussianLikelihoodApproximation& now, double bound,
                                                            double bound_variance, double variance_max, double share);

}  // namespace tumble
