// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tools/report/example.hpp"
#include "tools/report/summary.hpp"

namespace tumble::tools {

/// A Plotly figure: what page.js hands to Plotly. Colours of text and grid are the page's, set by page.js.
struct Figure {
  std::string id;       ///< of its element, unique in the page
  std::string caption;  ///< one or two sentences
  nlohmann::json data = nlohmann::json::array();
  nlohmann::json layout = nlohmann::json::object();
  bool empty() const { return data.empty(); }
};

/// Every draw as a point beside a box of quartiles: one box per method and scenario. Logarithmic where values are
/// positive and span more than a decade.
Figure box_figure(const Summary& summary, scenarios::Kind kind, const std::string& metric, const std::string& caption);

/// CPU time of every method, one box per method and scenario, logarithmic.
Figure cost_figure(const Summary& summary);

/// Rate about the sensor axis that clips most, over the moving part: the truth, the gyro, and each rate method's
/// answer. Empty when the recording has no clipped sample.
Figure rate_figure(const Example& example);

/// The way seen from above, at equal scales: the truth and each method's path.
Figure path_figure(const Example& example);

}  // namespace tumble::tools
