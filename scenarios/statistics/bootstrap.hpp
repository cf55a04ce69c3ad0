// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

/// Bootstrap of the median of samples of one size, statistics.md (S1) to (S4): bias-corrected and accelerated intervals
/// (BCa; Efron, JASA 82:171, 1987). Which order statistics are the middle of a resample does not depend on the values,
/// so that they are drawn once, without resampling n values each time. The same size gives the same resamples, on every
/// machine. Cost: `resamples` inverse beta functions to construct, O(resamples log resamples) an interval.
class MedianBootstrap {
 public:
  /// Throws BadInput unless there is a value and `resamples` is at least 100.
  explicit MedianBootstrap(std::size_t size, std::size_t resamples = 4000);

  /// Median with its interval of level 1 - `risk`. Infinite values rank as what they are, so that an end may be
  /// infinite; below six values both are, as of `median_interval`. Throws BadInput on NaN, on another size and on a
  /// risk beyond (0, 1).
  Interval interval(std::span<const double> values, double risk = 0.05) const;

 private:
  struct Middle {
    std::size_t below, above;  ///< ranks from 0 in the sorted sample; equal where the size is odd
  };
  std::size_t size_;
  std::vector<Middle> middles_;
};

}  // namespace tumble::scenarios
