// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/consistency.hpp"

#include <algorithm>
#include <limits>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kNormalSquareMedian = 0.454936;  // for a standard normal variable

}  // namespace

double squared_over(double error, double variance) {
  const double square = error * error;
  if (variance > 0.0) return square / variance;
  return square == 0.0 ? 0.0 : std::numeric_limits<double>::infinity() * square;
}

bool share_within_3sigma(const std::vector<double>& squares, double& value) {
  if (squares.empty()) return false;
  const auto inside = std::count_if(squares.begin(), squares.end(), [](double square) { return square <= 9.0; });
  value = static_cast<double>(inside) / static_cast<double>(squares.size());
  return true;
}

bool normalised_median(const std::vector<double>& squares, double& value) {
  if (squares.empty()) return false;
  value = quantile(squares, 0.5) / kNormalSquareMedian;
  return true;
}

}  // namespace tumble::scenarios
