// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

/// SplittingEstimate accumulates the probability of a level in adaptive multilevel splitting, and the variance of its
/// logarithm, equations (S25) to (S30) of statistics.md.
class SplittingEstimate {
 public:
  explicit SplittingEstimate(std::size_t population) : population_(population) {}

  /// Adds a step that removed `removed` draws of the population; `copies` contains the number of copies of each
  /// remaining draw, including the draw.
  void advance(std::size_t removed, std::span<const std::size_t> copies);

  /// Returns the probability that a random draw exceeds the level, with its 95 % interval.
  Interval of_level(std::span<const std::size_t> families) const;

  /// Returns the probability of a failure with its 95 % interval. `families` contains ScoredPoint::family (the initial
  /// draw) of all draws in the population, and `failing` contains ScoredPoint::family of the failing draws.
  Interval of_failure(std::span<const std::size_t> families, std::span<const std::size_t> failing) const;

 private:
  Interval interval(std::span<const std::size_t> families, double risk) const;

  std::size_t population_;
  double log_probability_ = 0.0;
  double poisson_variance_ = 0.0;  ///< variance of the logarithm if all members are independent
  double log_correction_ = 0.0;    ///< factor of the fraction of unrelated pairs, equation (S29)
};

}  // namespace tumble::scenarios
