// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/statistics/dependence.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <utility>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

namespace {

constexpr double kTwoSided95 = 1.959963984540054;  // normal quantile of 0.975
constexpr std::size_t kIntervalMin = 4, kStudentMin = 10, kClassesFrom = 24;

using CompletePairs = std::vector<std::pair<double, double>>;

CompletePairs complete_pairs(std::span<const double> x, std::span<const double> y) {
  if (x.size() != y.size())
    throw BadInput(
        fmt::format("dependence of two numbers: the first list has {} values, but the second list has {}; both must "
                    "have the same length",
                    x.size(), y.size()));
  CompletePairs pairs;
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isnan(x[i]) && !std::isnan(y[i])) pairs.emplace_back(x[i], y[i]);
  }
  return pairs;
}

std::vector<double> column(const CompletePairs& pairs, double std::pair<double, double>::*member) {
  std::vector<double> out;
  out.reserve(pairs.size());
  for (const auto& pair : pairs) out.push_back(pair.*member);
  return out;
}

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<std::size_t> class_ends(const CompletePairs& sorted, std::size_t wanted) {
  const std::size_t n = sorted.size();
  std::vector<std::size_t> distinct;
  for (std::size_t i = 1; i <= n; ++i) {
    if (i == n || sorted[i].first != sorted[i - 1].first) distinct.push_back(i);
  }
  if (distinct.size() <= wanted) return distinct;
  std::vector<std::size_t> ends;
  for (std::size_t k = 1; k <= wanted; ++k) {
    const std::size_t end = *std::lower_bound(distinct.begin(), distinct.end(), k * n / wanted);
    if (ends.empty() || end > ends.back()) ends.push_back(end);
  }
  return ends;
}

Interval mean_interval(std::span<const double> values) {
  const auto n = static_cast<double>(values.size());
  const double middle = mean(values);
  if (values.size() < 2)
    return {middle, -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  double squares = 0.0;
  for (const double value : values) squares += (value - middle) * (value - middle);
  const double half =
      boost::math::quantile(complement(boost::math::students_t(n - 1.0), 0.025)) * std::sqrt(squares / (n - 1.0) / n);
  return {middle, middle - half, middle + half};
}

Interval centre_of(std::span<const double> values, Centre centre) {
  if (centre == Centre::mean) return mean_interval(values);
  if (centre == Centre::median) return median_interval(values);
  for (const double value : values) {
    if (value != 0.0 && value != 1.0)
      throw BadInput(fmt::format("partial dependence: an outcome is {}; a failure rate needs outcomes of 0 or 1",
                                 std::to_string(value)));
  }
  const auto count = static_cast<std::int64_t>(std::count(values.begin(), values.end(), 1.0));
  return share_interval(count, static_cast<std::int64_t>(values.size()));
}

}  // namespace

std::vector<double> mean_ranks(std::span<const double> values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) order.push_back(i);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return values[a] < values[b]; });
  std::vector<double> ranks(values.size(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t begin = 0; begin < order.size();) {
    std::size_t end = begin;
    while (end < order.size() && values[order[end]] == values[order[begin]]) ++end;
    for (std::size_t k = begin; k < end; ++k) ranks[order[k]] = 0.5 * static_cast<double>(begin + 1 + end);
    begin = end;
  }
  return ranks;
}

Correlation rank_correlation(std::span<const double> x, std::span<const double> y) {
  using Pair = std::pair<double, double>;
  const CompletePairs pairs = complete_pairs(x, y);
  Correlation out;
  if (pairs.size() < kIntervalMin) return out;
  const std::vector<double> a = mean_ranks(column(pairs, &Pair::first)), b = mean_ranks(column(pairs, &Pair::second));
  const double middle = mean(a);  // equal for both variables
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ab += (a[i] - middle) * (b[i] - middle);
    aa += (a[i] - middle) * (a[i] - middle);
    bb += (b[i] - middle) * (b[i] - middle);
  }
  if (aa == 0.0 || bb == 0.0) return out;
  const auto n = static_cast<double>(a.size());
  out.rho = std::clamp(ab / std::sqrt(aa * bb), -1.0, 1.0);
  const double half = kTwoSided95 * std::sqrt((1.0 + 0.5 * out.rho * out.rho) / (n - 3.0));
  out.low = std::tanh(std::atanh(out.rho) - half);
  out.high = std::tanh(std::atanh(out.rho) + half);
  if (a.size() < kStudentMin) return out;
  const double t = std::abs(out.rho) * std::sqrt((n - 2.0) / (1.0 - out.rho * out.rho));
  out.chance = std::isinf(t) ? 0.0 : 2.0 * cdf(complement(boost::math::students_t(n - 2.0), t));
  return out;
}

FirstOrder first_order_index(std::span<const double> x, std::span<const double> y) {
  using Pair = std::pair<double, double>;
  CompletePairs pairs = complete_pairs(x, y);
  FirstOrder out;
  if (pairs.size() < kClassesFrom) return out;
  std::sort(pairs.begin(), pairs.end());
  const std::vector<double> sorted = column(pairs, &Pair::second);
  const double middle = mean(sorted);
  double whole = 0.0;
  for (const double value : sorted) whole += (value - middle) * (value - middle);
  const auto wanted = static_cast<std::size_t>(1.5 * std::cbrt(static_cast<double>(pairs.size())));
  const std::vector<std::size_t> ends = class_ends(pairs, wanted);
  if (!(whole > 0.0) || ends.size() < 2) return out;
  double between = 0.0;
  std::size_t begin = 0;
  for (const std::size_t end : ends) {
    const double away = mean(std::span(sorted).subspan(begin, end - begin)) - middle;
    between += static_cast<double>(end - begin) * away * away;
    begin = end;
  }
  const double explained = between / whole;
  const auto n = static_cast<double>(sorted.size()), classes = static_cast<double>(ends.size());
  out.classes = ends.size();
  if (n <= classes) return {};
  out.index = std::clamp(1.0 - (1.0 - explained) * (n - 1.0) / (n - classes), 0.0, 1.0);
  out.chance = cdf(complement(boost::math::chi_squared(classes - 1.0), (n - 1.0) * explained));
  return out;
}

std::vector<DependenceClass> partial_dependence(std::span<const double> x, std::span<const double> y, Centre centre) {
  CompletePairs pairs = complete_pairs(x, y);
  std::vector<DependenceClass> out;
  if (pairs.size() < kDependenceDrawsMin) return out;
  std::sort(pairs.begin(), pairs.end());
  const std::vector<double> sorted = column(pairs, &std::pair<double, double>::second);
  std::size_t begin = 0;
  for (const std::size_t end : class_ends(pairs, std::min(kDependenceClassesMax, pairs.size() / kDependenceDrawsMin))) {
    out.push_back({pairs[begin].first, pairs[end - 1].first, end - begin,
                   centre_of(std::span(sorted).subspan(begin, end - begin), centre)});
    begin = end;
  }
  return out;
}

}  // namespace tumble::scenarios
