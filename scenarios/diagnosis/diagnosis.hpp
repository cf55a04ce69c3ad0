// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/estimate.hpp"
#include "sim/recording.hpp"

namespace tumble::scenarios {

struct RecordingFinding {
  std::string where;     ///< sensor, topic or file
  std::string evidence;  ///< description of the fault, with numbers and limits
  std::string repair;    ///< import option or another repair
  bool fault = true;     ///< false: a note

  bool operator==(const RecordingFinding&) const = default;
};

std::string recommended_option(const std::string& message);

std::vector<RecordingFinding> findings_in_notes(std::span<const std::string> notes);

struct Saturation {
  double gyro_share = 0.0, accel_share = 0.0;  ///< samples with at least one saturated axis
  double gyro_rad_s = 0.0, accel_m_s2 = 0.0;   ///< smallest saturated reading; 0: none
};
Saturation saturation_of(const sim::ImuRecord& imu);

/// @param cloud_fields  Field names of the clouds of each lidar, or empty if unknown.
std::vector<RecordingFinding> findings_in_readings(const sim::Sensors& sensors,
                                                   std::span<const std::vector<std::string>> cloud_fields = {});

/// @param method  Name of the method that computed the estimate.
std::vector<RecordingFinding> findings_in_estimate(const Estimate& estimate, const std::string& method,
                                                   std::size_t sweeps);

}  // namespace tumble::scenarios
