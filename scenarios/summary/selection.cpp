// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/selection.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

void require_named(const std::string& what, std::span<const std::string> names, const std::set<std::string>& known) {
  for (const std::string& name : names) {
    if (known.contains(name)) continue;
    const std::string near = sim::did_you_mean(name, std::vector<std::string>(known.begin(), known.end()));
    throw BadInput("the results contain no " + what + " '" + name + "'" + (near.empty() ? "" : "; " + near));
  }
}

using Seeds = std::vector<std::uint64_t>;  // ascending

Seeds every_nth(const Seeds& seeds, std::size_t most) {
  Seeds out;
  const std::size_t step = (seeds.size() + most - 1) / std::max<std::size_t>(most, 1);
  for (std::size_t place = 0; place < seeds.size(); place += std::max<std::size_t>(step, 1))
    out.push_back(seeds[place]);
  return out;
}

template <typename Visit>
void for_kept(const Seeds& kept, const Seeds& seeds, Visit visit) {
  auto at = kept.begin();
  for (std::size_t i = 0; i < seeds.size(); ++i) {
    while (at != kept.end() && *at < seeds[i]) ++at;
    if (at == kept.end()) return;
    if (*at == seeds[i]) visit(i);
  }
}

Seeds of_kept(const Seeds& kept, const Seeds& seeds) {
  Seeds out;
  for_kept(kept, seeds, [&](std::size_t i) { out.push_back(seeds[i]); });
  return out;
}

MethodSummary of_kept(const Seeds& kept, const MethodSummary& method) {
  MethodSummary out{method.method,
                    method.needs_truth,
                    method.outcomes,
                    method.not_ok,
                    method.not_ok_share,
                    of_kept(kept, method.seeds),
                    of_kept(kept, method.not_ok_seeds),
                    {},
                    method.what};
  for (const auto& entry : method.metrics) {
    const MetricSummary& metric = entry.second;  // no structured binding: Clang 14 cannot capture one
    MetricSummary& own = out.metrics[entry.first];
    own.centre = metric.centre;
    own.quantile_95 = metric.quantile_95;
    own.wins = metric.wins;
    own.failed = of_kept(kept, metric.failed);
    for_kept(kept, metric.seeds, [&](std::size_t i) {
      own.seeds.push_back(metric.seeds[i]);
      own.values.push_back(metric.values[i]);
    });
  }
  return out;
}

}  // namespace

bool is_named(const std::string& name, Kind kind, const std::string& method) {
  return name == method || name == full_name(kind, method);
}

bool is_selected(std::span<const std::string> names, Kind kind, const MethodSummary& method) {
  if (names.empty()) return !method.needs_truth;
  return std::any_of(names.begin(), names.end(),
                     [&](const std::string& name) { return is_named(name, kind, method.method); });
}

void require_held(const Summary& summary, std::span<const std::string> methods, std::span<const std::string> metrics) {
  std::set<std::string> known_methods, known_metrics;
  for (const Section& section : summary.sections) {
    known_metrics.insert(section.metrics.begin(), section.metrics.end());
    for (const MethodSummary& method : section.methods) {
      known_methods.insert(method.method);
      known_methods.insert(full_name(section.kind, method.method));
    }
  }
  require_named("method", methods, known_methods);
  require_named("metric", metrics, known_metrics);
}

Summary at_most_draws(const Summary& summary, std::size_t most) {
  std::map<std::string, Seeds> seeds;
  for (const Section& section : summary.sections) {
    Seeds& own = seeds[section.scenario];
    for (const MethodSummary& method : section.methods) {
      Seeds all;
      std::set_union(own.begin(), own.end(), method.seeds.begin(), method.seeds.end(), std::back_inserter(all));
      own = std::move(all);
    }
  }
  Summary out{{}, summary.scenarios, summary.draws, summary.rejected};
  for (const Section& section : summary.sections) {
    const Seeds kept = every_nth(seeds.at(section.scenario), most);
    Section& own =
        out.sections.emplace_back(Section{section.scenario, section.kind, section.baseline, {}, section.metrics});
    for (const MethodSummary& method : section.methods) own.methods.push_back(of_kept(kept, method));
  }
  return out;
}

}  // namespace tumble::scenarios
