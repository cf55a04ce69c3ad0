// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <span>

#include "scenarios/methods/method.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

/// The functions in imu_check.hpp run the library's checks of IMU readings (imu_findings.hpp) and report the results in
/// an estimate.
namespace tumble::scenarios {

/// Returns the description of the primary IMU that the library's checks need.
CheckedImu checked_imu(const sim::Sensors& sensors);

/// Adds findings about the primary IMU to the estimate.
void report_findings(const SensorHealth& health, const sim::Sensors& sensors, Estimate& estimate);

/// Checks the readings of the primary IMU (check_readings).
void check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate);

/// Runs all checks of the primary IMU with its estimated rates (check_recording).
ImuFindings check_imu_with_rates(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                 std::span<const RateState> rates, std::optional<double> carried_share,
                                 Estimate& estimate);

/// Adds the covariance of suspect rates (suspect_covariance) to the rates in the estimate. Only batch methods may call
/// inflate_rates, because live or lagged results must not depend on later readings.
void inflate_rates(const ImuFindings& findings, std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
