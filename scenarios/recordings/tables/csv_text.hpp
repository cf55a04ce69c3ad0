// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Text files with separated columns, read line by line. Used only within scenarios/recordings.
namespace tumble::scenarios {

/// A line of a file and its location "FILE:12". The fields are views of the file's text without surrounding blanks or
/// quotes.
struct CsvLine {
  std::string where;
  std::vector<std::string_view> fields;
};

/// The lines of a file in memory. Accepts Windows line ends; ignores empty lines at the end.
class CsvText {
 public:
  /// Separates fields with the most frequent separator in the first line: comma, semicolon or tab.
  explicit CsvText(const std::filesystem::path& path);
  /// Throws BadInput with the file if the file is missing or empty, or if the last line has no newline and may be
  /// truncated.
  CsvText(const std::filesystem::path& path, char separator);
  /// Reads the next line; returns false at the end.
  bool next(CsvLine& line);

 private:
  std::string name_, text_;
  char separator_;
  std::size_t at_ = 0;
  int number_ = 0;
};

/// Throws BadInput with the line's location and the message.
[[noreturn]] void fail(const CsvLine& line, const std::string& what);

/// Returns a finite number from a field. Throws BadInput with the location and `column`, which is the column's name or
/// number.
double csv_number(const CsvLine& line, std::size_t index, const std::string& column);

/// Returns true if the whole field is a number; NaN and infinities are accepted.
bool is_number(std::string_view field);

}  // namespace tumble::scenarios
