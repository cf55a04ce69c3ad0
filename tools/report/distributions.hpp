// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/motion_spreads.hpp"
#include "tools/report/plots.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

using scenarios::Spread;

std::vector<Figure> distribution_figures(std::span<const Spread> spreads);
std::string distributions_html(std::span<const Spread> spreads, std::span<const Figure> figures);
Table distribution_table(std::span<const Spread> spreads);
nlohmann::json distributions_json(std::span<const Spread> spreads);

}  // namespace tumble::tools
