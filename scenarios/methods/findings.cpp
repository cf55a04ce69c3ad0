// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/findings.hpp"

#include <algorithm>
#include <string_view>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

static_assert(kAllFindings.size() == static_cast<std::size_t>(HealthFinding::About::unit_silent) + 1);

namespace {

/// Returns the health key of a check. For a check of an IMU, the function returns the suffix of the key.
const char* row_name(HealthFinding::About about) {
  switch (about) {
    case HealthFinding::About::readings:
      return "imu_implausible";
    case HealthFinding::About::rates:
      return "imu_rates_doubted";
    case HealthFinding::About::flights:
      return "imu_flight_against_s";
    case HealthFinding::About::stamps:
      return "imu_stamps_rounded_s";
    case HealthFinding::About::rate_unit:
      return "rate_unit_suspect";
    case HealthFinding::About::force_unit:
      return "force_unit_suspect";
    case HealthFinding::About::attitude:
      return "attitude_unknown_s";
    case HealthFinding::About::place:
      return "localised";
    case HealthFinding::About::lidar_scale:
      return "lidar_scale_implausible";
    case HealthFinding::About::beyond_range:
      return "imu_readings_beyond_range";
    case HealthFinding::About::digest:
      return "recording_without_digest";
    case HealthFinding::About::learnt_rig:
      return "learnt_rig_contradicted";
    case HealthFinding::About::unit_frozen:
      return "_frozen_since_s";
    case HealthFinding::About::unit_disagrees:
      return "_disagrees_since_s";
    case HealthFinding::About::unit_silent:
      break;
  }
  return "_silent_since_s";
}

/// Returns whether a health entry with this value reports a failed check. For a check of an IMU, 0 is a valid start
/// time.
bool is_said(HealthFinding::About about, double value) {
  if (row_name(about)[0] == '_') return true;
  return (value == 0.0) == (about == HealthFinding::About::place);
}

auto place_of(const std::string& row, std::vector<HealthFinding>& findings) {
  return std::lower_bound(findings.begin(), findings.end(), row,
                          [](const HealthFinding& finding, const std::string& name) { return row_of(finding) < name; });
}

}  // namespace

std::string row_of(const HealthFinding& finding) {
  return finding.unit + row_name(finding.about);
}

void add_finding(const HealthFinding& finding, Estimate& estimate) {
  const std::string row = row_of(finding);
  const auto at = place_of(row, estimate.findings);
  if (at != estimate.findings.end() && row_of(*at) == row) {
    *at = finding;
  } else {
    estimate.findings.insert(at, finding);
  }
  estimate.health[row] = finding.value;
}

bool has_finding(const HealthFinding& finding, const Estimate& estimate) {
  return std::any_of(estimate.findings.begin(), estimate.findings.end(), [&](const HealthFinding& known) {
    return known.about == finding.about && known.unit == finding.unit;
  });
}

void report_no_findings(HealthFinding::About about, Estimate& estimate) {
  estimate.health[row_name(about)] = about == HealthFinding::About::place ? 1.0 : 0.0;
}

std::vector<HealthFinding> findings_in(const std::map<std::string, double>& health) {
  std::vector<HealthFinding> out;
  for (const auto& [row, value] : health) {
    for (const HealthFinding::About about : kAllFindings) {
      const std::string_view name = row_name(about);
      const bool is_its = name.starts_with('_') ? row.ends_with(name) : row == name;
      if (is_its && is_said(about, value)) out.push_back({about, value, row.substr(0, row.size() - name.size())});
    }
  }
  return out;
}

}  // namespace tumble::scenarios
