// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

/// diagnosis.hpp finds faults of a recording that impair an estimate. Readers and estimators already report most
/// faults; diagnosis.hpp collects their reports and checks the sensors together.
namespace tumble::scenarios {

/// RecordingFinding is a fault of a recording.
struct RecordingFinding {
  std::string where;     ///< sensor, topic or file
  std::string evidence;  ///< description of the fault, with numbers and limits
  std::string repair;    ///< option of `tumble import` that repairs the reading, or another change; "": see `evidence`

  bool operator==(const RecordingFinding&) const = default;
};

/// Returns the option that a message recommends as "(set '--gyro-unit deg/s')" or "; set '--stamps record'". Returns ""
/// for other messages.
std::string recommended_option(const std::string& message);

/// Returns a finding for each note of an importer that is a caution. A note has the form "NAME: caution: TEXT".
std::vector<RecordingFinding> findings_in_notes(std::span<const std::string> notes);

/// Saturation describes the saturated readings of one IMU, as ClippingFinder finds them.
struct Saturation {
  double gyro_share = 0.0, accel_share = 0.0;  ///< samples with at least one saturated axis
  double gyro_rad_s = 0.0, accel_m_s2 = 0.0;   ///< smallest saturated reading; 0: none
};
/// Cost: O(N log N). All saturation values are 0 if the IMU cannot be used.
Saturation saturation_of(const sim::ImuRecord& imu);

/// Checks the readings: sensors that start apart, lost readings and sweeps, saturation, motion at the start, and points
/// without times. O(N).
std::vector<RecordingFinding> findings_in_readings(const sim::Sensors& sensors);

/// Checks the result of a slam method: an error, sweeps that were not registered, and the findings of its health.
std::vector<RecordingFinding> findings_in_estimate(const Estimate& estimate, std::size_t sweeps);

}  // namespace tumble::scenarios
