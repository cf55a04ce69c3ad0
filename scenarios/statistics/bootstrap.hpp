// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

/// MedianBootstrap computes bias-corrected and accelerated (BCa; Efron, JASA 82:171, 1987) bootstrap confidence
/// intervals of the median, by equations (S1) to (S4) of statistics.md. The constructor draws all resamples
/// once as ranks, because the ranks of the middle values of a resample do not depend on the values.
class MedianBootstrap {
 public:
  explicit MedianBootstrap(std::size_t size, std::size_t resamples = 4000);

  /// Returns the median of `values` with its confidence interval of level 1 - `risk`. Infinite values rank like finite
  /// values, so an end of the confidence interval can be infinite. With fewer than six values, both ends of the
  /// confidence interval are infinite.
  Interval interval(std::span<const double> values, double risk = 0.05) const;

 private:
  struct Middle {
    std::size_t below, above;  ///< zero-based; equal for odd sizes
  };
  std::size_t size_;
  std::vector<Middle> middles_;
};

}  // namespace tumble::scenarios
