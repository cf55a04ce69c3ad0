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
  std::string metric;  ///< metric of the method's kind that measures the effect of an input
  std::string words;   ///< options that select method and failure criterion, in the command for one run
  scenarios::SuiteTriageOptions options;
  std::filesystem::path database;  ///< if set: only runs on which the method failed in this database
};

int run_suite_triage(const Session& session, SuiteTriage asked);

}  // namespace tumble::tools
