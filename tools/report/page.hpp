// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/summary/summary.hpp"
#include "tools/examples/example.hpp"
#include "tools/report/curves.hpp"
#include "tools/report/distributions.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

/// An example as the page shows it.
struct ShownExample {
  Example example;
  bool of_these_results = false;  ///< made of the rows that the database holds, its recording of their digest
  std::string replay_address;     ///< from the page to its replay, ready for an attribute; "": there is none
};

/// What a report page says; `page_html` adds nothing to it.
struct PageContent {
  std::string title;
  std::vector<std::pair<std::string, std::string>> facts;  ///< suite, draws, versions, date
  scenarios::Summary summary;
  std::vector<Figure> figures;         ///< of all draws
  std::vector<ShownExample> examples;  ///< single draws, with pictures and plots
  std::vector<Spread> motions;         ///< of all draws
  std::vector<Curve> curves;
  std::vector<scenarios::RejectedDraw> rejected;
  std::vector<scenarios::Certificate> certificates;
  std::vector<std::string> warnings;  ///< what is missing, and why
};

/// One self-contained page: styles, plots, pictures and the text of the Plotly bundle inside; it asks the network
/// nothing.
std::string page_html(const PageContent& content, const std::string& plotly_bundle);

}  // namespace tumble::tools
