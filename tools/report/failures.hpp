// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/results.hpp"

/// The functions in failures.hpp list the simulated runs on which methods failed, with commands to repeat the runs.
namespace tumble::tools {

/// kFailedDrawsShown is the maximum number of failed runs on the page.
inline constexpr std::size_t kFailedDrawsShown = 60;

struct FailedRun {
  std::string method;   ///< kind/name
  std::string status;   ///< for example "diverged"
  std::string message;  ///< one line; may be empty
  std::string command;  ///< command that runs it again (run_again.hpp)
};

/// FailedDraw is a run with the methods that failed on it.
struct FailedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<FailedRun> runs;
  std::string replay_command;  ///< creates a replay from data that `sweep --keep` stored; empty if nothing is stored
};

struct FailedDraws {
  std::size_t draws = 0;          ///< total number of failed draws
  std::vector<FailedDraw> shown;  ///< draws with the most failed methods, at most `kFailedDrawsShown`
};

/// Finds the failed runs, and reads messages only for the runs that are shown. The argument `database` is the path of
/// the results; kept files are next to the database.
FailedDraws failed_draws(const scenarios::Results& results, const scenarios::Summary& summary,
                         const std::filesystem::path& database);

}  // namespace tumble::tools
