// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/sample_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

void require(const Plan& plan) {
  for (const auto& [name, value] : {std::pair{"risk", plan.risk}, std::pair{"power", plan.power}}) {
    if (!(value > 0.0 && value < 1.0))
      throw BadInput(fmt::format("sample size of a test: the {} is {}; it must be greater than 0 and less than 1", name,
                                 std::to_string(value)));
  }
}

double fewest(double risk) {
  return std::ceil(1.0 - std::log2(risk));
}

double positive_sums(std::vector<double> differences) {
  std::sort(differences.begin(), differences.end());
  double count = 0.0;
  for (auto i = differences.begin(); i != differences.end(); ++i) {
    const auto [first, last] = std::equal_range(i + 1, differences.end(), -*i);
    count += static_cast<double>(differences.end() - last) + 0.5 * static_cast<double>(last - first);
  }
  const auto n = static_cast<double>(differences.size());
  return count / (0.5 * n * (n - 1.0));
}

}  // namespace

double pairs_for_signed_rank(std::span<const double> differences, const Plan& plan) {
  require(plan);
  std::vector<double> counted;
  std::size_t pairs = 0;
  for (const double d : differences) {
    pairs += std::isnan(d) ? 0 : 1;
    if (!std::isnan(d) && d != 0.0) counted.push_back(d);
  }
  if (counted.size() < 2) return kInfinity;
  const double share = static_cast<double>(counted.size()) / static_cast<double>(pairs);
  const double effect = positive_sums(std::move(counted)) - 0.5;
  if (effect == 0.0) return kInfinity;
  const double z = normal_quantile(1.0 - 0.5 * plan.risk) + normal_quantile(plan.power);
  return std::ceil(std::max(z * z / (3.0 * effect * effect), fewest(plan.risk)) / share);
}

double pairs_for_failures(std::int64_t only_first, std::int64_t only_second, std::int64_t pairs, const Plan& plan) {
  require(plan);
  if (only_first < 0 || only_second < 0 || only_first + only_second > pairs)
    throw BadInput(
        fmt::format("sample size of a test: only the first method fails in {} pairs, and only the second method in {}; "
                    "the sum must be at most the number of pairs, {}",
                    only_first, only_second, pairs));
  if (only_first == only_second) return kInfinity;
  const auto n = static_cast<double>(pairs);
  const double either = static_cast<double>(only_first + only_second) / n;
  const double difference = static_cast<double>(only_first - only_second) / n;
  const double root = normal_quantile(1.0 - 0.5 * plan.risk) * std::sqrt(either) +
                      normal_quantile(plan.power) * std::sqrt(either - difference * difference);
  return std::ceil(std::max(root * root / (difference * difference), fewest(plan.risk) / either));
}

}  // namespace tumble::scenarios
