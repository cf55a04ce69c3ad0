// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/recordings/tables/csv_text.hpp"

/// Reads text tables of loggers: IMU readings and poses. Used only within scenarios/recordings.
namespace tumble::scenarios {

/// A table of samples below an optional header. Comments (csv_text.hpp) are skipped, and also an empty field after the
/// last separator of a line. The header is the first line that is no comment and has fewer numbers than other texts. If
/// the samples follow comments directly, the last comment is the header, provided that it has as many fields as a
/// sample ("#timestamp [ns],w_RS_S_x [rad s^-1],..."). A row of units below the header is added to the names in
/// brackets.
class LoggedTable {
 public:
  /// Throws BadInput like CsvText.
  explicit LoggedTable(const std::filesystem::path& path);
  LoggedTable(const LoggedTable&) = delete;
  LoggedTable& operator=(const LoggedTable&) = delete;

  /// Returns the names of the columns. If the table has no header, returns the fields of the first sample.
  const CsvLine& header() const { return header_; }
  bool has_header() const { return has_header_; }

  /// Reads the next sample. Returns false at the end. Throws BadInput with file and line for a wrong number of fields.
  bool next(CsvLine& line);
  /// Continues at the first sample.
  void restart() { text_.back_to(samples_); }
  /// After this call, `next` only returns samples with the text `value` in the column.
  void keep(std::size_t column, const std::string& value) { kept_ = {column, value}; }

 private:
  struct Kept {
    std::size_t column = 0;
    std::string value;
  };
  void add_units(const CsvLine& units);
  CsvText text_;
  CsvLine header_;
  std::vector<std::string> names_;  ///< text of the header's fields if units were added
  CsvText::Place samples_;
  bool has_header_ = true;
  std::optional<Kept> kept_;
};

}  // namespace tumble::scenarios
