// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

/// The functions in imu_check.hpp run the library's checks of IMU readings (imu_findings.hpp) and report the results in
/// an estimate.
namespace tumble::scenarios {

/// Returns the description of the primary IMU that the library's checks need.
CheckedImu checked_imu(const sim::Sensors& sensors);

/// Adds the measured quantities of the checks to the estimate's health, and the findings about the primary IMU.
void report_findings(const ImuFindings& findings, const sim::Sensors& sensors, Estimate& estimate);

/// Adds the measured quantities and the findings about merged IMUs to the estimate. The list `names` contains the names
/// of the IMUs in use.
void report_merged(const MergedFindings& merged, std::span<const std::string> names, Estimate& estimate);

/// Reports in the estimate whether the time stamps of the primary IMU are rounded.
void report_stamps(const sim::Sensors& sensors, Estimate& estimate);

/// Checks the readings of the primary IMU (check_readings), and whether their time stamps are rounded.
void check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate);

/// Adds the covariance of suspect rates (suspect_covariance) to the rates in the estimate. Only batch methods may call
/// inflate_rates, because live or lagged results must not depend on later readings.
void inflate_rates(const ImuFindings& findings, std::span<const ImuSample> samples, Estimate& estimate);
/// Reports the rates to which suspect_covariance() was added because readings contradict each other.
void report_inflated(const ImuFindings& findings, Estimate& estimate);

}  // namespace tumble::scenarios
