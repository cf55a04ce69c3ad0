// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/cases/hold_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "scenarios/errors.hpp"
#include "scenarios/methods/registry.hpp"

namespace tumble::scenarios {

namespace {

std::string four_digits(double value) {
  std::ostringstream text;
  text.precision(4);
  text << value;
  return text.str();
}

std::optional<double> finite_value_of(const Outcome& outcome, const std::string& metric) {
  const double value = value_of(outcome.scores, metric);
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

std::string doc_of(const Shrunk& shrunk, const std::string& method, const std::string& scenario, std::uint64_t seed) {
  std::string needed;
  std::size_t not_tried = 0;
  for (const ShrinkLine& line : shrunk.lines) {
    if (line.what == "duration_s" || line.fate == Fate::removed) continue;
    if (line.fate == Fate::not_tried)
      ++not_tried;
    else
      needed += (needed.empty() ? "" : ", ") + line.what;
  }
  std::string doc = fmt::format(
      "The method {} fails ({}) on a simplified form of the simulated run with seed {} of scenario {}. The failure "
      "disappears if one of these parts is removed: {}",
      method, shrunk.failure, seed, scenario, needed.empty() ? "none" : needed);
  if (not_tried > 0)
    doc = fmt::format("{}. The removal of other parts of the scenario was not tested (number of parts: {})", doc,
                      not_tried);
  return doc + ".";
}

std::string how_it_fails(const CaseResult& result) {
  std::string text = to_string(result.status);
  if (result.value) text += ", " + result.expected.metric + " " + four_digits(*result.value);
  return text;
}

}  // namespace

Scenario named_case_of(const Shrunk& shrunk, const std::string& name, const std::string& method,
                       const FailureGoal& failure, const std::string& version, const std::string& command) {
  Scenario out = shrunk.scenario;
  Expectation expected;
  expected.method = method;
  expected.fails = true;
  expected.metric = failure.metric.empty() ? headline_metrics(shrunk.drawn.kind).front() : failure.metric;
  if (!failure.metric.empty() && std::isfinite(failure.limit)) expected.worse_than = failure.limit;
  expected.status = to_string(shrunk.left.status);
  expected.drawn = finite_value_of(shrunk.drawn, expected.metric);
  expected.value = finite_value_of(shrunk.left, expected.metric);
  out.doc = doc_of(shrunk, method, out.name, shrunk.drawn.seed);
  out.named_case = NamedCase{out.name, shrunk.drawn.seed, version, command, {expected}};
  out.name = name;
  return out;
}

FailureGoal failure_of(const Expectation& expected) {
  return expected.worse_than ? FailureGoal{expected.metric, *expected.worse_than} : FailureGoal{};
}

CaseResult hold_case(const std::string& name, const Expectation& expected, const Outcome& outcome) {
  CaseResult result{name,  expected.method, expected, outcome.status, finite_value_of(outcome, expected.metric),
                    false, false,           ""};
  result.fails = failure_of(expected).holds(outcome);
  if (!expected.fails) {
    if (result.fails) result.fault = "fails: " + how_it_fails(result);
    return result;
  }
  const auto is_better = [&](const std::string& what) {
    result.better = true;
    result.fault = fmt::format(
        "{}; this is an improvement, so run the command again with '--accept' to store the new result", what);
  };
  if (!result.fails) {
    is_better("cured: " + how_it_fails(result));
  } else if (to_string(outcome.status) != expected.status) {
    result.fault = fmt::format("the run fails with status '{}', but the accepted result has the status '{}'",
                               to_string(outcome.status), expected.status);
  } else if (expected.value.has_value() != result.value.has_value()) {
    result.fault =
        result.value
            ? fmt::format("the metric {} has the value {}, but the accepted result has no value of this metric",
                          expected.metric, four_digits(*result.value))
            : fmt::format("the metric {} has no value, but the accepted result has a value of this metric",
                          expected.metric);
  } else if (result.value) {
    const MetricInfo& info = metric_info(expected.metric);
    const double was = *expected.value, is = *result.value;
    const bool within = std::abs(is) <= kCaseFactor * std::abs(was) && std::abs(was) <= kCaseFactor * std::abs(is);
    const std::string what = fmt::format("the metric {} is {}, but the accepted value is {}", expected.metric,
                                         four_digits(is), four_digits(was));
    if (!within && tumble::scenarios::is_better(info, is, was)) is_better("better: " + what);
    if (!within && !result.better) result.fault = what;
  }
  return result;
}

Expectation accepted(const Expectation& expected, const Outcome& outcome) {
  Expectation out = expected;
  out.fails = failure_of(expected).holds(outcome);
  out.status = to_string(outcome.status);
  out.value = finite_value_of(outcome, expected.metric);
  return out;
}

void require_known(const Scenario& scenario) {
  if (!scenario.named_case)
    throw BadInput(fmt::format(
        "{}: the key 'case' is missing; the file of a named case must contain the expected results under this key",
        scenario.file));
  for (const Expectation& expected : scenario.named_case->expected) {
    const std::string place = scenario.file + ": expect: ";
    const std::vector<MethodPointer> found = find_methods(expected.method);
    if (found.size() != 1)
      throw BadInput(fmt::format(
          "{}'{}' must be the name of exactly one method; write the kind before the name, for example 'slam/NAME'",
          place, expected.method));
    if (!outcome_status_named(expected.status)) throw BadInput(place + "unknown status '" + expected.status + "'");
    const auto known = metrics();
    const auto is_it = [&](const Metric& metric) {
      return metric.info.name == expected.metric && metric.kind == found.front()->info.kind;
    };
    if (!expected.metric.empty() && std::none_of(known.begin(), known.end(), is_it))
      throw BadInput(
          fmt::format("{}'{}' is not a metric of methods of kind {}; 'tumble list metrics' lists the metrics", place,
                      expected.metric, to_string(found.front()->info.kind)));
  }
}

}  // namespace tumble::scenarios
