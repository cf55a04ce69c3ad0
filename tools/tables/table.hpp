// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tumble::tools {

class Table {
 public:
  Table(std::string title, std::vector<std::string> header);

  void add_row(std::vector<std::string> cells);
  void align_right_from(std::size_t index) { right_from_ = index; }
  void wrap_last() { wrapped_ = true; }

  bool empty() const { return rows_.empty(); }
  std::string text() const;
  std::string markdown() const;  ///< a GitHub Markdown table
  std::string csv() const;       ///< RFC 4180; comment line "# title"
  std::string tex() const;       ///< `tabular` with `booktabs`

 private:
  std::string title_;
  std::vector<std::string> header_;
  std::vector<std::vector<std::string>> rows_;
  std::size_t right_from_;
  bool wrapped_ = false;
};

/// Maximum line length of a table whose last column is wrapped; the last column has at least a third of this width
inline constexpr std::size_t kLineMax = 160;

std::string number_text(double value);

std::string chance_text(double chance);

std::string more_draws_text(double needed, std::int64_t draws, bool open);

/// Counts the code points of a UTF-8 string; combining marks count separately.
std::size_t character_count(const std::string& text);

}  // namespace tumble::tools
