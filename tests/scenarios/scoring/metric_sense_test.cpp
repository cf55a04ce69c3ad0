// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/metric_sense.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "scenarios/scoring/score.hpp"

namespace tumble::scenarios {
namespace {

TEST(MetricSense, NormalisedErrorsAndCoverageHaveATargetAndNoSense) {
  std::size_t normalised = 0, covered = 0;
  for (const Metric& metric : metrics()) {
    const bool nees = metric.name.find("nees") != std::string::npos;
    const bool coverage = metric.name.find("coverage_3sigma") != std::string::npos;
    normalised += nees;
    covered += coverage;
    EXPECT_EQ(metric_sense(metric.name) == Sense::neither && (nees || coverage), nees || coverage) << metric.name;
  }
  EXPECT_GE(normalised, 3u);
  EXPECT_GE(covered, 2u);
  EXPECT_EQ(metric_sense("map_overlap"), Sense::more);
  EXPECT_EQ(metric_sense("translation_error_end_m"), Sense::less);
}

TEST(MetricSense, WhatIsNamedIsAMetric) {
  for (const Kind kind : {Kind::rate, Kind::attitude, Kind::position, Kind::slam}) {
    for (const auto& names : {headline_metrics(kind), consistency_metrics(kind)}) {
      for (const std::string& name : names) {
        EXPECT_TRUE(std::any_of(metrics().begin(), metrics().end(), [&](const Metric& metric) {
          return metric.name == name && metric.kind == kind;
        })) << name;
      }
    }
  }
}

}  // namespace
}  // namespace tumble::scenarios
