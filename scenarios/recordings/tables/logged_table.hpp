// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/tables/csv_text.hpp"

namespace tumble::scenarios {

/// Empty lines, comments and an empty field after the last separator of a line are skipped. The header of a table is
/// the first line that is no comment and contains fewer numbers than other texts. If samples directly follow comments,
/// the last comment is the header if it has as many fields as a sample ("#timestamp [ns],w_RS_S_x [rad s^-1],...").
class LoggedTable {
 public:
  explicit LoggedTable(const std::filesystem::path& path);
  LoggedTable(const LoggedTable&) = delete;
  LoggedTable& operator=(const LoggedTable&) = delete;

  const CsvLine& header() const { return header_; }
  bool has_header() const { return has_header_; }

  /// Throws BadInput with file and line for a wrong number of fields, or for a last line without newline; the caller
  /// can then continue.
  bool next(CsvLine& line);
  bool next_sound(CsvLine& line);
  void restart() { text_.back_to(samples_); }
  void keep(std::size_t column, const std::string& value) { kept_ = {column, value}; }

 private:
  struct Kept {
    std::size_t column = 0;
    std::string value;
  };
  void add_units(const CsvLine& units);
  CsvText text_;
  CsvLine header_;
  std::vector<std::string> names_;  ///< column names with units, if units were added
  CsvText::Place samples_;
  bool has_header_ = true;
  std::optional<Kept> kept_;
};

}  // namespace tumble::scenarios
