// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

#include "scenarios/sweep/suite_triage.hpp"
#include "tools/tumble/session.hpp"

/// The function run_suite_triage runs the triage over all simulated runs of a suite.
namespace tumble::tools {

struct SuiteTriage {
  scenarios::Suite suite;
  scenarios::MethodPointer method;
  std::string metric;  ///< metric of the method's kind by which inputs are compared
  std::string words;   ///< options that select the method and the criterion of failure in the command for one draw
  scenarios::SuiteTriageOptions options;
  std::filesystem::path database;  ///< if not empty: only draws on which the method failed in this database
};

/// Runs the triage, prints the effect of each input and names the most important input. Returns the exit status of the
/// program.
int run_suite_triage(const Session& session, SuiteTriage asked);

}  // namespace tumble::tools
