// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"
#include "tools/examples/example.hpp"
#include "tools/pictures/colours.hpp"

namespace tumble::tools {

struct Figure {
  std::string id;       ///< HTML id, unique within the page
  std::string caption;  ///< one or two sentences
  std::string traces;   ///< JSON array; may be empty
  std::string layout;   ///< JSON object
  bool empty() const { return traces.empty(); }
};

void set_plot(const nlohmann::json& traces, const nlohmann::json& layout, Figure& figure);

/// Maximum number of runs of a box plot that are drawn as points
inline constexpr std::size_t kBoxPoints = 1000;

/// Five significant digits are finer than a plot can show, and keep the page small.
double five_digits(double value);

/// Plotly interprets some tags in texts, so the characters & < > are escaped.
std::string plot_text(const std::string& text);

std::vector<double> at_most(std::vector<double> values, std::size_t most);

/// Palette assigns one colour index to each method of a page, in the order of `add`; methods of different kinds with
/// the same name share a colour.
class Palette {
 public:
  void add(const std::string& method, std::optional<std::size_t> wanted = {});
  std::size_t index(const std::string& method, std::size_t otherwise) const;

 private:
  std::map<std::string, std::size_t> indices_;
};

/// Returns the title with the display unit of the metric: "attitude rmse [°]"; the name of a scenario parameter is
/// unchanged.
std::string axis_title(const std::string& metric);

/// Failed runs are points on the line "failed", beyond the worst value, so the quartiles count them as in the tables.
Figure box_figure(const scenarios::Summary& summary, scenarios::Kind kind, const std::string& metric,
                  const std::string& caption, const Palette& palette = {});

Figure cost_figure(const scenarios::Summary& summary, const Palette& palette = {});

Figure figure_of(const Plot& plot, const std::string& id, const Palette& palette = {});

Colour colour_of(int colour);

const char* symbol_of_round(std::size_t round);
const char* dash_of_round(std::size_t round);
double filling_of_round(std::size_t round);

}  // namespace tumble::tools
