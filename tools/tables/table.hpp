// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tumble::tools {

/// A table for people: a title, a header and rows of text, in columns as wide as their widest cell (counted in
/// characters, not in bytes). Columns are left-aligned unless named otherwise; nothing is cut.
class Table {
 public:
  Table(std::string title, std::vector<std::string> header);

  /// Cells beyond the header are refused with std::logic_error, missing ones are empty.
  void add_row(std::vector<std::string> cells);
  /// Aligns column `index` and those after it to the right: numbers.
  void align_right_from(std::size_t index) { right_from_ = index; }

  bool empty() const { return rows_.empty(); }
  /// Title, header, rule and rows, each line ended; no spaces at line ends.
  std::string text() const;
  /// The same for other programs' documents, cells escaped so that what they hold is text there and never markup.
  std::string markdown() const;  ///< a table of GitHub's Markdown
  std::string csv() const;       ///< RFC 4180; the title as a comment line, "# title"
  std::string tex() const;       ///< a `tabular` of LaTeX with the rules of `booktabs`

 private:
  std::string title_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::size_t right_from_;
};

/// A number with four significant digits; "-" for one that is not finite.
std::string number_text(double value);

/// The chance of a test with four decimals; "-" where there is none (NaN).
std::string chance_text(double chance);

/// Draws that a test wants beyond those there are, where it is still open: "" where not, "no number" where none would
/// do.
std::string more_draws_text(double needed, std::int64_t draws, bool open);

/// Number of characters of a UTF-8 string (code points; combining marks are not accounted for).
std::size_t character_count(const std::string& text);

}  // namespace tumble::tools
