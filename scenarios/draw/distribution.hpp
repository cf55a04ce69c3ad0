// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

/// Each random parameter has a separate random stream, so a new parameter does not change the values of the other
/// parameters.
struct Distribution {
  enum class Shape { constant, uniform, normal, log_uniform, choice };
  Shape shape = Shape::constant;
  std::vector<double> numbers;  ///< (value), (low, high), (mean, sigma[, low, high]), or choices
  int line = 0;                 ///< for messages
  bool operator==(const Distribution&) const = default;
};

const char* to_string(Distribution::Shape shape);

/// A truncated normal distribution is invalid if its limits contain less than 1 % of the probability.
std::string find_problem(const Distribution& distribution);

std::vector<double> support_points(const Distribution& distribution);

double draw_number(const Distribution& distribution, std::uint64_t seed, std::string_view place);

/// Converts the standard normal number `score` to a value of `distribution`. A larger standard normal number gives a
/// larger value of the distribution, or a later number in a list of choices. Throws BadInput if find_problem returns a
/// problem.
double number_at(const Distribution& distribution, double score);

}  // namespace tumble::scenarios
