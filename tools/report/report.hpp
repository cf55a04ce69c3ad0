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
  std::string sensitivity_note;  ///< used runs, or reason for absence
};

struct ReportOptions {
  std::filesystem::path database;  ///< examples are next to it
  std::filesystem::path page;      ///< links to replays are relative
  std::string version;             ///< version of the program
  std::string data;                ///< models and scenarios; may be empty
  std::string made_at;             ///< date and time on the page
};

/// Uses only stored results and stored examples; nothing is simulated or estimated.
PageContent report_content(ReportInput input, const ReportOptions& options);

}  // namespace tumble::tools
