// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scenarios/certificate/certificate.hpp"
#include "scenarios/summary/comparison.hpp"
#include "scenarios/summary/motion_map.hpp"
#include "scenarios/summary/sensitivity.hpp"
#include "scenarios/summary/summary.hpp"
#include "tools/examples/example.hpp"
#include "tools/report/curves.hpp"
#include "tools/report/distributions.hpp"
#include "tools/report/failures.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

/// An example as the page shows it.
struct ShownExample {
  Example example;
  bool of_these_results = false;  ///< made of the rows that the database holds, its recording of their digest
  std::string replay_address;     ///< from the page to its replay, ready for an attribute; "": there is none
};

/// Name and value.
using Fact = std::pair<std::string, std::string>;

/// What a report page says; `page_html` adds nothing to it.
struct PageContent {
  std::string title;
  bool recorded = false;  ///< results of recordings, not of draws
  scenarios::Summary summary;
  scenarios::Comparison comparison;    ///< with the baselines, by the headline metrics
  std::vector<ShownExample> examples;  ///< single draws, with pictures and plots
  scenarios::MotionMap motion_map;     ///< of all draws, as the next
  std::vector<Spread> motions;
  std::vector<Figure> errors;  ///< of all draws
  Figure cost;
  std::vector<Curve> curves;
  FailedDraws failed;
  std::vector<scenarios::RejectedDraw> rejected;
  std::vector<scenarios::Sensitivity> sensitivity;
  std::string sensitivity_note;  ///< of which draws it is, or why there is none
  std::vector<scenarios::Certificate> certificates;
  std::vector<Fact> methods;          ///< each, and what it is
  std::vector<Fact> versions;         ///< suite, draws, builds, data, date
  std::vector<Fact> commands;         ///< what it does, and the command that does it again
  std::vector<std::string> warnings;  ///< what is missing, and why
};

/// One self-contained page: styles, plots, pictures and the text of the Plotly bundle inside; it asks the network
/// nothing, which a Content Security Policy of its own forbids besides. The first screen; then motions, errors, paired
/// differences, failures, sensitivity, cost, certificate, versions, commands, in this order. Every text is data in it,
/// never markup.
std::string page_html(const PageContent& content, const std::string& plotly_bundle);

}  // namespace tumble::tools
