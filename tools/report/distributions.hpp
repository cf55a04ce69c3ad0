// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/motion_spreads.hpp"
#include "tools/report/plots.hpp"
#include "tools/tables/table.hpp"

/// distributions.hpp shows distributions of the simulated motions, compared with the published experiment with the
/// tumbling rig.
namespace tumble::tools {

using scenarios::Spread;

/// Returns one figure per quantity: histograms in one colour per scenario, with the published range shaded.
std::vector<Figure> distribution_figures(std::span<const Spread> spreads);
std::string distributions_html(std::span<const Spread> spreads, std::span<const Figure> figures);
Table distribution_table(std::span<const Spread> spreads);
/// Returns the distributions in SI units.
nlohmann::json distributions_json(std::span<const Spread> spreads);

}  // namespace tumble::tools
