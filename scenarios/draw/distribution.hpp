// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

/// A number of a scenario: fixed or drawn. Each draws from its own named stream, so adding one leaves the others alone.
struct Distribution {
  enum class Shape { constant, uniform, normal, log_uniform, choice };
  Shape shape = Shape::constant;
  std::vector<double> numbers;  ///< constant: value; uniform, log_uniform: low, high; normal: mean, sigma[, low, high];
                                ///< choice: the values
  int line = 0;                 ///< of the file, for messages
  bool operator==(const Distribution&) const = default;
};

/// Name as in a scenario file: "log_uniform".
const char* to_string(Distribution::Shape shape);

/// Why nothing can be drawn from it ("low 3 is above high 2"), or empty when all is well. A normal distribution whose
/// truncation keeps less than 1 % of it is refused: it would not look like one.
std::string find_problem(const Distribution& distribution);

/// Numbers that are known to be in reach of draws: ends, choices, the constant. A normal without truncation gives its
/// mean alone.
std::vector<double> support_points(const Distribution& distribution);

/// The number that belongs to (seed, place): drawn from sim::Stream(seed, "draw." + place). A truncated normal is drawn
/// again until it falls inside. Throws BadInput when find_problem would complain.
double draw_number(const Distribution& distribution, std::uint64_t seed, std::string_view place);

}  // namespace tumble::scenarios
