// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/search/input_shift.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scenarios/draw/distribution.hpp"
#include "scenarios/statistics/paired.hpp"
#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

namespace {

/// Averages the standard normal numbers of a parameter over all copies of one initial draw (random run), and then over
/// the initial draws.
std::pair<double, std::size_t> family_mean(std::span<const ScoredPoint> draws, std::size_t number) {
  std::map<std::size_t, std::vector<double>> families;
  for (const ScoredPoint& draw : draws) families[draw.family].push_back(draw.point.normals[number]);
  double sum = 0.0;
  for (const auto& [family, scores] : families) {
    double own = 0.0;
    for (const double score : scores) own += score;
    sum += own / static_cast<double>(scores.size());
  }
  return {sum / static_cast<double>(families.size()), families.size()};
}

InputShift shift_of(const DrawnNumber& number, std::span<const ScoredPoint> draws, std::size_t index) {
  constexpr double kUpperDecile = 1.2815515655446004;  // score of the quantile 0.9
  InputShift out;
  out.number = number.place;
  const auto [mean, families] = family_mean(draws, index);
  out.shift = mean;
  out.corrected = std::erfc(std::abs(mean) * std::sqrt(0.5 * static_cast<double>(families)));
  std::vector<double> scores;
  for (const ScoredPoint& draw : draws) scores.push_back(draw.point.normals[index]);
  const auto at = [&](double score) { return number_at(number.distribution, score); };
  out.low = at(quantile(scores, 0.1));
  out.median = at(quantile(scores, 0.5));
  out.high = at(quantile(scores, 0.9));
  out.scenario_low = at(-kUpperDecile);
  out.scenario_median = at(0.0);
  out.scenario_high = at(kUpperDecile);
  return out;
}

}  // namespace

std::vector<InputShift> input_shifts(std::span<const DrawnNumber> numbers, std::span<const ScoredPoint> draws) {
  std::vector<InputShift> out;
  std::vector<double> chances;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    out.push_back(shift_of(numbers[i], draws, i));
    chances.push_back(out.back().corrected);
  }
  const std::vector<double> corrected = holm(chances);
  for (std::size_t i = 0; i < out.size(); ++i) out[i].corrected = corrected[i];
  std::stable_sort(out.begin(), out.end(),
                   [](const InputShift& a, const InputShift& b) { return std::abs(a.shift) > std::abs(b.shift); });
  return out;
}

}  // namespace tumble::scenarios
