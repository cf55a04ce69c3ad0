// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"
#include "scenarios/methods/sphere_imus.hpp"
#include "tumble/rolling/rolling_smoother.hpp"

/// What our position methods and their oracles share.
namespace tumble::scenarios {

/// Parameters of the smoother over a whole run, with the library's defaults but for the prior of the lever arm.
const Settings<RollingSmoother::Params>& position_settings();

/// The same without `fixed` ones, which an oracle knows, and without a known distance.
Settings<RollingSmoother::Params> oracle_settings(std::vector<std::string> fixed);

/// What the sensors state, then what `parameters` say, and wider priors for a device that no data sheet is named for.
RollingSmoother::Params rolling_smoother_params(const sim::Sensors& sensors, const MergedImus& imus,
                                                const Settings<RollingSmoother::Params>& settings,
                                                const sim::Values& parameters);

/// Runs the smoother over all samples, with modes known from elsewhere when given, into `estimate`.
void smooth(const RollingSmoother::Params& params, const MergedImus& imus, std::span<const RollingMode> known,
            Estimate& estimate);

}  // namespace tumble::scenarios
