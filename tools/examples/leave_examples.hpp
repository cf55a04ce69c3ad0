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
  std::size_t count = 3;                       ///< typical draws, at most
  std::size_t failures = 8;                    ///< draws on which methods failed, at most
  int jobs = 1;                                ///< processes
  const std::atomic<bool>* stop = nullptr;     ///< set it to end; what stood there stays
  std::function<void(std::string_view)> note;  ///< what is being done; may be empty
};

/// Leaves examples beside the results of a sweep (examples_folder): typical draws of the suite's scenarios
/// (choose_examples), run again with the methods that have come to an end on them, and draws on which methods failed
/// (choose_failures), the first of them likewise, the others with what failed and what should not have
/// (failure_example_of); each in a process of its own. What is there of the same rows, or of scenarios
/// outside the suite, stays as it is. A draw that cannot be shown costs a note. Does nothing for recordings. Returns
/// false when it was stopped. Throws BadInput when the folder cannot be written.
bool leave_examples(const scenarios::DataRoot& data, const scenarios::Suite& suite,
                    const std::filesystem::path& database, const LeaveOptions& options);

}  // namespace tumble::tools
