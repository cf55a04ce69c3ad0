// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace tumble {

/// Mean and variance of a normal distribution.
struct NormalMoments {
  double mean = 0.0, variance = 1.0;
};

/// Moments of a normal distribution of which only what lies beyond `bound` is left, the bound itself being known with
/// variance `softness2`: the step of expectation propagation (Minka 2001).
NormalMoments truncated_below(const NormalMoments& from, double bound, double softness2);

/// A Gaussian factor, as precision and precision * mean.
struct NormalSite {
  double precision = 0.0, shift = 0.0;
};

/// The site with which `marginal` has the moments that truncation at `bound` gives it, `now` being the site in it;
/// damped: `share` in (0, 1] of the new. The marginal without its site is taken to be no wider than sqrt(`widest2`).
NormalSite refined_bound(const NormalMoments& marginal, const NormalSite& now, double bound, double softness2,
                         double widest2, double share);

}  // namespace tumble
