// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

/// Each random parameter has its own random stream, so an added parameter does not change the values of the others.
struct Distribution {
  enum class Shape { constant, uniform, normal, log_uniform, choice };
  Shape shape = Shape::constant;
  std::vector<double> numbers;  ///< by shape: (value), (low, high), (mean, sigma[, low, high]) or the choices
  int line = 0;                 ///< line in the scenario file, for messages
  bool operator==(const Distribution&) const = default;
};

const char* to_string(Distribution::Shape shape);

/// Returns why the distribution is invalid, or an empty text. A truncated normal distribution is invalid if its limits
/// contain less than 1 % of the probability.
std::string find_problem(const Distribution& distribution);

std::vector<double> support_points(const Distribution& distribution);

/// Draws the value of `place` from the random stream sim::Stream(seed, "draw." + place). A truncated normal
/// distribution is sampled again until the value is within its limits.
double draw_number(const Distribution& distribution, std::uint64_t seed, std::string_view place);

}  // namespace tumble::scenarios
