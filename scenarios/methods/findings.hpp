// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tumble/common/sensor_health.hpp"

/// The functions in findings.hpp store findings (suspected faults of sensors and estimate) in an Estimate.
namespace tumble::scenarios {

struct Estimate;

/// Adds a finding to the estimate, and `imu_implausible` to the health if the finding is about IMU readings. A second
/// finding of the same kind, sensor and axis is dropped.
void add_finding(const HealthFinding& finding, Estimate& estimate);

/// Adds all findings in `health` to the estimate. The list `names` contains the names of the IMUs in the recording, in
/// the order of the library's units (unit_name).
void add_findings(const SensorHealth& health, std::span<const std::string> names, Estimate& estimate);

/// Returns whether the estimate has a finding of this kind, about the sensor `sensor` unless `sensor` is empty.
bool has_finding(HealthFinding::Kind kind, const Estimate& estimate, const std::string& sensor = "");
/// Returns whether IMU readings are constant, contradict readings of another IMU, or contradict gravity.
bool has_implausible_readings(const Estimate& estimate);
/// Sets the health entry `localised` and returns its value: false if a finding contradicts the pose in the map.
bool report_localised(Estimate& estimate);

/// Returns whether a finding applies at the end of the run: the finding has not ended, or its fault makes all later
/// poses wrong.
bool is_current(const HealthFinding& finding);
/// Returns the text of a finding for tables and notes. The text of an ended finding starts with "earlier in the run: ".
std::string report_text(const HealthFinding& finding);

/// The functions json_of and finding_in write and read a finding in estimate.json (ESTIMATE.md). Reading throws
/// BadInput with the file name for an invalid finding.
nlohmann::json json_of(const HealthFinding& finding);
HealthFinding finding_in(const std::filesystem::path& path, const nlohmann::json& object);

}  // namespace tumble::scenarios
