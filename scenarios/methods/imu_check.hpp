// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/estimates/method.hpp"
#include "scenarios/recordings/import.hpp"
#include "tumble/angular_velocity/detail/clipping_finder.hpp"
#include "tumble/attitude/detail/regime_smoother.hpp"
#include "tumble/common/types.hpp"
#include "tumble/odometry/detail/imu_findings.hpp"

namespace tumble::scenarios {

ImuDescription checked_imu(const sim::Sensors& sensors);

void report_findings(const SensorHealth& health, const sim::Sensors& sensors, Estimate& estimate);

ImuHealthReport check_imu(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                          std::span<const AngularRateState> rates, std::optional<double> carried_share,
                          Estimate& estimate);

/// Increases the rate covariances according to the health findings. Only methods that process the whole recording may
/// call inflate_rates(), because live results must not depend on later readings.
void inflate_rates(const ImuHealthReport& findings, std::span<const ImuSample> samples, Estimate& estimate);

/// Returns a warning if units, signs or axes of the readings seem wrong, otherwise an empty text.
std::string imu_note(const sim::ImuRecord& imu, double gravity_m_s2);
std::vector<std::string> imu_notes(const Imported& recording);

void report_rates(const MotionRegimeSmoother::Report& report, Estimate& result);

/// Adds the estimated saturation limits of the gyro to `health`. Limits that were copied from another axis or from a
/// data sheet are omitted.
void report_rails(const SaturationLevels& rails, std::map<std::string, double>& health);

std::optional<double> carried_share(const MotionRegimeSmoother::Report& report);

void report_gaps(std::span<const ImuSample> samples, Estimate& estimate);

}  // namespace tumble::scenarios
