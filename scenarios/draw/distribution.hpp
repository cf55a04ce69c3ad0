// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

/// Distribution describes a random parameter of a scenario. Each random parameter has a separate random stream, so an
/// additional parameter does not change the random values of the other parameters.
struct Distribution {
  enum class Shape { constant, uniform, normal, log_uniform, choice };
  Shape shape = Shape::constant;
  std::vector<double> numbers;  ///< (value), (low, high), (mean, sigma[, low, high]), or choices
  int line = 0;                 ///< for messages
  bool operator==(const Distribution&) const = default;
};

const char* to_string(Distribution::Shape shape);

/// Returns why a distribution is invalid, or an empty text. A truncated normal distribution is invalid if its limits
/// contain less than 1 % of the probability.
std::string find_problem(const Distribution& distribution);

std::vector<double> support_points(const Distribution& distribution);

double draw_number(const Distribution& distribution, std::uint64_t seed, std::string_view place);

/// Converts the standard normal number `score` to a value of `distribution`. The result increases with `score`; for a
/// list of choices, the position in the list increases with `score`. Throws BadInput if find_problem returns a problem.
double number_at(const Distribution& distribution, double score);

}  // namespace tumble::scenarios
