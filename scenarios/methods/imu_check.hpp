// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

/// Reports the library's checks of IMU readings (imu_findings.hpp) in an estimate.
namespace tumble::scenarios {

/// Returns the primary IMU as its record describes it.
CheckedImu checked_imu(const sim::Sensors& sensors);

/// Adds the measured quantities of the checks to the estimate's health, and the findings about the primary IMU.
void report_findings(const ImuFindings& findings, const sim::Sensors& sensors, Estimate& estimate);

/// Adds the quantities and the findings about merged IMUs. `names` are the names of the IMUs in use.
void report_merged(const MergedFindings& merged, std::span<const std::string> names, Estimate& estimate);

/// Reports whether the time stamps of the primary IMU are rounded.
void report_stamps(const sim::Sensors& sensors, Estimate& estimate);

/// Checks the primary IMU's readings (check_readings) and whether its stamps are rounded.
void check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate);

/// Adds the covariance of suspect rates (suspect_covariance) to the estimate's rates. Only batch methods may call this
/// function, because the results of a live or lagged method must not depend on later readings.
void inflate_rates(const ImuFindings& findings, std::span<const ImuSample> samples, Estimate& estimate);
/// Reports rates whose covariance contains suspect_covariance() because readings contradict each other.
void report_inflated(const ImuFindings& findings, Estimate& estimate);

}  // namespace tumble::scenarios
