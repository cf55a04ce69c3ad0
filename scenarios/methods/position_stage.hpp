// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"

/// Uses a position method as first stage of a sphere's slam method, which exposes all its parameters under the same
/// names.
namespace tumble::scenarios {

/// Returns the settings of the slam method: its own, then those of `position`. Their names differ.
std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position);

/// Returns the values in `parameters` that belong to the position method.
sim::Values values_of(const Method& position, const sim::Values& parameters);

}  // namespace tumble::scenarios
