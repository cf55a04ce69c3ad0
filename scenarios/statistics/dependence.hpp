// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

/// The functions in dependence.hpp compute the statistical dependence between two numbers over a set of simulated runs.
namespace tumble::scenarios {

/// Returns the ranks of the values, starting from 1. Equal values get the mean of their ranks. Infinite values are
/// ranked like finite values. The rank of NaN is NaN.
std::vector<double> mean_ranks(std::span<const double> values);

struct Correlation {
  double rho = 0.0;
  double low = -1.0, high = 1.0;  ///< 95 % interval
  double chance = 1.0;            ///< p-value of the hypothesis rho = 0; 1 below ten pairs
};

/// Computes Spearman's rank correlation with its confidence interval and p-value. The confidence interval is that of
/// Bonett and Wright (Psychometrika 65:23, 2000), statistics.md (S16). The p-value follows from Student's distribution,
/// equation (S17) of statistics.md. Pairs with NaN are ignored. For fewer than four pairs or a constant variable, the
/// interval is [-1, 1]. Throws BadInput if the lengths differ.
Correlation rank_correlation(std::span<const double> x, std::span<const double> y);

struct FirstOrder {
  double index = 0.0;       ///< share of the variance of y that x alone explains, [0, 1]
  double chance = 1.0;      ///< p-value of the hypothesis that y does not depend on x
  std::size_t classes = 0;  ///< 0: too few pairs
};

/// Estimates the first-order (Sobol') index of y with respect to x from existing data, in which y may depend on further
/// numbers. The index is the variance of class means over equally large classes of x, minus a correction (equation
/// (S18) of statistics.md). The correction is the expected variance of the class means without dependence, equation
/// (S19). The estimator is that of Plischke, Borgonovo, Smith, EJOR 226:536, 2013. If x takes few values, each value is
/// a class. If y contains ranks, the p-value of equation (S20) is the p-value of the Kruskal-Wallis test.
///
/// All values of y must be finite or NaN; pairs with NaN are ignored. The estimate of the index needs at least 24
/// pairs. Throws BadInput if the lengths differ.
FirstOrder first_order_index(std::span<const double> x, std::span<const double> y);

/// Centre selects the statistic of a class, which has a 95 % confidence interval. The mean of finite values has
/// Student's interval. The median has an interval from order statistics, which also rank infinite values. The fraction
/// of ones has the interval of Clopper and Pearson.
enum class Centre { mean, median, share };

/// DependenceClass contains the simulated runs whose x is from `low` to `high`, both included.
struct DependenceClass {
  double low = 0.0, high = 0.0;
  std::size_t draws = 0;
  Interval centre{};
};

inline constexpr std::size_t kDependenceClassesMax = 8, kDependenceDrawsMin = 12;

/// Computes the partial dependence of y on x: a statistic of y per class of x, equations (S22) and (S23) of
/// statistics.md. The data must come from simulated runs with independent random numbers. The classes of x are equally
/// large: at most `kDependenceClassesMax` classes with at least `kDependenceDrawsMin` simulated runs each. Runs with
/// equal values of x are in one class. If x takes few values, each value is a class.
///
/// Pairs with NaN are ignored. For fewer than `kDependenceDrawsMin` pairs, the list is empty. Throws BadInput if the
/// lengths differ, or if Centre::share is requested and a value is neither 0 nor 1.
std::vector<DependenceClass> partial_dependence(std::span<const double> x, std::span<const double> y, Centre centre);

}  // namespace tumble::scenarios
