// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "scenarios/recordings/replace_file.hpp"

namespace tumble::scenarios {

/// TableWriter writes numbers to a TUM file (blanks, no header) or a CSV file (commas, one header line). The text of a
/// double contains enough digits to restore the double exactly.
class TableWriter {
 public:
  /// Only close() replaces an existing file; without a call of close(), the table is discarded.
  TableWriter(const std::filesystem::path& path, char separator, const std::string& header);
  void integer(std::int64_t value);
  void number(double value);
  void time_s(std::int64_t time_ns);  ///< exact: "12.000000345"
  void end_row();
  void close();

 private:
  void cell(const std::string& text);
  void flush();
  OutputFile file_;
  std::string text_;  ///< text that is not yet written
  char separator_;
  bool row_empty_ = true;
};

/// Table contains the cells of a text file. Empty lines and lines that start with '#' are skipped. With a blank as
/// `separator`, cells may also be separated by tabs, commas or semicolons.
struct Table {
  struct Row {
    int line;
    std::vector<std::string> cells;
  };
  std::filesystem::path path;
  std::vector<Row> rows;

  static Table read(const std::filesystem::path& path, char separator, const std::string& header, std::size_t columns);

  double number(const Row& row, std::size_t column) const;  ///< any double, also "nan"
  std::int64_t integer(const Row& row, std::size_t column) const;
  std::int64_t time_ns(const Row& row,
                       std::size_t column) const;  ///< decimal seconds, without rounding

 private:
  [[noreturn]] void fail(const Row& row, std::size_t column, const std::string& what) const;
};

}  // namespace tumble::scenarios
