// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

/// findings.hpp stores results of an estimate's health checks: possible faults of the estimate or of the sensor
/// readings.
namespace tumble::scenarios {

struct Estimate;

/// HealthFinding is a failed health check, in a form for later processing steps and programs. For people, the failed
/// check is also written as an entry of `health`.
struct HealthFinding {
  enum class About {
    readings,        ///< IMU readings contradict each other or gravity
    rates,           ///< all rates (Estimate::suspect_rad2_s2), because of `readings`
    flights,         ///< specific forces in flight contradict the angular rates; value: duration [s]
    stamps,          ///< stamps rounded more coarsely than the IMU period; value: rounding [s]
    rate_unit,       ///< rates are possibly not in rad/s
    force_unit,      ///< specific forces are possibly not in m/s^2
    attitude,        ///< inclination unknown; value: duration [s]
    place,           ///< pose in the map unknown; value: 0
    lidar_scale,     ///< lidar ranges have another scale than the motion
    beyond_range,    ///< readings that exceed what the device can measure; value: their number
    digest,          ///< the recording has no digest
    learnt_rig,      ///< the stored calibration belongs to another rig; value: distance in standard deviations
    unit_frozen,     ///< `unit` repeats one reading; value: start time [s]
    unit_disagrees,  ///< `unit` differs from the other IMUs; value: start time [s]
    unit_silent,     ///< `unit` has no readings; value: start time [s]
  };
  About about = About::readings;
  double value = 1.0;
  std::string unit = {};  ///< "imu_2", or one of its axes, "imu_2_gyro_z"

  bool operator==(const HealthFinding&) const = default;
};

inline constexpr std::array kAllFindings = {
    HealthFinding::About::readings,     HealthFinding::About::rates,          HealthFinding::About::flights,
    HealthFinding::About::stamps,       HealthFinding::About::rate_unit,      HealthFinding::About::force_unit,
    HealthFinding::About::attitude,     HealthFinding::About::place,          HealthFinding::About::lidar_scale,
    HealthFinding::About::beyond_range, HealthFinding::About::digest,         HealthFinding::About::learnt_rig,
    HealthFinding::About::unit_frozen,  HealthFinding::About::unit_disagrees, HealthFinding::About::unit_silent};

/// Returns the key of a failed check in the health, for example `imu_implausible` or `imu_2_frozen_since_s`. Only
/// row_of() defines keys of failed checks.
std::string row_of(const HealthFinding& finding);

/// Adds a failed check to the estimate, sorted by key, and adds the check's entry to the health. The new failed check
/// replaces one with an equal key.
void add_finding(const HealthFinding& finding, Estimate& estimate);

/// Returns true if the estimate already has a failed check with the same key as `finding`.
bool has_finding(const HealthFinding& finding, const Estimate& estimate);

/// Adds an entry to the health which states that the check `about` passed.
void report_no_findings(HealthFinding::About about, Estimate& estimate);

/// Restores the failed checks of an estimate from its health values, for estimates that were read from a file.
std::vector<HealthFinding> findings_in(const std::map<std::string, double>& health);

}  // namespace tumble::scenarios
