// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>

#include "tumble/common/status.hpp"

namespace tumble::scenarios {

struct Estimate;

/// Adds a health finding (suspected fault) to an estimate. A second health finding with the same kind, sensor and axis
/// is ignored. A health finding about IMU readings also sets the health entry `imu_implausible`.
void add_finding(const HealthFinding& finding, Estimate& estimate);

void add_findings(const SensorHealth& health, std::span<const std::string> names, Estimate& estimate);

bool has_finding(HealthFinding::Kind kind, const Estimate& estimate, const std::string& sensor = "");
bool has_implausible_readings(const Estimate& estimate);
/// Sets the health entry `localised` of a run with a prior map. The value is 1, or 0 if a health finding reports that
/// the localisation in the prior map failed.
void report_localised(Estimate& estimate);

/// Returns false if a health finding contradicts the poses in the map.
bool has_consistent_poses(const Estimate& estimate);

/// Returns true if the fault has not ended at the end of the run, or if the fault makes the estimate unusable.
bool is_current(const HealthFinding& finding);
std::string report_text(const HealthFinding& finding);

nlohmann::json json_of(const HealthFinding& finding);
HealthFinding finding_in(const std::filesystem::path& path, const nlohmann::json& object);

}  // namespace tumble::scenarios
