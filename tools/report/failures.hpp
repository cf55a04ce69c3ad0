// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/results.hpp"

namespace tumble::tools {

inline constexpr std::size_t kFailedDrawsShown = 60;

struct FailedRun {
  std::string method;   ///< kind/name
  std::string status;   ///< for example "diverged"
  std::string message;  ///< one line; may be empty
  std::string command;  ///< repeats the run (run_again.hpp)
};

struct FailedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<FailedRun> runs;
  std::string replay_command;  ///< replay of stored data; may be empty
};

struct FailedDraws {
  std::size_t draws = 0;          ///< total number of failed runs
  std::vector<FailedDraw> shown;  ///< at most `kFailedDrawsShown`
};

FailedDraws failed_draws(const scenarios::Results& results, const scenarios::Summary& summary,
                         const std::filesystem::path& database);

}  // namespace tumble::tools
