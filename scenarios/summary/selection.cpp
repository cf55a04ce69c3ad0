// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/summary/selection.hpp"

#include <algorithm>
#include <set>
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

}  // namespace

bool is_named(const std::string& name, Kind kind, const std::string& method) {
  return name == method || name == std::string(to_string(kind)) + "/" + method;
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
      known_methods.insert(std::string(to_string(section.kind)) + "/" + method.method);
    }
  }
  require_known("method", methods, known_methods);
  require_known("metric", metrics, known_metrics);
}

}  // namespace tumble::scenarios
