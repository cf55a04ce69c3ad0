// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/position_stage.hpp"

#include <string>

namespace tumble::scenarios {

std::vector<const SettingsTable*> stages_after(std::vector<const SettingsTable*> own, const Method& position) {
  own.insert(own.end(), position.info.settings.begin(), position.info.settings.end());
  return own;
}

sim::Values values_of(const Method& position, const sim::Values& parameters) {
  sim::Values own;
  for (const sim::Parameter& each : position.info.parameters) {
    const std::string name(each.name);
    if (parameters.has(name)) own.set(name, parameters.at(name));
  }
  return own;
}

}  // namespace tumble::scenarios
