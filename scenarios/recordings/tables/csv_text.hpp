// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

struct CsvLine {
  std::string where;
  std::vector<std::string_view> fields;
};

/// CsvText reads the lines of a text table. Windows line ends are accepted, and empty lines at the end are ignored.
class CsvText {
 public:
  /// Opens a table and determines its separator from the first line that is not a comment. The separator is the most
  /// frequent of three characters: comma, semicolon and tab. If the line contains none of these characters, the
  /// separator is a blank.
  explicit CsvText(const std::filesystem::path& path);
  CsvText(const std::filesystem::path& path, char separator);
  /// Reads the next line. Throws BadInput if the last line has no line end, because the line may be truncated; the next
  /// call then returns false.
  bool next(CsvLine& line);
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

bool is_comment(std::string_view line);

[[noreturn]] void fail(const CsvLine& line, const std::string& what);

double csv_number(const CsvLine& line, std::size_t index, const std::string& column);

bool is_number(std::string_view field);

/// LoggedTable reads a table of sensor readings. Empty lines, comments and an empty field after the last separator of a
/// line are skipped. The first line that is not a comment is the header if fewer than half of its fields are numbers. A
/// comment directly before the samples is the header if the comment has as many fields as a sample ("#timestamp
/// [ns],w_RS_S_x [rad s^-1],...").
class LoggedTable {
 public:
  explicit LoggedTable(const std::filesystem::path& path);
  LoggedTable(const LoggedTable&) = delete;
  LoggedTable& operator=(const LoggedTable&) = delete;

  const CsvLine& header() const { return header_; }
  bool has_header() const { return has_header_; }

  /// Throws BadInput with file and line for a wrong number of fields, or for a last line without newline. The caller
  /// may read further lines after a BadInput exception.
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
