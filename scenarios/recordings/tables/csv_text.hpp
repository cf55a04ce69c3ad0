// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace tumble::scenarios {

struct CsvLine {
  std::string where;
  std::vector<std::string_view> fields;
};

/// Windows line ends are accepted; empty lines at the end are ignored.
class CsvText {
 public:
  /// The separator is the comma, semicolon or tab that is most frequent in the first line that is no comment;
  /// otherwise, blanks are the separator.
  explicit CsvText(const std::filesystem::path& path);
  CsvText(const std::filesystem::path& path, char separator);
  /// Throws BadInput if the last line has no line end, because the line may be truncated; the next call returns false.
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

}  // namespace tumble::scenarios
