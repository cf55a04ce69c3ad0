// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/detail/recording_rates.hpp"

namespace tumble::scenarios {

/// Replaces gyro readings of a rig by the rates of rate/tumble (recover_rates). Reports the saturation limits and the
/// number of replaced samples. Auxiliary IMUs are not used if the record of one is invalid.
RecoveredRates recovered_readings(const sim::Sensors& sensors, std::span<const ImuSample> samples,
                                  ReplacedReadings replaced, Estimate& estimate);

}  // namespace tumble::scenarios
