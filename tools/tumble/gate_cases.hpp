// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scenarios/data_root.hpp"
#include "tools/tumble/session.hpp"

/// hold_cases implements the gate of the named cases in scenarios/regressions.
namespace tumble::tools {

/// Word on the command line that selects all named cases of the source tree.
inline constexpr const char* kAllCases = "regressions";

/// Returns true if `word` is kAllCases or the name of a case.
bool names_cases(const scenarios::DataRoot& data, const std::string& word);

/// Returns a check that accepts cases, suites, suite files and scenarios.
std::function<void(const std::string&)> a_suite_or_cases(const Session& session);

struct CaseGate {
  std::string word;  ///< `kAllCases`, or the name of a case
  int jobs = 1;
  std::filesystem::path database;  ///< empty: a temporary file
  bool accept = false;             ///< write the outcomes to the files of the cases as new expectations
};

/// Runs the cases and compares the outcomes with the expectations (scenarios/cases/hold_case.hpp). Returns the exit
/// status of the program.
int hold_cases(const Session& session, const scenarios::DataRoot& data, const CaseGate& gate);

}  // namespace tumble::tools
