// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

/// CsvText reads text files with separated columns, line by line.
namespace tumble::scenarios {

/// CsvLine is a line of a file, with its location "FILE:12" for error messages. A field is a view of the file's text,
/// without surrounding blanks or quotes.
struct CsvLine {
  std::string where;
  std::vector<std::string_view> fields;
};

/// CsvText contains the lines of a file in memory. Windows line ends are accepted; empty lines at the end are ignored.
class CsvText {
 public:
  /// Opens a file. The separator is the comma, semicolon or tab, whichever is most frequent in the first line that is
  /// no comment. If this line has no comma, semicolon or tab, blanks are the separator.
  explicit CsvText(const std::filesystem::path& path);
  /// Opens a file. Throws BadInput if the file is missing or empty.
  CsvText(const std::filesystem::path& path, char separator);
  /// Reads the next line. Returns false at the end of the file. Throws BadInput for a last line without newline, which
  /// may be truncated; the caller can then continue.
  bool next(CsvLine& line);
  /// Place is a position between two lines, to which `back_to` moves the reader.
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
  bool unended_ = false;  ///< the last line has no newline
  Place at_;
};

/// Returns true if a line begins with '#', '%' or '//'.
bool is_comment(std::string_view line);

/// Throws BadInput with the location of the line and the text `what`.
[[noreturn]] void fail(const CsvLine& line, const std::string& what);

/// Parses field `index` of a line as a finite number. If the field is not a finite number, throws BadInput with the
/// location and `column`, the name or number of the column.
double csv_number(const CsvLine& line, std::size_t index, const std::string& column);

/// Returns true if the whole field is a number; NaN and infinity are numbers.
bool is_number(std::string_view field);

}  // namespace tumble::scenarios
