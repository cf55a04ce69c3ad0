// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <atomic>
#include <filesystem>
#include <functional>
#include <string_view>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/sweep.hpp"

namespace tumble::tools {

struct LeaveOptions {
  std::size_t count = 3;                       ///< maximum number of typical runs
  std::size_t failures = 8;                    ///< maximum number of runs with failed methods
  int jobs = 1;                                ///< number of parallel processes
  const std::atomic<bool>* stop = nullptr;     ///< stops the generation; existing examples are kept
  std::function<void(std::string_view)> note;  ///< receives progress messages; may be empty
};

/// Generates examples next to the results of a sweep (see `examples_folder`), each in a separate process.
/// - Typical runs of the suite's scenarios (`choose_examples`) are repeated with the methods that succeeded on them.
/// - Of the runs on which methods failed (`choose_failures`), the first is repeated with all methods that succeeded.
///   The further failed runs show the failed methods, and `tumble` of the same kinds (`failure_example_of`).
///
/// An existing example is kept if it matches the results, or if its scenario is not in the suite. A run that cannot be
/// shown is reported in a note. The function does nothing for recordings. Returns false if the generation was stopped.
/// Throws BadInput if the folder cannot be written.
bool leave_examples(const scenarios::DataRoot& data, const scenarios::Suite& suite,
                    const std::filesystem::path& database, const LeaveOptions& options);

}  // namespace tumble::tools
