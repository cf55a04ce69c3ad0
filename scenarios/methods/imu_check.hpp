// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

/// Reports the library's checks of IMU readings (imu_findings.hpp) in an estimate's health.
namespace tumble::scenarios {

/// Returns the primary IMU as its record describes it.
CheckedImu checked_imu(const sim::Sensors& sensors);

/// Adds the measured quantities of the checks to the estimate's health, and the findings to its failed checks. The
/// start of a frozen axis is reported relative to the first of `samples`.
void report_findings(const ImuFindings& findings, const sim::Sensors& sensors, std::span<const ImuSample> samples,
                     Estimate& estimate);

/// Reports whether the time stamps of the primary IMU are rounded.
void report_stamps(const sim::Sensors& sensors, Estimate& estimate);

/// Checks the primary IMU's readings (check_readings) and whether its stamps are rounded.
void check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples, Estimate& estimate);

/// Checks several merged IMUs. The differences between the IMUs also reveal a flipped sign (`imu_arm_share`) and
/// permuted axes (`imu_other_axes_share`). Returns `out_of_range`, with the reason, if readings contradict each other
/// or gravity.
Status check_imus(const sim::Sensors& sensors, const MergedImus& imus, Estimate& estimate);

/// Adds the covariance of suspect rates (suspect_covariance) to the estimate's rates. Only batch methods may call
/// inflate_rates(), because the results of a live or lagged method must not depend on later readings.
void inflate_rates(const ImuFindings& findings, std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
