// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "scenarios/summary/summary.hpp"
#include "scenarios/sweep/results.hpp"

/// Draws on which methods failed, and how to see them.
namespace tumble::tools {

/// So many stand on the page.
inline constexpr std::size_t kFailedDrawsShown = 60;

struct FailedRun {
  std::string method;   ///< kind/name
  std::string status;   ///< "diverged"
  std::string message;  ///< one line; may be empty
  std::string command;  ///< runs it again (run_again.hpp)
};

/// A draw with what failed on it.
struct FailedDraw {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<FailedRun> runs;
  std::string replay_command;  ///< makes a replay of what `sweep --keep` has kept of it; "": nothing is kept
};

struct FailedDraws {
  std::size_t draws = 0;          ///< in all
  std::vector<FailedDraw> shown;  ///< those on which most methods failed, at most `kFailedDrawsShown`
};

/// What failed, its messages read for the draws shown alone; `database` is where the results stand, and beside it what
/// is kept.
FailedDraws failed_draws(const scenarios::Results& results, const scenarios::Summary& summary,
                         const std::filesystem::path& database);

}  // namespace tumble::tools
