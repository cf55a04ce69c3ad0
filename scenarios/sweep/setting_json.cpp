// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/sweep/setting_json.hpp"

#include <nlohmann/json.hpp>
#include <string>

namespace tumble::scenarios {

nlohmann::json to_json(const Setting& setting) {
  return nlohmann::json::array({setting.key, setting.value});
}

Setting setting_from(const nlohmann::json& pair) {
  return {pair.at(0).get<std::string>(), pair.at(1).get<double>()};
}

}  // namespace tumble::scenarios
