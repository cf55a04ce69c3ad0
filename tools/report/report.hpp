// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "scenarios/data_root.hpp"
#include "scenarios/sweep/results.hpp"
#include "tools/report/page.hpp"

namespace tumble::tools {

struct ReportOptions {
  scenarios::DataRoot data;
  std::string version;                         ///< of the program
  std::string made_at;                         ///< date and time, as the page shall show it
  int threads = 1;                             ///< for the examples' lidar
  int examples_max = 3;                        ///< draws run again for pictures; 0 for none
  std::function<void(std::string_view)> note;  ///< what is being done; may be empty
};

/// All that the page says. One draw of a rig and up to two of a sphere are simulated again; one that cannot be leaves a
/// warning in the page and the rest of it whole.
PageContent report_content(const scenarios::Results& results, const Summary& summary, const ReportOptions& options);

}  // namespace tumble::tools
