// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/summary/summary.hpp"
#include "tests/testing.hpp"

/// The functions here make summaries of two methods on two draws, for tests of pages and figures.
namespace tumble::tools {

inline scenarios::MetricSummary metric(std::vector<double> values) {
  scenarios::MetricSummary out;
  for (std::size_t i = 0; i < values.size(); ++i) out.seeds.push_back(i + 1);
  out.centre = {values.front(), values.front(), values.front()};
  out.values = std::move(values);
  return out;
}

inline scenarios::Summary page_summary(const std::string& scenario, const std::string& method = "saave") {
  scenarios::MethodSummary raw, saave;
  raw.method = "raw";
  raw.metrics["rate_error_clipped_median_rad_s"] = metric({2.0, 3.0});
  saave.method = method;
  saave.metrics["rate_error_clipped_median_rad_s"] = metric({0.1, 0.2});
  scenarios::Section section;
  section.scenario = scenario;
  section.kind = scenarios::Kind::rate;
  section.baseline = "raw";
  section.methods = {raw, saave};
  section.metrics = {"rate_error_clipped_median_rad_s"};
  scenarios::Summary summary;
  summary.sections = {section};
  summary.scenarios = {scenario};
  summary.draws[scenario] = 2;
  return summary;
}

}  // namespace tumble::tools
