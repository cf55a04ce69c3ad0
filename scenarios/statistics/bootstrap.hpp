// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

/// Bootstrap intervals for the median of samples of one size, statistics.md (S1) to (S4): bias-corrected and
/// accelerated (BCa; Efron, JASA 82:171, 1987). The ranks of a resample's middle values do not depend on the values.
/// They are therefore drawn once, without resampling n values. The same size gives the same resamples on every machine.
/// Cost: `resamples` inverse beta functions to construct, O(resamples log resamples) per interval.
class MedianBootstrap {
 public:
  /// Throws BadInput if `size` is 0 or `resamples` is below 100.
  explicit MedianBootstrap(std::size_t size, std::size_t resamples = 4000);

  /// Returns the median with its interval of level 1 - `risk`. Infinite values are ranked normally, so an end may be
  /// infinite. Below six values both ends are infinite, as in `median_interval`. Throws BadInput for NaN, another size,
  /// or a risk outside (0, 1).
  Interval interval(std::span<const double> values, double risk = 0.05) const;

 private:
  struct Middle {
    std::size_t below, above;  ///< zero-based ranks in the sorted sample; equal if the size is odd
  };
  std::size_t size_;
  std::vector<Middle> middles_;
};

}  // namespace tumble::scenarios
