// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tumble/common/sensor_health.hpp"

/// Stores the library's findings about sensors and estimate in an Estimate, and derives the entries of its health.
namespace tumble::scenarios {

struct Estimate;

/// Adds a finding and its entries of the health, for example `imu_implausible` or `imu_2_frozen_since_s`. The function
/// drops a second finding of the same kind, sensor and axis. Only this function defines keys of findings.
void add_finding(const HealthFinding& finding, Estimate& estimate);

/// Adds findings of the library. `names` are the names of the IMUs in the recording, in the order of the library's
/// units (unit_name).
void add_findings(const SensorHealth& health, std::span<const std::string> names, Estimate& estimate);

/// Returns whether the estimate has a finding of this kind, about `sensor` unless it is empty.
bool has_finding(HealthFinding::Kind kind, const Estimate& estimate, const std::string& sensor = "");
/// Returns whether the readings of the IMUs are constant, contradict each other, or contradict gravity.
bool has_implausible_readings(const Estimate& estimate);
/// Writes the entry `localised` and returns it: false if a finding contradicts the pose in the map.
bool report_localised(Estimate& estimate);

/// Writes and reads a finding in estimate.json (ESTIMATE.md). Throws BadInput with the file for an invalid finding.
nlohmann::json json_of(const HealthFinding& finding);
HealthFinding finding_in(const std::filesystem::path& path, const nlohmann::json& object);

}  // namespace tumble::scenarios
