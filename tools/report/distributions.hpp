// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "scenarios/sweep/outcome.hpp"
#include "tools/report/plots.hpp"
#include "tools/tumble/table.hpp"

/// What the simulated motions were like, beside the published campaign of the tumbling rig.
namespace tumble::tools {

/// One quantity of one scenario over its draws; a draw without a value (no clipped sample: no share of them) is left
/// out.
struct Spread {
  std::string scenario;
  std::string metric;    ///< "motion_peak_rate_rad_s"
  std::string quantity;  ///< "largest rate"
  std::string unit;
  std::string published;       ///< what the campaign reports; empty when nothing
  double factor = 1.0;         ///< from SI to `unit`
  std::vector<double> values;  ///< SI
  double median = 0, quantile_05 = 0, quantile_95 = 0;
};

/// Quantity by quantity, scenarios in the order of the draws. Of a share of draws ("draws that clip the gyro") the
/// values are 0 or 1, the median is the share and the quantiles are its 95 % interval; so they are of a share of all
/// clipped samples, which weighs each draw by its number of them.
std::vector<Spread> motion_spreads(std::span<const scenarios::DrawValues> draws);

/// A histogram per quantity, one colour per scenario, the published range shaded.
std::vector<Figure> distribution_figures(std::span<const Spread> spreads);
std::string distributions_html(std::span<const Spread> spreads, std::span<const Figure> figures);
Table distribution_table(std::span<const Spread> spreads);
/// In SI units.
nlohmann::json distributions_json(std::span<const Spread> spreads);

}  // namespace tumble::tools
