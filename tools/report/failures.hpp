// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>
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
};

struct FailedDraws {
  std::size_t draws = 0;          ///< in all
  std::vector<FailedDraw> shown;  ///< those on which most methods failed, at most `kFailedDrawsShown`
};

/// What failed, its messages read for the draws shown alone.
FailedDraws failed_draws(const scenarios::Results& results, const scenarios::Summary& summary);

}  // namespace tumble::tools
