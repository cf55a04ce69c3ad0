// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "scenarios/sweep/outcome.hpp"

/// A setting as a pair of JSON: its key and its value. Private to scenarios/sweep.
namespace tumble::scenarios {

inline nlohmann::json to_json(const Setting& setting) {
  return nlohmann::json::array({setting.key, setting.value});
}

inline Setting setting_from(const nlohmann::json& pair) {
  return {pair.at(0).get<std::string>(), pair.at(1).get<double>()};
}

}  // namespace tumble::scenarios
