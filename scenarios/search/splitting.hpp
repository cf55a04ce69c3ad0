// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "scenarios/statistics/statistics.hpp"

/// splitting.hpp estimates the probability of a rare event by adaptive multilevel splitting (Cérou, Guyader, Stochastic
/// Analysis and Applications 25:417, 2007; docs/maths/statistics.md, "Probability of a rare failure").
namespace tumble::scenarios {

/// SplittingPoint is one random run: a standard normal number for each random parameter, and a seed for each random
/// stream (noise of a sensor, terrain).
struct SplittingPoint {
  std::vector<double> normals;
  std::vector<std::uint64_t> seeds;

  /// Returns a single number that is computed from all seeds, and that changes if any seed changes.
  std::uint64_t seed() const;
};

/// A ScorePoints function simulates draws (random runs) and returns one score per draw. If a ScorePoints function
/// returns fewer scores than draws, the search stops and ignores these scores.
using ScorePoints = std::function<std::vector<double>(std::span<const SplittingPoint>)>;

/// A Move function changes the standard normal numbers of a random run at random, by a step size in (0, 1]. The changed
/// numbers must again have a standard normal distribution.
using Move = std::function<std::vector<double>(std::span<const double> normals, double step,
                                               const std::function<double()>& normal)>;

/// Returns x √(1 − step²) + step ξ, for the normal numbers x and new standard normal numbers ξ. The formula is a
/// preconditioned Crank-Nicolson step, equation (S27) of statistics.md.
std::vector<double> crank_nicolson(std::span<const double> normals, double step, const std::function<double()>& normal);

struct SplittingOptions {
  std::size_t numbers = 0;      ///< number of random parameters
  std::size_t streams = 1;      ///< number of random streams, at least 1
  std::size_t population = 50;  ///< number of draws that advance together, at least 4
  std::size_t budget = 1000;    ///< largest number of scored draws, at least `population`
  double bound = 0.0;           ///< a draw fails if its score exceeds the bound; finite
  std::uint64_t seed = 1;       ///< seed of the search
  Move move = crank_nicolson;
};

struct ScoredPoint {
  SplittingPoint point;
  double score = 0.0;
  std::size_t family = 0;  ///< index of the initial draw that was copied and changed to this draw
};

/// SplittingLevel describes the population (the current draws) after one step of the search. A step replaces each draw
/// whose score is at most `score` by a copy of another draw.
struct SplittingLevel {
  double score = 0.0;        ///< all draws after the step exceed this score
  Interval probability{};    ///< probability that a random draw exceeds the score
  std::size_t runs = 0;      ///< number of scored draws so far
  std::size_t families = 0;  ///< number of initial draws with copies after the step
  std::size_t moves = 0;     ///< number of moves of each copied draw
  double accepted = 0.0;     ///< fraction of accepted moves
};

struct SplittingResult {
  Interval probability{0.0, 0.0, 1.0};  ///< probability of a failure with its 95 % interval
  bool complete = false;                ///< true: three quarters of the draws reached the bound within the budget
  bool stopped = false;                 ///< `ScorePoints` stopped the search
  std::vector<ScoredPoint> draws;       ///< all scored draws, in order
  std::vector<std::size_t> members;     ///< indices in `draws` of the draws after the last step
  std::vector<SplittingLevel> levels;
};

/// Estimates the probability that the score of a random draw exceeds the bound.
///
/// A draw is a random run. In each step, the search replaces the quarter of the draws with the lowest scores by copies
/// of other draws. Several Metropolis moves change each copy. A Metropolis move is accepted if the changed draw has a
/// higher score than all removed draws. Half of the Metropolis moves also replace the seed of one random stream. The
/// estimated probability is the product of the fractions of draws that remain in each step, and of the final fraction
/// above the bound. The search ends when at least three quarters of the current draws have scores above the bound.
///
/// The step size of the Metropolis moves increases if more than 40 % of the moves are accepted. The number of moves per
/// copy depends on the acceptance rate of moves with a new seed. The number is chosen such that at least 90 % of the
/// copies would get a new seed if every move used a new seed. The 95 % interval takes into account that copies of one
/// initial draw depend on each other. Equal options give equal results for deterministic scores. The scores of draws
/// may be infinite, but not NaN. Throws BadInput for invalid options or NaN scores.
SplittingResult split(const SplittingOptions& options, const ScorePoints& score);

/// SplittingEstimate accumulates an estimate of a small probability over the steps of adaptive multilevel splitting.
/// SplittingEstimate also accumulates the variance of the logarithm of the estimate, equations (S25) to (S30) of
/// statistics.md.
class SplittingEstimate {
 public:
  explicit SplittingEstimate(std::size_t population) : population_(population) {}

  /// Adds a step of the search that removed `removed` draws (random runs). For each remaining draw, `copies` contains
  /// the number of its copies plus 1.
  void advance(std::size_t removed, std::span<const std::size_t> copies);

  /// Returns the probability that the score of a random run exceeds the current level, with the 95 % confidence
  /// interval.
  Interval of_level(std::span<const std::size_t> families) const;

  /// Returns the probability of a failure with the 95 % confidence interval. `families` contains ScoredPoint::family
  /// (the index of the initial draw) of all draws after the last step. `failing` contains ScoredPoint::family of the
  /// failing draws.
  Interval of_failure(std::span<const std::size_t> families, std::span<const std::size_t> failing) const;

 private:
  Interval interval(std::span<const std::size_t> families, double risk) const;

  std::size_t population_;
  double log_probability_ = 0.0;
  double poisson_variance_ = 0.0;  ///< variance of the logarithm if all members are independent
  double log_correction_ = 0.0;    ///< factor of the fraction of unrelated pairs, equation (S29)
};

}  // namespace tumble::scenarios
