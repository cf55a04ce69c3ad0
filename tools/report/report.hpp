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

/// What a page says about, read once.
struct ReportInput {
  const scenarios::Results* results = nullptr;
  const scenarios::Summary* summary = nullptr;
  std::span<const scenarios::DrawValues> draws;
  std::vector<Curve> curves;
  std::vector<Spread> motions;
  std::vector<scenarios::Sensitivity> sensitivity;
  std::string sensitivity_note;  ///< of which draws it is, or why there is none
};

struct ReportOptions {
  std::filesystem::path database;  ///< that the results were read from; its examples stand beside it
  std::filesystem::path page;      ///< where the page will stand: its links lead to replays from there
  std::string version;             ///< of the program
  std::string data;                ///< digest of the models and scenarios that a sweep would find here; "" when none
  std::string made_at;             ///< date and time, as the page shall show it
};

/// All that the page says: a function of the results and of the examples that a sweep has left beside them. Nothing is
/// simulated or estimated here. Where there are no examples the page says which command makes them, or which build or
/// data it needs.
PageContent report_content(ReportInput input, const ReportOptions& options);

}  // namespace tumble::tools
