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

/// carried.hpp runs the hand-held smoother on the primary IMU after saturation detection. All hand-held methods use
/// this function.
namespace tumble::scenarios {

/// Returns the parameters of a hand-held method with the library's defaults.
const Settings<HandHeldSmoother::Params>& carried_settings();

/// Returns which sensing elements are saturated at each sample, according to the stated ranges and the readings. Adds
/// the detected saturation limits to `health` (report_rails.hpp).
ClippedReadings find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::map<std::string, double>& health);

/// Returns the smoother's parameters. `parameters` override the values of the recording.
HandHeldSmoother::Params carried_params(const sim::Sensors& sensors, const sim::Values& parameters);

/// Runs the smoother over the primary IMU. Returns an error of the record or of the smoother; the outputs are then
/// empty.
Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters, std::vector<RateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health);

/// Adds the smoother's report to `health`.
void report_carried(const HandHeldSmoother::Report& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
