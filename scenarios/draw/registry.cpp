// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/draw/registry.hpp"

#include <algorithm>

namespace tumble::scenarios {

const sim::ComponentType* find_type(std::span<const sim::ComponentType> types, const std::string& name) {
  const auto found = std::find_if(types.begin(), types.end(), [&](const auto& type) { return type.name == name; });
  return found == types.end() ? nullptr : &*found;
}

const sim::Parameter* find_parameter(std::span<const sim::Parameter> parameters, const std::string& name) {
  const auto found = std::find_if(parameters.begin(), parameters.end(), [&](const auto& p) { return p.name == name; });
  return found == parameters.end() ? nullptr : &*found;
}

std::vector<std::string> names_of(std::span<const sim::ComponentType> types) {
  std::vector<std::string> names;
  for (const sim::ComponentType& type : types) names.push_back(type.name);
  return names;
}

std::vector<std::string> names_of(std::span<const sim::Parameter> parameters) {
  std::vector<std::string> names;
  for (const sim::Parameter& parameter : parameters) names.emplace_back(parameter.name);
  return names;
}

}  // namespace tumble::scenarios
