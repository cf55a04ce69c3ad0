// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/results.hpp"
#include "tools/report/page.hpp"

namespace tumble::tools {

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
PageContent report_content(const scenarios::Results& results, const scenarios::Summary& summary,
                           const ReportOptions& options);

}  // namespace tumble::tools
