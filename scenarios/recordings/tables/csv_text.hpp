// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Text files of separated columns, read line by line. Private to scenarios/recordings.
namespace tumble::scenarios {

/// One line and where it stands: "FILE:12". Fields are views into the file's text, without blanks or quotes around
/// them.
struct CsvLine {
  std::string where;
  std::vector<std::string_view> fields;
};

/// The lines of a file, from its memory. Line ends may be those of Windows; empty lines at the end are none.
class CsvText {
 public:
  /// Separated by what the first line has most of: a comma, a semicolon or a tabulator.
  explicit CsvText(const std::filesystem::path& path);
  /// Throws BadInput with the file: not there, empty, or a last line without its end, which may be cut in a number.
  CsvText(const std::filesystem::path& path, char separator);
  /// The next line; false at the end.
  bool next(CsvLine& line);

 private:
  std::string name_, text_;
  char separator_;
  std::size_t at_ = 0;
  int number_ = 0;
};

/// Throws BadInput: where the line stands, and what is wrong with it.
[[noreturn]] void fail(const CsvLine& line, const std::string& what);

/// A finite number. Throws BadInput with the place and `column`, the name or number of the column.
double csv_number(const CsvLine& line, std::size_t index, const std::string& column);

/// Whether a whole field reads as a number, NaN and infinities included.
bool is_number(std::string_view field);

}  // namespace tumble::scenarios
