// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

namespace tumble::scenarios {

/// Returns the ranks of the values, starting from 1; equal values get the mean of their ranks, and NaN has the rank
/// NaN.
std::vector<double> mean_ranks(std::span<const double> values);

struct Correlation {
  double rho = 0.0;
  double low = -1.0, high = 1.0;  ///< 95 % interval
  double chance = 1.0;            ///< p-value of rho = 0
};

/// Computes Spearman's rank correlation with its confidence interval (Bonett and Wright, Psychometrika 65:23, 2000;
/// equation (S16) of statistics.md). For fewer than four pairs, or for a constant variable, the confidence
/// interval of the correlation is [-1, 1].
Correlation rank_correlation(std::span<const double> x, std::span<const double> y);

struct FirstOrder {
  double index = 0.0;       ///< explained variance, in [0, 1]
  double chance = 1.0;      ///< p-value of independence
  std::size_t classes = 0;  ///< 0: too few pairs
};

/// Estimates the first-order (Sobol') sensitivity index of y with respect to x from existing data (Plischke, Borgonovo,
/// Smith, EJOR 226:536, 2013). The data are sorted by x and divided into equally large classes. The estimate is based
/// on the variance of the class means of y, equation (S18) of statistics.md. Equation (S19) corrects the
/// first-order index for chance, because class means of y also vary if y is independent of x.
FirstOrder first_order_index(std::span<const double> x, std::span<const double> y);

/// The statistic of a class has a 95 % confidence interval:
/// - `mean`: Student's interval
/// - `median`: interval from order statistics
/// - `share` (fraction of ones): interval of Clopper and Pearson
enum class Centre { mean, median, share };

struct DependenceClass {
  double low = 0.0, high = 0.0;
  std::size_t draws = 0;
  Interval centre{};
};

inline constexpr std::size_t kDependenceClassesMax = 8, kDependenceDrawsMin = 12;

/// Computes the partial dependence of y on x, equations (S22) and (S23) of statistics.md. The data are
/// sorted by x and divided into at most `kDependenceClassesMax` equally large classes, with at least
/// `kDependenceDrawsMin` values each. The result contains a statistic of y for each class. The data must come from
/// simulated runs with independent random numbers.
std::vector<DependenceClass> partial_dependence(std::span<const double> x, std::span<const double> y, Centre centre);

}  // namespace tumble::scenarios
