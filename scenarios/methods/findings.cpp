// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>

#include "scenarios/methods/json_members.hpp"
#include "scenarios/methods/method.hpp"
#include "tumble/odometry/detail/merge_recordings.hpp"

namespace tumble::scenarios {

namespace {

using About = HealthFinding::Kind;

/// Returns the key of the start time of a finding [s], for example "imu_2_gyro_z_frozen_since_s".
std::string since_key(const HealthFinding& finding, const char* suffix) {
  const std::string axis = finding.axis;
  return finding.sensor + (axis.empty() ? "" : "_" + axis) + suffix;
}

bool is_about_readings(const HealthFinding& finding) {
  const About kind = finding.kind;
  // the rotation of gravity can confirm the scale of the gyro later
  if (kind == About::gyro_scale) return !finding.ended;
  return kind == About::frozen_axis || kind == About::frozen_sensor || kind == About::force_at_rest ||
         kind == About::axes_or_signs || kind == About::flight_forces || kind == About::rotation;
}

bool is_about_place(const HealthFinding& finding) {
  const About kind = finding.kind;
  return kind == About::tracking_lost || kind == About::lidar_scale || kind == About::lidar_calibration;
}

/// Adds the health entry of a finding; the key of the entry depends on the kind of the finding.
void add_row(const HealthFinding& finding, std::map<std::string, double>& health) {
  const double since_s = seconds(finding.since_ns.value_or(0));
  switch (finding.kind) {
    case About::frozen_axis:
    case About::unit_frozen:
      health[since_key(finding, "_frozen_since_s")] = since_s;
      return;
    case About::unit_silent:
      health[since_key(finding, "_silent_since_s")] = since_s;
      return;
    case About::unit_disagrees:
      health[since_key(finding, "_disagrees_since_s")] = since_s;
      return;
    case About::flight_forces:
      health["imu_flight_against_s"] = finding.value;
      return;
    case About::rate_unit:
      health["rate_unit_suspect"] = 1.0;
      return;
    case About::force_unit:
      health["force_unit_suspect"] = 1.0;
      return;
    case About::beyond_range:
      health["imu_readings_beyond_range"] = finding.value;
      return;
    case About::rounded_stamps:
      health["imu_stamps_rounded_s"] = finding.value;
      return;
    case About::lidar_scale:
      health["lidar_scale_implausible"] = 1.0;
      return;
    case About::rig_calibration:
      health["learnt_rig_contradicted"] = finding.value;
      return;
    case About::attitude_unknown:
      health["attitude_unknown_s"] = finding.value;
      return;
    case About::vertical_unknown:
      health["vertical_sigma_rad"] = finding.value;
      return;
    default:  // the code below adds the entries that several kinds share
      return;
  }
}

bool any_of(const Estimate& estimate, bool (*about)(const HealthFinding&)) {
  const auto& all = estimate.faults.findings;
  return std::any_of(all.begin(), all.end(), about);
}

/// Returns a copy of the text with static lifetime, because a finding contains only a pointer.
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
  add_row(finding, estimate.health);
  if (is_about_readings(finding)) estimate.health["imu_implausible"] = 1.0;
}

void add_findings(const SensorHealth& health, std::span<const std::string> names, Estimate& estimate) {
  for (HealthFinding finding : health.findings) {
    std::size_t unit = 0;
    while (unit < names.size() && finding.sensor != unit_name(unit, names.size())) ++unit;
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

bool report_localised(Estimate& estimate) {
  const bool localised = !any_of(estimate, is_about_place);
  estimate.health["localised"] = localised ? 1.0 : 0.0;
  return localised;
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
          {"confidence", finding.confidence},
          {"since_ns", finding.since_ns ? nlohmann::json(*finding.since_ns) : nlohmann::json()},
          {"ended", finding.ended},
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
  out.confidence = number("confidence");
  if (const nlohmann::json& since = reader.member("since_ns"); since.is_number_integer())
    out.since_ns = since.get<TimeNs>();
  out.ended = reader.member("ended") == true;
  return out;
}

}  // namespace tumble::scenarios
