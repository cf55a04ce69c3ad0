// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sim/parameters.hpp"

namespace tumble::sim {

template <typename Type>
const Type& find_entry(std::span<const Type* const> registry, std::string_view name, const std::string& what) {
  std::vector<std::string> names;
  for (const Type* entry : registry) {
    if (entry->component.name == name) return *entry;
    names.push_back(entry->component.name);
  }
  const std::string near = did_you_mean(name, names);
  throw InvalidSituation(what + ": unknown type '" + std::string(name) + "'" + (near.empty() ? "" : "; " + near));
}

template <typename Type>
std::vector<ComponentType> components(std::span<const Type* const> registry) {
  std::vector<ComponentType> list;
  for (const Type* entry : registry) list.push_back(entry->component);
  return list;
}

}  // namespace tumble::sim
