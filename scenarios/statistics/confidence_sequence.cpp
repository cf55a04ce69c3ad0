// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/confidence_sequence.hpp"

#include <fmt/format.h>

#include <boost/math/distributions/binomial.hpp>
#include <numeric>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

Interval probability_at_any_time(std::int64_t successes, std::int64_t failures, double risk) {
  if (successes < 0 || failures < 0)
    throw BadInput(
        fmt::format("confidence sequence: {} successes and {} failures; both must be at least 0", successes, failures));
  if (!(risk > 0.0 && risk < 1.0))
    throw BadInput(fmt::format("confidence sequence: the risk is {}; it must be within (0, 1)", risk));
  if (successes + failures == 0) return {0.5, 0.0, 1.0};
  const auto trials = static_cast<double>(successes + failures), count = static_cast<double>(successes);
  const double share = count / trials;
  const auto contains = [&](double p) { return (trials + 1.0) * pdf(boost::math::binomial(trials, p), count) > risk; };
  // As a function of the probability, the likelihood of the observed count is largest at the observed fraction of
  // successes, and decreases on both sides.
  const auto limit = [&](double outside) {
    if (contains(outside)) return outside;
    double inside = share;
    constexpr int kHalvings = 60;  // to the precision of double
    for (int k = 0; k < kHalvings; ++k) {
      const double between = std::midpoint(inside, outside);
      (contains(between) ? inside : outside) = between;
    }
    return inside;
  };
  return {share, limit(0.0), limit(1.0)};
}

}  // namespace tumble::scenarios
