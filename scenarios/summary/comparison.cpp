// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "scenarios/errors.hpp"
#include "scenarios/not_finite.hpp"
#include "scenarios/statistics/bootstrap.hpp"
#include "scenarios/statistics/paired.hpp"
#include "scenarios/statistics/sample_size.hpp"
#include "scenarios/summary/selection.hpp"

namespace tumble::scenarios {

namespace {

struct ValuePair {
  double own, other;
};

void require_share(const char* name, double value) {
  if (!(value > 0.0 && value < 1.0))
    throw BadInput(
        fmt::format("the {} of the comparison is {}; it must be within (0, 1)", name, std::to_string(value)));
}

void require_sound(const Summary& summary, const ComparisonOptions& options) {
  require_share("risk", options.risk);
  require_share("power", options.power);
  if (options.margin && !(options.margin->value >= 0.0 && std::isfinite(options.margin->value)))
    throw BadInput(fmt::format("the margin of the comparison is {}; it must be finite and at least 0",
                               std::to_string(options.margin->value)));
  std::vector<std::string> methods = options.methods;
  if (!options.against.empty()) methods.push_back(options.against);
  require_held(summary, methods, options.metrics);
}

std::vector<ValuePair> pairs_of(const MetricSummary& own, const MetricSummary& other, double worst) {
  const std::vector<RankedValue> first = ranked_values(own, worst), second = ranked_values(other, worst);
  std::vector<ValuePair> pairs;
  auto at = second.begin();
  for (const RankedValue& each : first) {
    while (at != second.end() && at->seed < each.seed) ++at;
    if (at != second.end() && at->seed == each.seed) pairs.push_back({each.value, at->value});
  }
  return pairs;
}

double less(double own, double other) {
  return own == other ? 0.0 : own - other;
}

std::vector<double> beyond(const Margin& margin, const MetricInfo& info, const std::vector<ValuePair>& pairs) {
  std::vector<double> out;
  for (const ValuePair& pair : pairs) out.push_back(worse_by(info, pair.own, pair.other, margin));
  return out;
}

class Comparing {
 public:
  explicit Comparing(const ComparisonOptions& options) : options_(options) {}

  void add(const Section& section) {
    const MethodSummary* other = against(section);
    if (other == nullptr) return;
    for (const MethodSummary& method : section.methods) {
      if (&method != other && is_selected(options_.methods, section.kind, method)) add(section, method, *other);
    }
  }

  Comparison finish() {
    correct();
    return std::move(out_);
  }

 private:
  const MethodSummary* against(const Section& section) const {
    if (options_.against.empty()) return section.find(section.baseline);
    const auto found = std::find_if(section.methods.begin(), section.methods.end(), [&](const MethodSummary& method) {
      return is_named(options_.against, section.kind, method.method);
    });
    return found == section.methods.end() ? nullptr : &*found;
  }

  void add(const Section& section, const MethodSummary& method, const MethodSummary& other) {
    const Contest contest{section.scenario, section.kind, method.method, other.method};
    add_failures(contest, "not ok", method.seeds, method.not_ok_seeds, other.seeds, other.not_ok_seeds);
    for (const std::string& name : options_.metrics.empty() ? headline_metrics(section.kind) : options_.metrics) {
      const MetricSummary *own = method.find(name), *theirs = other.find(name);
      if (own == nullptr || theirs == nullptr) continue;
      if (metric_info(name).unit == Unit::verdict) {
        add_verdict(contest, name, *own, *theirs);
      } else {
        add_metric(contest, metric_info(name), name, *own, *theirs);
      }
    }
  }

  void add_metric(const Contest& contest, const MetricInfo& info, const std::string& name, const MetricSummary& own,
                  const MetricSummary& other) {
    const std::vector<ValuePair> pairs = pairs_of(own, other, worst_value(info));
    if (pairs.empty()) return;
    MetricComparison row{contest, name};
    row.pairs = static_cast<std::int64_t>(pairs.size());
    row.median = median_of(pairs, &ValuePair::own);
    row.against_median = median_of(pairs, &ValuePair::other);
    std::vector<double> raw, worse_by;
    for (const ValuePair& pair : pairs) {
      worse_by.push_back(less(how_bad(info, pair.own), how_bad(info, pair.other)));
      raw.push_back(info.sense == Sense::two_sided ? worse_by.back() : less(pair.own, pair.other));
    }
    row.difference = bootstrap(raw.size()).interval(raw);
    const bool contested = info.sense != Sense::none;
    row.better = std::count_if(worse_by.begin(), worse_by.end(), [](double d) { return d < 0.0; });
    row.worse = std::count_if(worse_by.begin(), worse_by.end(), [](double d) { return d > 0.0; });
    row.sign_chance = sign_test(contested ? worse_by : raw);
    row.rank_chance = signed_rank_test(contested ? worse_by : raw);
    row.not_inferior_chance = kNaN;
    if (options_.margin && contested) {
      std::vector<double> relieved = beyond(*options_.margin, info, pairs);
      for (double& each : relieved) each = -each;
      row.not_inferior_chance = signed_rank_chance(relieved);
    }
    tends_.push_back(!contested ? 0.0 : signed_rank_chance(worse_by) < 0.5 ? 1.0 : -1.0);
    differences_.push_back(std::move(contested ? worse_by : raw));
    out_.metrics.push_back(std::move(row));
  }

  void add_failures(const Contest& contest, const std::string& what, const std::vector<std::uint64_t>& seeds,
                    const std::vector<std::uint64_t>& failed, const std::vector<std::uint64_t>& other_seeds,
                    const std::vector<std::uint64_t>& other_failed) {
    FailureComparison row{contest, what};
    std::int64_t own = 0, theirs = 0;
    for (const std::uint64_t seed : seeds) {
      if (!std::binary_search(other_seeds.begin(), other_seeds.end(), seed)) continue;
      const bool first = std::binary_search(failed.begin(), failed.end(), seed);
      const bool second = std::binary_search(other_failed.begin(), other_failed.end(), seed);
      ++row.pairs;
      own += first;
      theirs += second;
      row.only_method += first && !second;
      row.only_against += second && !first;
    }
    if (row.pairs == 0) return;
    row.share = share_interval(own, row.pairs);
    row.against_share = share_interval(theirs, row.pairs);
    row.chance = paired_failures_test(row.only_method, row.only_against);
    out_.failures.push_back(std::move(row));
  }

  void add_verdict(const Contest& contest, const std::string& name, const MetricSummary& own,
                   const MetricSummary& other) {
    const auto split = [](const MetricSummary& metric) {
      std::pair<std::vector<std::uint64_t>, std::vector<std::uint64_t>> out{metric.seeds, metric.failed};
      for (std::size_t i = 0; i < metric.seeds.size(); ++i) {
        if (metric.values[i] != 0.0) out.second.push_back(metric.seeds[i]);
      }
      out.first.insert(out.first.end(), metric.failed.begin(), metric.failed.end());
      std::sort(out.first.begin(), out.first.end());
      std::sort(out.second.begin(), out.second.end());
      return out;
    };
    const auto [seeds, failed] = split(own);
    const auto [other_seeds, other_failed] = split(other);
    add_failures(contest, name, seeds, failed, other_seeds, other_failed);
  }

  const MedianBootstrap& bootstrap(std::size_t size) {
    auto found = bootstraps_.find(size);
    if (found == bootstraps_.end()) found = bootstraps_.emplace(size, MedianBootstrap(size)).first;
    return found->second;
  }

  /// The number of needed runs is computed for the total risk divided by the number of tests, because Holm's correction
  /// compares the smallest p-value with this risk.
  Plan plan(std::size_t tests) const {
    return {options_.risk / static_cast<double>(std::max<std::size_t>(tests, 1)), options_.power};
  }

  void correct() {
    std::vector<double> chances, margins, failures;
    for (std::size_t i = 0; i < out_.metrics.size(); ++i) {
      chances.push_back(tends_[i] == 0.0 ? kNaN : out_.metrics[i].rank_chance);
      margins.push_back(out_.metrics[i].not_inferior_chance);
    }
    for (const FailureComparison& row : out_.failures) failures.push_back(row.chance);
    const auto tests = static_cast<std::size_t>(
        std::count_if(chances.begin(), chances.end(), [](double chance) { return !std::isnan(chance); }));
    chances = holm(chances);
    margins = holm(margins);
    failures = holm(failures);
    for (std::size_t i = 0; i < out_.metrics.size(); ++i) {
      MetricComparison& row = out_.metrics[i];
      row.corrected = chances[i];
      row.not_inferior_corrected = margins[i];
      row.not_inferior = row.not_inferior_corrected < options_.risk;
      if (row.corrected < options_.risk) row.finding = tends_[i] > 0.0 ? Finding::worse : Finding::better;
      row.pairs_needed = pairs_for_signed_rank(differences_[i], plan(tests));
    }
    for (std::size_t i = 0; i < out_.failures.size(); ++i) {
      FailureComparison& row = out_.failures[i];
      row.corrected = failures[i];
      if (row.corrected < options_.risk)
        row.finding = row.only_method > row.only_against ? Finding::worse : Finding::better;
      row.pairs_needed = pairs_for_failures(row.only_method, row.only_against, row.pairs, plan(out_.failures.size()));
    }
  }

  const ComparisonOptions& options_;
  Comparison out_;
  std::vector<std::vector<double>> differences_;  ///< one list per row of the metric table
  std::vector<double> tends_;                     ///< 1: worse, -1: better, 0: unranked
  std::map<std::size_t, MedianBootstrap> bootstraps_;
};

}  // namespace

double worse_by(const MetricInfo& info, double own, double other, const Margin& allowed) {
  const double bad = how_bad(info, own), other_bad = how_bad(info, other);
  if (std::isinf(bad) || std::isinf(other_bad)) return less(bad, other_bad);
  return bad - other_bad - allowed.value * (allowed.relative ? std::abs(other_bad) : 1.0);
}

const char* to_string(Finding finding) {
  switch (finding) {
    case Finding::better:
      return "better";
    case Finding::worse:
      return "worse";
    case Finding::undecided:
      break;
  }
  return "undecided";
}

Comparison compare(const Summary& summary, const ComparisonOptions& options) {
  require_sound(summary, options);
  Comparing comparing(options);
  for (const Section& section : summary.sections) comparing.add(section);
  return comparing.finish();
}

}  // namespace tumble::scenarios
