// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "scenarios/summary/sensitivity.hpp"

namespace tumble::tools {

std::string sensitivity_html(const std::vector<scenarios::Sensitivity>& rows, const std::string& note);

std::string draws_needed_text(const std::map<std::string, std::int64_t>& draws);

}  // namespace tumble::tools
