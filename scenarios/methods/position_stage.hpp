// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"

/// A position method is the first stage of a sphere's slam method, which has all parameters of the position method,
/// with the same names.
namespace tumble::scenarios {

/// The two groups must have different parameter names.
std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position);

sim::Values values_of(const Method& position, const sim::Values& parameters);

}  // namespace tumble::scenarios
