// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "scenarios/methods/settings.hpp"
#include "sim/parameters.hpp"
#include "sim/recording.hpp"
#include "tumble/attitude/clipped_readings.hpp"
#include "tumble/attitude/hand_held_smoother.hpp"

/// The methods for hand-held motion use the functions in carried.hpp, which run the hand-held smoother on the primary
/// IMU after saturation detection.
namespace tumble::scenarios {

/// Returns the settings of the hand-held methods, with the library's defaults.
const Settings<HandHeldSmoother::Params>& carried_settings();

/// Finds the saturated sensing elements in each sample, from the readings and the measurement ranges of the IMU. Adds
/// the detected saturation limits to `health` (report_rails.hpp).
ClippedReadings find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::map<std::string, double>& health);

/// Returns the parameters of the hand-held smoother for a recording. The values in `parameters` override the values of
/// the recording.
HandHeldSmoother::Params carried_params(const sim::Sensors& sensors, const sim::Values& parameters);

/// Runs the hand-held smoother over the primary IMU. On an error of the IMU record or of the smoother, the outputs are
/// empty.
Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters, std::vector<RateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health);

/// Adds the report of the hand-held smoother to `health`.
void report_carried(const HandHeldSmoother::Report& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
