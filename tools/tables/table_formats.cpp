// SPDX-License-Identifier: BSD-3-Clause
#include <cctype>
#include <string_view>

#include "tools/tables/table.hpp"

#include "scenarios/text.hpp"

namespace tumble::tools {

namespace {

using Escape = std::string (*)(const std::string& cell);

std::string joined(const std::vector<std::string>& cells, std::string_view between, Escape escape) {
  std::string out;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    if (i > 0) out += between;
    out += escape(cells[i]);
  }
  return out;
}

std::string for_markdown(const std::string& cell) {
  std::string out;
  for (std::size_t i = 0; i < cell.size(); ++i) {
    const char c = cell[i];
    const auto letter = [&](std::size_t at) {
      return at < cell.size() && std::isalnum(static_cast<unsigned char>(cell[at])) != 0;
    };
    const bool marks = std::string_view("\\`*[]<>|&~#!").find(c) != std::string_view::npos ||
                       (c == '_' && !(i > 0 && letter(i - 1) && letter(i + 1)));
    if (c == '\n' || c == '\r') {
      out += ' ';
    } else {
      out += marks ? std::string{'\\', c} : std::string(1, c);
    }
  }
  return out;
}

std::string for_csv(const std::string& cell) {
  if (cell.find_first_of(",\"\r\n") == std::string::npos) return cell;
  std::string out = "\"";
  for (const char c : cell) out += c == '"' ? std::string("\"\"") : std::string(1, c);
  return out + "\"";
}

std::string for_tex(const std::string& cell) {
  std::string out;
  for (const char c : cell) {
    if (std::string_view("&%$#_{}").find(c) != std::string_view::npos) {
      out += std::string{'\\', c};
    } else if (c == '\\') {
      out += "\\textbackslash{}";
    } else if (c == '~') {
      out += "\\textasciitilde{}";
    } else if (c == '^') {
      out += "\\textasciicircum{}";
    } else if (c == '<' || c == '>') {
      out += std::string("$") + c + "$";
    } else {
      out += c == '\n' || c == '\r' ? ' ' : c;
    }
  }
  return out;
}

}  // namespace

std::string Table::markdown() const {
  std::string out;
  if (!title_.empty()) out += "**" + for_markdown(title_) + "**\n\n";
  out += "| " + joined(header_, " | ", for_markdown) + " |\n|";
  for (std::size_t i = 0; i < header_.size(); ++i) out += i >= right_from_ ? " ---: |" : " --- |";
  out += "\n";
  for (const auto& row : rows_) out += "| " + joined(row, " | ", for_markdown) + " |\n";
  return out;
}

std::string Table::csv() const {
  std::string out;
  if (!title_.empty()) out += "# " + scenarios::one_line(title_) + "\n";
  out += joined(header_, ",", for_csv) + "\n";
  for (const auto& row : rows_) out += joined(row, ",", for_csv) + "\n";
  return out;
}

std::string Table::tex() const {
  std::string out;
  if (!title_.empty()) out += "% " + scenarios::one_line(title_) + "\n";
  out += "\\begin{tabular}{";
  for (std::size_t i = 0; i < header_.size(); ++i) out += i >= right_from_ ? 'r' : 'l';
  out += "}\n\\toprule\n" + joined(header_, " & ", for_tex) + " \\\\\n\\midrule\n";
  for (const auto& row : rows_) out += joined(row, " & ", for_tex) + " \\\\\n";
  return out + "\\bottomrule\n\\end{tabular}\n";
}

}  // namespace tumble::tools
