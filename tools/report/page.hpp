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
#include "tools/report/cost_html.hpp"
#include "tools/report/curves.hpp"
#include "tools/report/distributions.hpp"
#include "tools/report/failures.hpp"
#include "tools/report/plots.hpp"

namespace tumble::tools {

struct ShownExample {
  Example example;
  bool of_these_results = false;  ///< agrees with the database
  std::string replay_address;     ///< relative to the page; may be empty
};

using Fact = std::pair<std::string, std::string>;

struct PageContent {
  std::string title;
  bool recorded = false;  ///< recordings instead of simulated runs
  scenarios::Summary summary;
  scenarios::Comparison comparison;    ///< with the reference methods
  std::vector<ShownExample> examples;  ///< single runs with pictures and plots
  scenarios::MotionMap motion_map;     ///< covers all runs, like `motions`
  std::vector<Spread> motions;
  Palette palette;             ///< colours of the methods in all figures
  std::vector<Figure> errors;  ///< errors of all runs
  Figure cost;
  std::vector<CostRow> costs;
  std::vector<Curve> curves;
  FailedDraws failed;
  std::vector<scenarios::RejectedDraw> rejected;
  std::vector<scenarios::Sensitivity> sensitivity;
  std::string sensitivity_note;  ///< used runs, or reason for absence
  std::vector<scenarios::Certificate> certificates;
  std::vector<Fact> methods;          ///< name and description of each method
  std::vector<Fact> versions;         ///< suite, runs, builds, data, date
  std::vector<Fact> commands;         ///< purpose and command
  std::vector<std::string> warnings;  ///< missing content, and the reason
};

/// Returns one self-contained page with styles, plots, pictures and the Plotly bundle inside. The Content Security
/// Policy of the page forbids network access.
std::string page_html(const PageContent& content, const std::string& plotly_bundle);

}  // namespace tumble::tools
