// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

/// What one number has to do with another over the same draws.
namespace tumble::scenarios {

/// Ranks from 1, ties share their mean; infinite values rank as what they are, of NaN the rank is NaN.
std::vector<double> mean_ranks(std::span<const double> values);

struct Correlation {
  double rho = 0.0;
  double low = -1.0, high = 1.0;  ///< 95 %
  double chance = 1.0;            ///< of a rho as far from zero, were there none; 1 below ten pairs
};

/// Spearman's rank correlation with the interval of Bonett and Wright (Psychometrika 65:23, 2000), statistics.md (S12),
/// and the chance by Student's distribution, (S13). Pairs with NaN are left out; of fewer than four, or where one of
/// the two does not vary, nothing is known. Throws BadInput on two lengths.
Correlation rank_correlation(std::span<const double> x, std::span<const double> y);

struct FirstOrder {
  double index = 0.0;       ///< share of the variance of y that x alone explains, [0, 1]
  double chance = 1.0;      ///< of one as large, were y the same for all x
  std::size_t classes = 0;  ///< 0: too little to say anything
};

/// First-order index (Sobol') of y by x from given data, whatever y depends on besides: variance of the means over
/// classes of x with as many draws each (Plischke, Borgonovo, Smith, EJOR 226:536, 2013), statistics.md (S14), less
/// what chance alone would give, (S15). Where x takes few values each is a class. Of ranks of y the chance, (S16), is
/// the Kruskal-Wallis test. Finite y; pairs with NaN are left out. At least 24 pairs. Throws BadInput on two lengths.
FirstOrder first_order_index(std::span<const double> x, std::span<const double> y);

/// What stands for the values of a class, with its 95 % interval: the mean (Student, of finite values), the median
/// (order statistics, infinite values rank as what they are) or, of zeros and ones, the share (Clopper and Pearson).
enum class Centre { mean, median, share };

/// The draws whose x lies from `low` to `high`, both among them.
struct DependenceClass {
  double low = 0.0, high = 0.0;
  std::size_t draws = 0;
  Interval centre{};
};

inline constexpr std::size_t kDependenceClassesMax = 8, kDependenceDrawsMin = 12;

/// Partial dependence of y on x from given data, statistics.md (S22), (S23): where the numbers of a draw are
/// independent of each other it is what is seen of y where x is. Classes of x with as many draws each, at most
/// `kDependenceClassesMax`, of `kDependenceDrawsMin` draws at least; what has one x is never parted, and where x takes
/// few values each is a class. Pairs with NaN are left out; empty below `kDependenceDrawsMin` pairs. Throws BadInput on
/// two lengths, and on a share of other values than 0 and 1.
std::vector<DependenceClass> partial_dependence(std::span<const double> x, std::span<const double> y, Centre centre);

}  // namespace tumble::scenarios
