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

/// ExitStatus lists the exit statuses of the program (docs/design.md, "The program").
enum ExitStatus { kDone = 0, kCheckFailed = 1, kBadInput = 2, kDefect = 3 };

/// TableFormat is the output format of tables: for the terminal, for documents, or for other programs.
enum class TableFormat { text, markdown, csv, tex };

/// Session is the context of every verb: output options and the location of the project's files.
class Session {
 public:
  bool json = false;   ///< tables as JSON
  bool quiet = false;  ///< no notes and no progress
  TableFormat format = TableFormat::text;

  /// Returns the folder with models, catalogue and suites: $TUMBLE_DATA if set, else share/tumble next to the program's
  /// folder, else the source tree of the build. Throws BadInput if no folder contains models.
  scenarios::DataRoot data() const;

  /// Returns the path of the Plotly bundle next to the data. Throws BadInput with instructions if it is missing.
  std::filesystem::path plotly() const;

  /// Returns the path of this program, for starting it again. Throws BadInput if the system does not provide it.
  std::filesystem::path program() const;

  /// Returns the folder for cached measurements: $TUMBLE_CACHE, else $XDG_CACHE_HOME/tumble, else ~/.cache/tumble;
  /// empty if no variable is set.
  std::filesystem::path cache() const;

  /// Prints a line to standard error, unless quiet.
  void note(std::string_view line) const;

  /// Prints tables to standard output; with --json, prints `document` instead. Throws BadInput if standard output
  /// cannot be written.
  void print(const std::vector<Table>& tables, const nlohmann::json& document) const;
};

/// Returns the version of the program, for example "0.1.0".
std::string program_version();

}  // namespace tumble::tools
