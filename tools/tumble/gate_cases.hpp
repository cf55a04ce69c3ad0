// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scenarios/data_root.hpp"
#include "tools/tumble/session.hpp"

/// The gate of the named cases, scenarios/regressions.
namespace tumble::tools {

/// All cases of the tree, as the gate is asked for them.
inline constexpr const char* kAllCases = "regressions";

/// Whether the word is that, or the name of a case.
bool names_cases(const scenarios::DataRoot& data, const std::string& word);

/// Refuses what is neither that, nor a suite, a suite file or a scenario.
std::function<void(const std::string&)> a_suite_or_cases(const Session& session);

struct CaseGate {
  std::string word;  ///< `kAllCases`, or the name of one
  int jobs = 1;
  std::filesystem::path database;  ///< empty: a temporary file
  bool accept = false;             ///< writes what was reached into the cases' files
};

/// Runs the cases and holds them to what they expect (scenarios/cases/hold_case.hpp); returns the exit status.
int hold_cases(const Session& session, const scenarios::DataRoot& data, const CaseGate& gate);

}  // namespace tumble::tools
