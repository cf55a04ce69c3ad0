// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tumble/common/sensor_health.hpp"

/// Findings are suspected faults of sensors and estimate.
namespace tumble::scenarios {

struct Estimate;

/// A second finding of the same kind, sensor and axis is dropped. A finding about IMU readings also sets
/// `imu_implausible` in the health.
void add_finding(const HealthFinding& finding, Estimate& estimate);

void add_findings(const SensorHealth& health, std::span<const std::string> names, Estimate& estimate);

bool has_finding(HealthFinding::Kind kind, const Estimate& estimate, const std::string& sensor = "");
/// Implausible IMU readings are constant, contradict readings of another IMU, or contradict gravity.
bool has_implausible_readings(const Estimate& estimate);
/// The health entry `localised` is false if a finding contradicts the pose in the map.
bool report_localised(Estimate& estimate);

/// A finding applies at the end of the run if it has not ended, or if its fault makes all later poses wrong.
bool is_current(const HealthFinding& finding);
std::string report_text(const HealthFinding& finding);

nlohmann::json json_of(const HealthFinding& finding);
HealthFinding finding_in(const std::filesystem::path& path, const nlohmann::json& object);

}  // namespace tumble::scenarios
