// SPDX-License-Identifier: BSD-3-Clause
// Prints how often the interval of a search for rare failures contains the true probability, and its cost relative to
// independent draws (docs/maths/statistics.md, "Probability of a rare failure"). The score is a standard normal number.
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <span>
#include <vector>

#include "scenarios/search/splitting.hpp"
#include "sim/random/stream.hpp"

namespace {

using tumble::scenarios::Interval;
using tumble::scenarios::SplittingPoint;

constexpr int kRepetitions = 200;

/// Returns a standard normal number, of which the seeds together contribute the fraction `noise` of the variance.
double score(const SplittingPoint& point, double noise) {
  const double sum = std::accumulate(point.normals.begin(), point.normals.end(), 0.0);
  const double drawn = std::sqrt((1.0 - noise) / static_cast<double>(point.normals.size())) * sum;
  double random = 0.0;
  for (const std::uint64_t seed : point.seeds) random += tumble::sim::Stream(seed, "noise").normal();
  return drawn + std::sqrt(noise / static_cast<double>(point.seeds.size())) * random;
}

void measure(double probability, double noise, std::size_t streams) {
  tumble::scenarios::SplittingOptions options;
  options.numbers = 10;
  options.streams = streams;
  options.budget = 10000000;
  options.bound = quantile(complement(boost::math::normal(), probability));
  double covered = 0.0, runs = 0.0, mean = 0.0, squares = 0.0;
  for (int i = 0; i < kRepetitions; ++i) {
    options.seed = static_cast<std::uint64_t>(i + 1);
    const auto found = split(options, [&](std::span<const SplittingPoint> points) {
      std::vector<double> scores;
      for (const SplittingPoint& point : points) scores.push_back(score(point, noise));
      return scores;
    });
    const Interval& p = found.probability;
    covered += p.low <= probability && probability <= p.high ? 1.0 / kRepetitions : 0.0;
    runs += static_cast<double>(found.draws.size()) / kRepetitions;
    mean += p.value / probability / kRepetitions;
    squares += std::pow(p.value / probability, 2) / kRepetitions;
  }
  const double plain = (1.0 - probability) / probability / (squares - mean * mean);
  std::printf("%11g %5.1f %7zu %9.1f %% %8.0f %13.2f %22.2f\n", probability, noise, streams, 100.0 * covered, runs,
              mean, plain / runs);
  std::fflush(stdout);
}

}  // namespace

int main() {
  std::puts("probability noise streams    covered     runs estimate/true plain draws/run");
  for (const double probability : {1e-2, 1e-3, 1e-4, 1e-6}) {
    for (const double noise : {0.0, 0.3, 0.5, 0.7}) {
      for (const std::size_t streams : {1, 4}) measure(probability, noise, streams);
    }
  }
}
