// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"

/// position_stage.hpp uses a position method as the first stage of a sphere's slam method. The slam method has all
/// parameters of the position method, with the same names.
namespace tumble::scenarios {

/// Returns the settings `own` of the slam method, followed by the settings of `position`. The two groups must have
/// different parameter names.
std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position);

/// Returns the values in `parameters` that belong to the position method.
sim::Values values_of(const Method& position, const sim::Values& parameters);

}  // namespace tumble::scenarios
