// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"

/// A position method as the first stage of a map of the sphere: each of its numbers is the map's method's too, by the
/// same name.
namespace tumble::scenarios {

/// The stages of the map's method: its own, then those of `position`. Their names differ.
std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position);

/// The numbers among `parameters` that are the position method's.
sim::Values values_of(const Method& position, const sim::Values& parameters);

}  // namespace tumble::scenarios
