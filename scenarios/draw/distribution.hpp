// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

/// A number of a scenario: constant or random. Each number draws from its own named stream, so adding one does not
/// change the others.
struct Distribution {
  enum class Shape { constant, uniform, normal, log_uniform, choice };
  Shape shape = Shape::constant;
  std::vector<double> numbers;  ///< constant: value; uniform, log_uniform: low, high; normal: mean, sigma[, low, high];
                                ///< choice: the values
  int line = 0;                 ///< line in the file, for messages
  bool operator==(const Distribution&) const = default;
};

/// Returns the name used in scenario files: "log_uniform".
const char* to_string(Distribution::Shape shape);

/// Returns why no number can be drawn ("low 3 is above high 2"); empty if the distribution is valid. Rejects a
/// truncated normal distribution that keeps less than 1 % of the probability.
std::string find_problem(const Distribution& distribution);

/// Returns numbers that draws can reach: interval ends, choices, or the constant. For a normal distribution without
/// truncation: only its mean.
std::vector<double> support_points(const Distribution& distribution);

/// Draws the number of (seed, place) from sim::Stream(seed, "draw." + place). A truncated normal is redrawn until the
/// number is within the limits. Throws BadInput if find_problem reports a problem.
double draw_number(const Distribution& distribution, std::uint64_t seed, std::string_view place);

}  // namespace tumble::scenarios
