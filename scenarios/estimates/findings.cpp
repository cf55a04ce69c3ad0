// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/estimates/findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "scenarios/estimates/estimate.hpp"
#include "scenarios/estimates/json_members.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

namespace tumble::scenarios {

namespace {

using About = HealthFinding::Kind;

bool is_about_readings(const HealthFinding& finding) {
  const About kind = finding.kind;
  // A health finding about the scale factor of the gyro ends if the measured rotation of gravity later confirms the
  // scale factor.
  if (kind == About::gyro_scale) return !finding.ended;
  return kind == About::frozen_axis || kind == About::frozen_sensor || kind == About::wrong_force_magnitude_at_rest ||
         kind == About::wrong_axes_or_signs || kind == About::inverted_accel_in_flight ||
         kind == About::inconsistent_rotation;
}

bool is_about_place(const HealthFinding& finding) {
  const About kind = finding.kind;
  return kind == About::tracking_lost || kind == About::lidar_scale || kind == About::lidar_calibration;
}

bool any_of(const Estimate& estimate, bool (*about)(const HealthFinding&)) {
  const auto& all = estimate.faults.findings;
  return std::any_of(all.begin(), all.end(), about);
}

/// A HealthFinding contains only a pointer to its text, so the text must exist until the program ends.
const char* kept(const std::string& text) {
  static std::mutex lock;
  static std::set<std::string> all;
  const std::lock_guard<std::mutex> locked(lock);
  return all.insert(text).first->c_str();
}

}  // namespace

void add_finding(const HealthFinding& finding, Estimate& estimate) {
  const std::size_t before = estimate.faults.findings.size();
  estimate.faults.add(finding);
  if (estimate.faults.findings.size() == before) return;
  if (is_about_readings(finding)) estimate.health["imu_implausible"] = 1.0;
}

void add_findings(const SensorHealth& health, std::span<const std::string> names, Estimate& estimate) {
  for (HealthFinding finding : health.findings) {
    std::size_t unit = 0;
    while (unit < names.size() && finding.sensor != imu_name(unit, names.size())) ++unit;
    if (unit < names.size()) finding.sensor = names[unit];
    add_finding(finding, estimate);
  }
}

bool has_finding(About kind, const Estimate& estimate, const std::string& sensor) {
  const auto& all = estimate.faults.findings;
  return std::any_of(all.begin(), all.end(), [&](const HealthFinding& finding) {
    return finding.kind == kind && (sensor.empty() || finding.sensor == sensor);
  });
}

bool has_implausible_readings(const Estimate& estimate) {
  return any_of(estimate, is_about_readings);
}

bool has_consistent_poses(const Estimate& estimate) {
  return !any_of(estimate, is_about_place);
}

void report_localised(Estimate& estimate) {
  const bool missing = any_of(
      estimate, [](const HealthFinding& finding) { return finding.kind == About::not_localised && !finding.ended; });
  estimate.health["localised"] = missing ? 0.0 : 1.0;
}

bool is_current(const HealthFinding& finding) {
  return !finding.ended || finding.invalidates_estimate();
}

std::string report_text(const HealthFinding& finding) {
  return (is_current(finding) ? "" : "earlier in the run: ") + to_text(finding);
}

nlohmann::json json_of(const HealthFinding& finding) {
  return {{"kind", to_string(finding.kind)},
          {"sensor", finding.sensor},
          {"axis", finding.axis},
          {"quantity", finding.quantity},
          {"value", finding.value},
          {"bound", finding.bound},
          {"confidence", finding.severity()},
          {"since_ns", finding.since_ns ? nlohmann::json(*finding.since_ns) : nlohmann::json()},
          {"ended", finding.ended},
          {"invalidates_estimate", finding.invalidates_estimate()},
          {"text", to_text(finding)}};
}

HealthFinding finding_in(const std::filesystem::path& path, const nlohmann::json& object) {
  const JsonMembers reader(path, object);
  const auto number = [&](const char* key) {
    const nlohmann::json& found = reader.member(key);
    return found.is_number() ? found.get<double>() : std::nan("");
  };
  HealthFinding out;
  out.kind = reader.named("kind", HealthFinding::kLast);
  out.sensor = reader.text("sensor");
  out.axis = kept(reader.text("axis"));
  out.quantity = kept(reader.text("quantity"));
  out.value = number("value");
  out.bound = number("bound");
  if (const nlohmann::json& since = reader.member("since_ns"); since.is_number_integer())
    out.since_ns = since.get<TimeNs>();
  out.ended = reader.member("ended") == true;
  return out;
}

}  // namespace tumble::scenarios
