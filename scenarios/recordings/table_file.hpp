// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

/// A text file of numbers, one row a line: TUM (blanks, no header) or CSV (commas, one header line). Numbers are
/// written with as many digits as a double needs to come back the same; time stamps as seconds with nine decimals or as
/// integers.
class TableWriter {
 public:
  /// `header` empty: none is written. Throws BadInput when the file cannot be opened. What stands there stays until
  /// `close`; a table that is not closed leaves nothing.
  TableWriter(const std::filesystem::path& path, char separator, const std::string& header);
  void integer(std::int64_t value);
  void number(double value);
  void time_s(std::int64_t time_ns);  ///< exact: "12.000000345"
  void end_row();
  /// Moves the whole table into its place; throws BadInput when anything could not be written.
  void close();

 private:
  void cell(const std::string& text);
  void flush();
  OutputFile file_;
  std::string text_;  ///< not yet written
  char separator_;
  bool row_empty_ = true;
};

/// Rows of text cells, checked for their number. Lines that are empty or begin with '#' are skipped.
/// Throws BadInput with path and line number.
struct Table {
  struct Row {
    int line;
    std::vector<std::string> cells;
  };
  std::filesystem::path path;
  std::vector<Row> rows;

  static Table read(const std::filesystem::path& path, char separator, const std::string& header, std::size_t columns);

  double number(const Row& row, std::size_t column) const;  ///< any double, "nan" too
  std::int64_t integer(const Row& row, std::size_t column) const;
  std::int64_t time_ns(const Row& row,
                       std::size_t column) const;  ///< decimal seconds, rounded to nanoseconds without a detour
};

}  // namespace tumble::scenarios
