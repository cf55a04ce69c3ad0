// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/sweep/suite_triage.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

struct SuiteTriage {
  scenarios::Suite suite;
  scenarios::MethodPointer method;
  std::string metric;  ///< measures an input's effect
  std::string words;   ///< options for the printed command
  scenarios::SuiteTriageOptions options;
  std::filesystem::path database;  ///< only runs that failed there
};

int run_suite_triage(const Session& session, SuiteTriage asked);

}  // namespace tumble::tools
