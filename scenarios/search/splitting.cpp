// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/search/splitting.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/math/special_functions/beta.hpp>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "scenarios/errors.hpp"
#include "sim/random/stream.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kPopulationMin = 4;
constexpr std::size_t kRemovedPart = 4;  // each step removes a quarter of the draws
constexpr std::size_t kMovesMin = 2, kMovesFirst = 5;
constexpr double kNotMoved = 0.1;  // fraction of the copies that may keep their seed
constexpr double kStepMin = 0.05, kStepMax = 0.95, kStepFirst = 0.7, kAcceptedTarget = 0.4;

void require_sound(const SplittingOptions& options) {
  if (options.population < kPopulationMin)
    throw BadInput(fmt::format("the population is {}; it must be at least {}", options.population, kPopulationMin));
  if (options.budget < options.population)
    throw BadInput(fmt::format("the budget is {} simulated runs; it must be at least the population, {}",
                               options.budget, options.population));
  if (options.streams == 0) throw BadInput("the number of random streams is 0; it must be at least 1");
  if (!std::isfinite(options.bound))
    throw BadInput(fmt::format("the bound of the score is {}; it must be finite", std::to_string(options.bound)));
}

struct MoveRate {
  std::size_t moves = kMovesFirst;
  double step = kStepFirst;
  double accepted = 0.0;

  void adapt(std::size_t proposed, std::size_t taken, std::size_t reseeded, std::size_t taken_reseeded) {
    accepted = static_cast<double>(taken) / static_cast<double>(proposed);
    step = std::clamp(step * std::exp(accepted - kAcceptedTarget), kStepMin, kStepMax);
    const double new_seed = (static_cast<double>(taken_reseeded) + 0.5) / (static_cast<double>(reseeded) + 1.0);
    const double wanted = std::log(kNotMoved) / std::log(1.0 - std::min(new_seed, 0.9));
    moves = std::max(kMovesMin, static_cast<std::size_t>(std::ceil(wanted)));
  }
};

class Splitting {
 public:
  Splitting(const SplittingOptions& options, const ScorePoints& score)
      : options_(options), score_(score), stream_(options.seed, "search"), estimate_(options.population) {}

  SplittingResult run() {
    if (begin()) {
      while (!is_at_bound() && advance()) {
      }
    }
    conclude();
    return std::move(result_);
  }

 private:
  std::vector<ScoredPoint>& draws() { return result_.draws; }
  double score_of(std::size_t member) const { return result_.draws[result_.members[member]].score; }

  bool add(std::vector<ScoredPoint> fresh) {
    std::vector<SplittingPoint> points;
    for (const ScoredPoint& each : fresh) points.push_back(each.point);
    const std::vector<double> scores = score_(points);
    if (scores.size() < fresh.size()) {
      result_.stopped = true;
      return false;
    }
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      if (std::isnan(scores[i]))
        throw BadInput(fmt::format("the score of simulated run {} is not a number", draws().size()));
      fresh[i].score = scores[i];
      draws().push_back(std::move(fresh[i]));
    }
    return true;
  }

  bool begin() {
    std::vector<ScoredPoint> fresh(options_.population);
    for (std::size_t i = 0; i < fresh.size(); ++i) {
      for (std::size_t k = 0; k < options_.numbers; ++k) fresh[i].point.normals.push_back(stream_.normal());
      for (std::size_t k = 0; k < options_.streams; ++k) fresh[i].point.seeds.push_back(stream_.bits());
      fresh[i].family = i;
    }
    if (!add(std::move(fresh))) return false;
    result_.members.resize(options_.population);
    std::iota(result_.members.begin(), result_.members.end(), std::size_t{0});
    return true;
  }

  /// Returns true if at least three quarters of the current draws (random runs) have scores above the failure bound.
  bool is_at_bound() const { return failing().size() + removed_at_once() >= options_.population; }
  std::size_t removed_at_once() const { return std::max<std::size_t>(1, options_.population / kRemovedPart); }

  std::vector<std::size_t> failing() const {
    std::vector<std::size_t> out;
    for (const std::size_t member : result_.members) {
      if (result_.draws[member].score > options_.bound) out.push_back(member);
    }
    return out;
  }

  bool advance() {
    std::vector<double> scores;
    for (std::size_t i = 0; i < result_.members.size(); ++i) scores.push_back(score_of(i));
    const auto last = scores.begin() + static_cast<std::ptrdiff_t>(removed_at_once() - 1);
    std::nth_element(scores.begin(), last, scores.end());
    const double level = *last;
    std::vector<std::size_t> lowest, remaining;
    for (std::size_t i = 0; i < result_.members.size(); ++i) (score_of(i) <= level ? lowest : remaining).push_back(i);
    if (remaining.empty() || draws().size() + lowest.size() * rate_.moves > options_.budget) return false;
    const std::vector<std::size_t> before = result_.members;
    const SplittingEstimate estimate = estimate_;
    copy(lowest, remaining);
    if (!move(lowest, level)) {
      result_.members = before;
      estimate_ = estimate;
      return false;
    }
    return true;
  }

  /// Replaces the draws (random runs) with the lowest scores by copies of the remaining draws. Each remaining draw is
  /// copied once before any remaining draw is copied twice.
  void copy(const std::vector<std::size_t>& lowest, std::vector<std::size_t> remaining) {
    std::vector<std::size_t> copies(remaining.size(), 1);
    for (std::size_t i = 0; i < lowest.size(); ++i) {
      const std::size_t at = i % remaining.size();
      if (at == 0) shuffle(remaining);
      ++copies[at];
      result_.members[lowest[i]] = result_.members[remaining[at]];
    }
    estimate_.advance(lowest.size(), copies);
  }

  void shuffle(std::vector<std::size_t>& values) {
    for (std::size_t i = values.size(); i > 1; --i) std::swap(values[i - 1], values[stream_.bits() % i]);
  }

  bool move(const std::vector<std::size_t>& moved, double level) {
    std::size_t taken = 0, reseeded = 0, taken_reseeded = 0;
    for (std::size_t k = 0; k < rate_.moves; ++k) {
      const std::size_t first = draws().size();
      std::vector<ScoredPoint> proposals;
      for (const std::size_t member : moved) proposals.push_back(proposal(draws()[result_.members[member]]));
      if (!add(std::move(proposals))) return false;
      for (std::size_t i = 0; i < moved.size(); ++i) {
        std::size_t& member = result_.members[moved[i]];
        const bool is_new = draws()[first + i].point.seeds != draws()[member].point.seeds;
        const bool accepted = draws()[first + i].score > level;
        if (accepted) member = first + i;
        taken += accepted;
        reseeded += is_new;
        taken_reseeded += accepted && is_new;
      }
    }
    SplittingLevel reached;
    reached.score = level;
    reached.moves = rate_.moves;
    rate_.adapt(moved.size() * rate_.moves, taken, reseeded, taken_reseeded);
    reached.accepted = rate_.accepted;
    reached.runs = draws().size();
    const std::vector<std::size_t> families = families_of(result_.members);
    reached.families = std::set<std::size_t>(families.begin(), families.end()).size();
    reached.probability = estimate_.of_level(families);
    result_.levels.push_back(reached);
    return true;
  }

  ScoredPoint proposal(const ScoredPoint& from) {
    ScoredPoint out = from;
    out.point.normals = options_.move(from.point.normals, rate_.step, [&] { return stream_.normal(); });
    if (stream_.uniform() < 0.5) {
      const std::size_t stream = options_.streams == 1 ? 0 : stream_.bits() % options_.streams;
      out.point.seeds[stream] = stream_.bits();
    }
    return out;
  }

  std::vector<std::size_t> families_of(const std::vector<std::size_t>& members) const {
    std::vector<std::size_t> out;
    for (const std::size_t member : members) out.push_back(result_.draws[member].family);
    return out;
  }

  void conclude() {
    if (result_.members.empty()) return;
    result_.complete = is_at_bound();
    result_.probability = estimate_.of_failure(families_of(result_.members), families_of(failing()));
  }

  const SplittingOptions& options_;
  const ScorePoints& score_;
  sim::Stream stream_;
  SplittingEstimate estimate_;
  MoveRate rate_;
  SplittingResult result_;
};

}  // namespace

std::uint64_t SplittingPoint::seed() const {
  return std::accumulate(seeds.begin(), seeds.end(), std::uint64_t{0}, std::bit_xor<>());
}

std::vector<double> crank_nicolson(std::span<const double> normals, double step,
                                   const std::function<double()>& normal) {
  const double kept = std::sqrt(1.0 - step * step);
  std::vector<double> out;
  for (const double each : normals) out.push_back(kept * each + step * normal());
  return out;
}

SplittingResult split(const SplittingOptions& options, const ScorePoints& score) {
  require_sound(options);
  return Splitting(options, score).run();
}

namespace {

constexpr double kRisk = 0.05;

std::map<std::size_t, double> sizes_of(std::span<const std::size_t> families) {
  std::map<std::size_t, double> sizes;
  for (const std::size_t family : families) ++sizes[family];
  return sizes;
}

/// Returns the number of ordered pairs of draws (random runs) that are copies of different initial draws.
double unrelated_pairs(std::span<const std::size_t> families) {
  const auto n = static_cast<double>(families.size());
  double related = 0.0;
  for (const auto& [family, size] : sizes_of(families)) related += size * size;
  return n * n - related;
}

}  // namespace

void SplittingEstimate::advance(std::size_t removed, std::span<const std::size_t> copies) {
  const auto n = static_cast<double>(population_), left = n - static_cast<double>(removed);
  for (std::size_t i = 0; i < removed; ++i) {
    const double alive = n - static_cast<double>(i);
    poisson_variance_ += 1.0 / (alive * alive);
  }
  log_probability_ += std::log(left / n);
  double siblings = 0.0;
  for (const std::size_t count : copies) siblings += static_cast<double>(count * count);
  // If only one draw (random run) remains, all later draws are copies of this draw, and interval() returns the limits 0
  // and 1.
  if (left > 1.0) log_correction_ += std::log((left - 1.0) * n * n / (left * (n * n - siblings)));
}

/// Computes the confidence interval of a small probability by equation (S30) of statistics.md. The estimated
/// probability has a log-normal distribution, whose median is below its mean. The factor exp(variance / 2) corrects the
/// upper limit of the confidence interval for the difference between median and mean.
Interval SplittingEstimate::interval(std::span<const std::size_t> members, double risk) const {
  const auto n = static_cast<double>(population_), own = static_cast<double>(members.size());
  const double share = own / n, log_value = log_probability_ + std::log(share);
  const double unrelated = unrelated_pairs(members) / (n * (n - 1.0) * share * share);
  if (unrelated == 0.0) return {std::exp(log_value), 0.0, 1.0};
  const double variance = std::max(poisson_variance_ + (1.0 - share) / own, -log_correction_ - std::log(unrelated));
  const double reach = normal_quantile(1.0 - 0.5 * risk) * std::sqrt(variance);
  return {std::exp(log_value), std::exp(log_value - reach),
          std::min(1.0, std::exp(log_value + 0.5 * variance + reach))};
}

Interval SplittingEstimate::of_level(std::span<const std::size_t> families) const {
  if (log_probability_ == 0.0) return {1.0, 1.0, 1.0};
  return interval(families, kRisk);
}

Interval SplittingEstimate::of_failure(std::span<const std::size_t> families,
                                       std::span<const std::size_t> failing) const {
  if (log_probability_ == 0.0)
    return share_interval(static_cast<std::int64_t>(failing.size()), static_cast<std::int64_t>(population_));
  if (2 * failing.size() >= population_) return interval(failing, kRisk);
  // If fewer than half of the current draws (random runs) fail, the estimated probability is not log-normal. The
  // confidence interval of the probability is then the product of two confidence intervals with half of the error risk
  // each:
  // - the probability that a random run exceeds the last level
  // - the fraction of the current draws that fail, where all copies of one initial draw count as one draw
  const Interval level = interval(families, 0.5 * kRisk);
  const auto n = static_cast<double>(sizes_of(families).size());
  const double share = static_cast<double>(failing.size()) / static_cast<double>(population_), count = share * n;
  const double low = count > 0.0 ? boost::math::ibeta_inv(count, n - count + 1.0, 0.25 * kRisk) : 0.0;
  const double high = boost::math::ibeta_inv(count + 1.0, n - count, 1.0 - 0.25 * kRisk);
  return {level.value * share, level.low * low, std::min(1.0, level.high * high)};
}

}  // namespace tumble::scenarios
