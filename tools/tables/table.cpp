// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tables/table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "scenarios/text.hpp"

namespace tumble::tools {

namespace {

std::string padded(const std::string& cell, std::size_t width, bool right) {
  const std::string fill(width - std::min(width, character_count(cell)), ' ');
  return right ? fill + cell : cell + fill;
}

void append_line(std::string& out, std::string line) {
  line.erase(line.find_last_not_of(' ') + 1);
  out += line + "\n";
}

std::vector<std::string> wrapped(const std::string& text, std::size_t width) {
  std::vector<std::string> lines(1);
  std::istringstream words(text);
  for (std::string word; words >> word;) {
    std::string& line = lines.back();
    if (line.empty())
      line = word;
    else if (character_count(line) + 1 + character_count(word) <= width)
      line += " " + word;
    else
      lines.push_back(word);
  }
  return lines;
}

}  // namespace

Table::Table(std::string title, std::vector<std::string> header)
    : title_(std::move(title)), header_(std::move(header)), right_from_(header_.size()) {}

void Table::add_row(std::vector<std::string> cells) {
  if (cells.size() > header_.size())
    throw std::logic_error(fmt::format("table '{}': a row has more cells than the header", title_));
  cells.resize(header_.size());
  rows_.push_back(std::move(cells));
}

std::string Table::text() const {
  std::vector<std::size_t> width(header_.size());
  std::size_t before_last = 0;
  for (std::size_t i = 0; i < header_.size(); ++i) {
    width[i] = character_count(header_[i]);
    for (const auto& row : rows_) width[i] = std::max(width[i], character_count(row[i]));
    if (i + 1 < header_.size()) before_last += width[i] + 2;
  }
  if (wrapped_) {
    const std::size_t most = std::max(kLineMax / 3, kLineMax - std::min(kLineMax, before_last));
    width.back() = std::min(width.back(), most);
  }
  const auto line = [&](const std::vector<std::string>& cells) {
    std::string joined;
    for (std::size_t i = 0; i < cells.size(); ++i)
      joined += (i ? "  " : "") + padded(cells[i], width[i], i >= right_from_);
    return joined;
  };
  std::string out;
  if (!title_.empty()) append_line(out, title_);
  append_line(out, line(header_));
  std::vector<std::string> rule;
  for (const std::size_t w : width) rule.emplace_back(w, '-');
  append_line(out, line(rule));
  for (std::vector<std::string> row : rows_) {
    const std::vector<std::string> last =
        wrapped_ ? wrapped(row.back(), width.back()) : std::vector<std::string>{row.back()};
    for (const std::string& part : last) {
      row.back() = part;
      append_line(out, line(row));
      row.assign(row.size(), "");
    }
  }
  return out;
}

std::string number_text(double value) {
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return std::isnan(value) ? "-" : fmt::format("{:.4g}", value);
}

std::string chance_text(double chance) {
  if (std::isnan(chance)) return "-";
  return chance < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", chance);
}

std::string more_draws_text(double needed, std::int64_t draws, bool open) {
  if (!open) return "";
  if (std::isinf(needed)) return "no number";
  const double more = std::max(0.0, needed - static_cast<double>(draws));
  return more < 1e9 ? fmt::format("{:.0f}", more) : "over 1e9";
}

std::size_t character_count(const std::string& text) {
  return static_cast<std::size_t>(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

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
