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

/// The program's exit statuses (docs/design.md, "The program").
enum ExitStatus { kDone = 0, kCheckFailed = 1, kBadInput = 2, kDefect = 3 };

/// How tables are written: for the terminal, or for documents and other programs.
enum class TableFormat { text, markdown, csv, tex };

/// What every verb is given: how to speak, and where the project's files are.
class Session {
 public:
  bool json = false;   ///< tables as JSON
  bool quiet = false;  ///< no notes and no progress
  TableFormat format = TableFormat::text;

  /// Models, catalogue and suites: $TUMBLE_DATA, else share/tumble beside the program's folder, else the source tree
  /// that it was built from. Throws BadInput when none of them holds models.
  scenarios::DataRoot data() const;

  /// The Plotly bundle, looked for beside the data. Throws BadInput that says how to get it.
  std::filesystem::path plotly() const;

  /// The program's own file, to be started anew. Throws BadInput when the system does not tell.
  std::filesystem::path program() const;

  /// Where the program may keep what it has measured: $TUMBLE_CACHE, else $XDG_CACHE_HOME/tumble, else ~/.cache/tumble;
  /// empty when none of them is set.
  std::filesystem::path cache() const;

  /// One line to standard error, unless quiet.
  void note(std::string_view line) const;

  /// Tables to standard output, or, with --json, `document` alone. Throws BadInput when standard output takes no more.
  void print(const std::vector<Table>& tables, const nlohmann::json& document) const;
};

/// Version of the program ("0.1.0").
std::string program_version();

}  // namespace tumble::tools
