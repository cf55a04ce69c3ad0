// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "scenarios/data_root.hpp"
#include "tools/tumble/session.hpp"

namespace tumble::tools {

inline constexpr const char* kAllCases = "regressions";

bool names_cases(const scenarios::DataRoot& data, const std::string& word);

std::function<void(const std::string&)> a_suite_or_cases(const Session& session);

struct CaseGate {
  std::string word;  ///< `kAllCases`, or a case
  int jobs = 1;
  std::filesystem::path database;  ///< empty: a temporary file
  bool accept = false;             ///< outcomes become expectations
};

int hold_cases(const Session& session, const scenarios::DataRoot& data, const CaseGate& gate);

}  // namespace tumble::tools
