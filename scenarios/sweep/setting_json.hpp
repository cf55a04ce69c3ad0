// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

nlohmann::json to_json(const Setting& setting);
Setting setting_from(const nlohmann::json& pair);

}  // namespace tumble::scenarios
