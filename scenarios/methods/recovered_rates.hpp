// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/detail/recording_rates.hpp"

namespace tumble::scenarios {

/// If the data of one auxiliary IMU are invalid, no auxiliary IMU is used.
RecoveredRates recovered_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                  ReplacedReadings replaced, Estimate& estimate);

}  // namespace tumble::scenarios
