// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/data_root.hpp"
#include "tools/tables/table.hpp"

namespace tumble::tools {

enum ExitStatus { kDone = 0, kCheckFailed = 1, kBadInput = 2, kDefect = 3 };

enum class TableFormat { text, markdown, csv, tex };

class Session {
 public:
  bool json = false;   ///< tables as JSON
  bool quiet = false;  ///< no notes and no progress
  TableFormat format = TableFormat::text;

  /// Returns $TUMBLE_DATA if set, else share/tumble next to the program's folder, else the source tree of the build.
  scenarios::DataRoot data() const;

  std::filesystem::path plotly() const;

  std::filesystem::path program() const;

  /// Returns $TUMBLE_CACHE, else $XDG_CACHE_HOME/tumble, else ~/.cache/tumble; empty if no variable is set.
  std::filesystem::path cache() const;

  void note(std::string_view line) const;

  void print(const std::vector<Table>& tables, const nlohmann::json& document) const;
};

std::string program_version();

/// Invalid UTF-8 and control characters (C0 except line ends, DEL, C1) become '?', because names in files and paths
/// could otherwise move the cursor.
std::string terminal_text(std::string_view text);

}  // namespace tumble::tools
