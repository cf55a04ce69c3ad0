// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tumble::tools {

/// Table is a table of text: title, header and rows. Each column is as wide as its widest cell, in characters. Columns
/// are left-aligned by default; cells are never truncated.
class Table {
 public:
  Table(std::string title, std::vector<std::string> header);

  /// Appends a row; missing cells are empty. Throws std::logic_error if there are more cells than columns.
  void add_row(std::vector<std::string> cells);
  /// Right-aligns the columns from `index` on, for numbers.
  void align_right_from(std::size_t index) { right_from_ = index; }
  /// Wraps the last column of `text()` at spaces, so that lines have at most kLineMax characters where possible.
  void wrap_last() { wrapped_ = true; }

  bool empty() const { return rows_.empty(); }
  /// Returns title, header, rule and rows; lines have no trailing spaces.
  std::string text() const;
  /// Formats for documents. Cells are escaped, so that their content is not interpreted as markup.
  std::string markdown() const;  ///< a GitHub Markdown table
  std::string csv() const;       ///< RFC 4180; the title is a comment line, "# title"
  std::string tex() const;       ///< a LaTeX `tabular` with the rules of `booktabs`

 private:
  std::string title_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::size_t right_from_;
  bool wrapped_ = false;
};

/// Maximum line length of a table with `wrap_last`; the last column has at least a third of this width.
inline constexpr std::size_t kLineMax = 160;

/// Formats a number with four significant digits; "-" if the number is not finite.
std::string number_text(double value);

/// Formats a p-value with four decimals; "-" for NaN.
std::string chance_text(double chance);

/// Formats how many more runs an open (undecided) test needs; empty if the test is decided, "no number" if no number of
/// runs suffices.
std::string more_draws_text(double needed, std::int64_t draws, bool open);

/// Counts the code points of a UTF-8 string; combining marks count separately.
std::size_t character_count(const std::string& text);

}  // namespace tumble::tools
