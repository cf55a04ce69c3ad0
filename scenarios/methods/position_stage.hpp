// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

#include "scenarios/methods/method.hpp"
#include "scenarios/methods/settings.hpp"

namespace tumble::scenarios {

std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position);

sim::Values values_of(const Method& position, const sim::Values& parameters);

}  // namespace tumble::scenarios
