// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

/// Functions that our position methods and their oracles share.
namespace tumble::scenarios {

/// Returns the parameters of the full-recording smoother: the library's defaults, except for the lever-arm prior.
const Settings<RollingSmoother::Params>& position_settings();

/// Returns the smoother's parameters without the `fixed` parameters, which an oracle takes from the truth, and without
/// a known distance.
Settings<RollingSmoother::Params> oracle_settings(std::vector<std::string> fixed);

/// Returns the smoother's parameters: the values of the sensors, overridden by `parameters`. Devices without a data
/// sheet get wider priors.
RollingSmoother::Params rolling_smoother_params(const sim::Sensors& sensors, const MergedImus& imus,
                                                const Settings<RollingSmoother::Params>& settings,
                                                const sim::Values& parameters);

/// Runs the smoother over all samples and writes the result to `estimate`; `known` states the contact modes if they are
/// known.
void smooth(const RollingSmoother::Params& params, const MergedImus& imus, std::span<const RollingMode> known,
            Estimate& estimate);

}  // namespace tumble::scenarios
