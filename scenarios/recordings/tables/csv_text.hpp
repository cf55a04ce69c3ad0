// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// Reads text files with separated columns, line by line. Used only within scenarios/recordings.
namespace tumble::scenarios {

/// A line of a file and its location "FILE:12". The fields are views of the file's text without surrounding blanks or
/// quotes.
struct CsvLine {
  std::string where;
  std::vector<std::string_view> fields;
};

/// The lines of a file in memory. Windows line ends are accepted, and empty lines at the end are ignored.
class CsvText {
 public:
  /// Separates fields with the most frequent separator in the first line that is no comment: comma, semicolon or tab.
  /// If the first line contains neither comma, semicolon nor tab, blanks separate the fields.
  explicit CsvText(const std::filesystem::path& path);
  /// Throws BadInput with the file if the file is missing or empty, or if the last line has no newline and may be
  /// truncated.
  CsvText(const std::filesystem::path& path, char separator);
  /// Reads the next line. Returns false at the end.
  bool next(CsvLine& line);
  /// Position between two lines. `back_to` continues reading at a stored position.
  struct Place {
    std::size_t at = 0;
    int lines = 0;
  };
  Place place() const { return at_; }
  void back_to(const Place& place) { at_ = place; }
  const std::string& name() const { return name_; }

 private:
  std::string name_, text_;
  char separator_;
  Place at_;
};

/// Returns true for a line that begins with '#', '%' or '//'.
bool is_comment(std::string_view line);

/// Throws BadInput with the line's location and the message.
[[noreturn]] void fail(const CsvLine& line, const std::string& what);

/// Returns a finite number from a field. Throws BadInput with the location and `column`, which is the column's name or
/// number.
double csv_number(const CsvLine& line, std::size_t index, const std::string& column);

/// Returns true if the whole field is a number. NaN and infinities are accepted.
bool is_number(std::string_view field);

}  // namespace tumble::scenarios
