// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

/// Distribution is a parameter of a scenario, constant or random. Each random parameter has its own random stream, so
/// an added parameter does not change the values of the others.
struct Distribution {
  enum class Shape { constant, uniform, normal, log_uniform, choice };
  Shape shape = Shape::constant;
  std::vector<double> numbers;  ///< by shape: (value), (low, high), (mean, sigma[, low, high]) or the choices
  int line = 0;                 ///< line in the scenario file, for messages
  bool operator==(const Distribution&) const = default;
};

/// Returns the name of the distribution's shape in scenario files, for example "log_uniform".
const char* to_string(Distribution::Shape shape);

/// Returns why the distribution is invalid, for example "low 3 is above high 2", or an empty text if it is valid. A
/// truncated normal distribution is invalid if its limits contain less than 1 % of the probability.
std::string find_problem(const Distribution& distribution);

/// Returns the extreme values of a distribution: the constant, both ends of the interval, or the choices. For a normal
/// distribution without limits, returns only the mean.
std::vector<double> support_points(const Distribution& distribution);

/// Draws the value of `place` from the random stream sim::Stream(seed, "draw." + place). A truncated normal
/// distribution is sampled again until the value is within its limits. Throws BadInput if find_problem returns a
/// problem.
double draw_number(const Distribution& distribution, std::uint64_t seed, std::string_view place);

/// Returns the value at the probability of a standard normal score: the value is the median for 0 and increases with
/// `score`. The value has the distribution if `score` is a standard normal random number. Choices have the order of the
/// list. Throws BadInput if find_problem returns a problem.
double number_at(const Distribution& distribution, double score);

}  // namespace tumble::scenarios
