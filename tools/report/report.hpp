// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/results.hpp"
#include "tools/report/page.hpp"

namespace tumble::tools {

struct ReportInput {
  const scenarios::Results* results = nullptr;
  const scenarios::Summary* summary = nullptr;
  std::span<const scenarios::DrawValues> draws;
  std::vector<Curve> curves;
  std::vector<Spread> motions;
  std::vector<scenarios::Sensitivity> sensitivity;
  std::string sensitivity_note;  ///< which runs were used, or why there is no sensitivity
};

struct ReportOptions {
  std::filesystem::path database;  ///< path of the results; examples are next to it
  std::filesystem::path page;      ///< path of the page; links to replays are relative to it
  std::string version;             ///< version of the program
  std::string data;                ///< digest of the models and scenarios on this machine; may be empty
  std::string made_at;             ///< date and time on the page
};

/// Computes the content of the page from the results, and from the examples that a sweep stored next to them; nothing
/// is simulated or estimated.
PageContent report_content(ReportInput input, const ReportOptions& options);

}  // namespace tumble::tools
