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
#include "tumble/attitude/carried_elements.hpp"
#include "tumble/attitude/carried_smoother.hpp"

/// What the methods on a carried body have in common: the smoother fed with the primary IMU, its rails found before.
namespace tumble::scenarios {

/// Parameters of a method on the carried body, with the library's own defaults.
const Settings<CarriedSmoother::Params>& carried_settings();

/// Which elements of each sample stand at a rail, by what the record states of its ranges and what readings show. Adds
/// what was found of the rails to `health` (rails_told.hpp).
CarriedElements find_clipped(const sim::ImuRecord& record, std::span<const ImuSample> samples,
                             std::map<std::string, double>& health);

/// Parameters of a run, by what the recording states and `parameters` say.
CarriedSmoother::Params carried_params(const sim::Sensors& sensors, const sim::Values& parameters);

/// Runs the smoother over the primary IMU. Trouble: that of the record and of the smoother; the outputs are then empty.
Status run_carried(const sim::Sensors& sensors, const sim::Values& parameters, std::vector<RateState>& rates,
                   std::vector<AttitudeState>& attitudes, std::map<std::string, double>& health);

/// What a run of it tells, as numbers of `health`.
void report_carried(const CarriedSmoother::Report& report, std::map<std::string, double>& health);

}  // namespace tumble::scenarios
