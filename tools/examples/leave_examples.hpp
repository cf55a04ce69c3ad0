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
  std::size_t failures = 8;                    ///< with failed methods
  int jobs = 1;                                ///< number of parallel processes
  const std::atomic<bool>* stop = nullptr;     ///< existing examples are kept
  std::function<void(std::string_view)> note;  ///< receives progress messages; may be empty
};

bool leave_examples(const scenarios::DataRoot& data, const scenarios::Suite& suite,
                    const std::filesystem::path& database, const LeaveOptions& options);

}  // namespace tumble::tools
