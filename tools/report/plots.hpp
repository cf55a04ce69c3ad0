// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"
#include "tools/examples/example.hpp"
#include "tools/pictures/colours.hpp"

namespace tumble::tools {

/// A Plotly figure: what page.js hands to Plotly. Colours of text and grid are the page's, set by page.js.
struct Figure {
  std::string id;       ///< of its element, unique in the page
  std::string caption;  ///< one or two sentences
  std::string traces;   ///< JSON, an array; empty when there is nothing to draw
  std::string layout;   ///< JSON, an object
  bool empty() const { return traces.empty(); }
};

/// What Plotly draws, of which no traces are nothing. What is no UTF-8 in a text is replaced.
void set_plot(const nlohmann::json& traces, const nlohmann::json& layout, Figure& figure);

/// So many draws of a box are drawn as points, however many there are.
inline constexpr std::size_t kBoxPoints = 1000;

/// Five significant digits are more than a plot can show, and keep the page small.
double five_digits(double value);

/// A text as Plotly shows it, which reads tags and three entities in it: & < > by their entities.
std::string plot_text(const std::string& text);

/// Of more than `most` (2 or more) values the smallest, the largest and those at equal steps of rank between, rising:
/// their quantiles are nearly those of all. O(n log n).
std::vector<double> at_most(std::vector<double> values, std::size_t most);

/// Every draw as a point beside a box of quartiles: one box per method and scenario, at most `kBoxPoints` in a box.
/// Logarithmic where values are positive and span more than a decade.
Figure box_figure(const scenarios::Summary& summary, scenarios::Kind kind, const std::string& metric,
                  const std::string& caption);

/// CPU time of every method, one box per method and scenario, logarithmic.
Figure cost_figure(const scenarios::Summary& summary);

/// A plot of an example.
Figure figure_of(const Plot& plot, const std::string& id);

/// Of a line of an example's plot, and of its name in a legend.
Colour colour_of(int colour);

/// By the round of the colours (`colour_round`): a marker, a line, and how much of the colour fills a box.
const char* symbol_of_round(std::size_t round);
const char* dash_of_round(std::size_t round);
double filling_of_round(std::size_t round);

}  // namespace tumble::tools
