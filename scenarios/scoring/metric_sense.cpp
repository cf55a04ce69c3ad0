// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/scoring/metric_sense.hpp"

namespace tumble::scenarios {

namespace {

bool contains(const std::string& text, const char* part) {
  return text.find(part) != std::string::npos;
}

}  // namespace

Sense metric_sense(const std::string& metric) {
  // coverage of an interval and normalised errors have a target; costs are no contest
  for (const char* part : {"coverage_3sigma", "nees", "_cpu_s", "_mib", "flagged_share", "rate_reference_"}) {
    if (contains(metric, part)) return Sense::neither;
  }
  for (const char* part : {"overlap", "coverage", "precision", "recall"}) {
    if (contains(metric, part)) return Sense::more;
  }
  return Sense::less;
}

bool is_verdict(const std::string& metric) {
  return metric == "map_failed";
}

std::vector<std::string> headline_metrics(Kind kind) {
  switch (kind) {
    case Kind::rate:
      return {"rate_error_clipped_median_rad_s", "rate_error_clipped_p99_rad_s"};
    case Kind::attitude:
      return {"inclination_rmse_rad"};
    case Kind::position:
      return {"position_end_error_share"};
    case Kind::slam:
      return {"translation_error_end_m", "rotation_error_end_rad", "map_overlap"};
  }
  return {};
}

std::vector<std::string> consistency_metrics(Kind kind) {
  switch (kind) {
    case Kind::rate:
      return {"rate_nees_flight", "rate_nees_impact"};
    case Kind::slam:
      return {"pose_nees"};
    case Kind::attitude:
    case Kind::position:
      break;
  }
  return {};
}

}  // namespace tumble::scenarios
