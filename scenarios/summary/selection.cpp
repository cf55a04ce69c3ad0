// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/selection.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>
#include <vector>

#include "scenarios/errors.hpp"
#include "sim/parameters.hpp"

namespace tumble::scenarios {

namespace {

void require_known(const std::string& what, std::span<const std::string> names, const std::set<std::string>& known) {
  for (const std::string& name : names) {
    if (known.contains(name)) continue;
    const std::string near = sim::nearest_name(name, std::vector<std::string>(known.begin(), known.end()));
    throw BadInput("the results hold no " + what + " '" + name + "'" +
                   (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
}

/// Rising.
std::vector<std::uint64_t> every_nth(const std::set<std::uint64_t>& seeds, std::size_t most) {
  std::vector<std::uint64_t> out;
  const std::size_t step = (seeds.size() + most - 1) / std::max<std::size_t>(most, 1);
  std::size_t place = 0;
  for (const std::uint64_t seed : seeds) {
    if (place++ % std::max<std::size_t>(step, 1) == 0) out.push_back(seed);
  }
  return out;
}

void keep(const std::vector<std::uint64_t>& kept, MethodSummary& method) {
  const auto is_left_out = [&](std::uint64_t seed) { return !std::binary_search(kept.begin(), kept.end(), seed); };
  std::erase_if(method.seeds, is_left_out);
  std::erase_if(method.not_ok_seeds, is_left_out);
  for (auto& [name, metric] : method.metrics) {
    std::vector<double> values;
    for (std::size_t i = 0; i < metric.seeds.size(); ++i) {
      if (!is_left_out(metric.seeds[i])) values.push_back(metric.values[i]);
    }
    metric.values = std::move(values);
    std::erase_if(metric.seeds, is_left_out);
    std::erase_if(metric.failed, is_left_out);
  }
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
  require_known("method", methods, known_methods);
  require_known("metric", metrics, known_metrics);
}

Summary at_most_draws(const Summary& summary, std::size_t most) {
  std::map<std::string, std::set<std::uint64_t>> seeds;
  for (const Section& section : summary.sections) {
    for (const MethodSummary& method : section.methods)
      seeds[section.scenario].insert(method.seeds.begin(), method.seeds.end());
  }
  Summary out = summary;
  for (Section& section : out.sections) {
    const std::vector<std::uint64_t> kept = every_nth(seeds.at(section.scenario), most);
    for (MethodSummary& method : section.methods) keep(kept, method);
  }
  return out;
}

}  // namespace tumble::scenarios
