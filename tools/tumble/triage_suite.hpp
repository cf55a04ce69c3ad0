// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/sweep/suite_triage.hpp"
#include "tools/tumble/session.hpp"

/// Triage over a suite, as the verb has it.
namespace tumble::tools {

struct SuiteTriage {
  scenarios::Suite suite;
  scenarios::MethodPointer method;
  std::string metric;  ///< of the method's kind: what inputs are compared by
  std::string words;   ///< that ask for the method and for what fails, of one draw's command
  scenarios::SuiteTriageOptions options;
  std::filesystem::path database;  ///< not empty: only the draws on which the method failed there
};

/// Runs it, prints what each input is worth, and says which matters most; returns the exit status.
int run_suite_triage(const Session& session, SuiteTriage asked);

}  // namespace tumble::tools
