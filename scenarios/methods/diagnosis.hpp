// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"

/// The functions in diagnosis.hpp find faults of a recording that increase the error of an estimate. The functions
/// collect the warnings of importers and estimators, and check the sensors together.
namespace tumble::scenarios {

/// RecordingFinding describes one fault of a recording, or a note on a property that is no fault.
struct RecordingFinding {
  std::string where;     ///< sensor, topic or file
  std::string evidence;  ///< description of the fault, with numbers and limits
  std::string repair;    ///< option of `tumble import` that repairs the reading, or another change; "": see `evidence`
  bool fault = true;     ///< false: a note, for example on saturation or on an ended finding

  bool operator==(const RecordingFinding&) const = default;
};

/// Returns the option in a message that contains "(set '--gyro-unit deg/s')" or "; set '--stamps record'". Returns ""
/// for messages without an option.
std::string recommended_option(const std::string& message);

/// Converts each warning of an importer to a finding. A warning has the form "NAME: caution: TEXT".
std::vector<RecordingFinding> findings_in_notes(std::span<const std::string> notes);

/// Saturation describes the saturated readings of one IMU that ClippingFinder detects.
struct Saturation {
  double gyro_share = 0.0, accel_share = 0.0;  ///< samples with at least one saturated axis
  double gyro_rad_s = 0.0, accel_m_s2 = 0.0;   ///< smallest saturated reading; 0: none
};
/// Detects the saturated readings of an IMU, in O(N log N). All values of the result are 0 if the readings of the IMU
/// are unusable.
Saturation saturation_of(const sim::ImuRecord& imu);

/// Checks the readings for different start times, lost readings and sweeps, saturation, motion at the start, and points
/// without times. The cost is O(N).
std::vector<RecordingFinding> findings_in_readings(const sim::Sensors& sensors);

/// Checks the result of a slam method for an error, sweeps that were not registered, and failed health checks.
std::vector<RecordingFinding> findings_in_estimate(const Estimate& estimate, std::size_t sweeps);

}  // namespace tumble::scenarios
