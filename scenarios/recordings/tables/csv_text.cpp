// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/csv_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <system_error>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/regular_file.hpp"

namespace tumble::scenarios {

namespace {

std::string_view trimmed(std::string_view text) {
  while (text.starts_with(' ') || text.starts_with('\t')) text.remove_prefix(1);
  while (text.ends_with(' ') || text.ends_with('\t') || text.ends_with('\r')) text.remove_suffix(1);
  if (text.size() > 1 && text.starts_with('"') && text.ends_with('"')) return trimmed(text.substr(1, text.size() - 2));
  return text;
}

std::string_view first_row(std::string_view text) {
  for (std::string_view rest = text; !rest.empty();) {
    const std::string_view line = trimmed(rest.substr(0, rest.find('\n')));
    if (!line.empty() && !is_comment(line)) return line;
    rest.remove_prefix(std::min(rest.find('\n'), rest.size() - 1) + 1);
  }
  return text.substr(0, text.find('\n'));
}

char likely_separator(std::string_view text) {
  const std::string_view line = first_row(text);
  char most = ',';
  for (const char separator : {';', '\t'}) {
    if (std::count(line.begin(), line.end(), separator) > std::count(line.begin(), line.end(), most)) most = separator;
  }
  return line.find(most) == std::string_view::npos ? ' ' : most;
}

void require_lines(const std::string& name, std::string_view text) {
  const std::string_view mark = text.substr(0, 2);
  if (mark == "\xFF\xFE" || mark == "\xFE\xFF")
    throw BadInput(fmt::format("{}: the text of the file is in UTF-16; it must be in UTF-8", name));
  if (const std::size_t zero = text.find('\0'); zero != std::string_view::npos) {
    const auto line = std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(zero), '\n') + 1;
    throw BadInput(
        fmt::format("{}:{}: the file contains a zero byte: it is damaged or is not a text file", name, line));
  }
  if (text.find('\n') == std::string_view::npos && text.find('\r') != std::string_view::npos)
    throw BadInput(
        fmt::format("{}: the lines of the file end in a carriage return; they must end in a line feed", name));
}

}  // namespace

CsvText::CsvText(const std::filesystem::path& path, char separator) : name_(path.string()), separator_(separator) {
  std::ifstream stream = open_regular_file(path);
  text_.assign(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  if (stream.bad()) throw BadInput(name_ + ": cannot be read");
  if (text_.empty()) throw BadInput(name_ + ": the file is empty");
  require_lines(name_, text_);
  unended_ = text_.back() != '\n';
  if (text_.starts_with("\xEF\xBB\xBF")) at_.at = 3;  // byte order mark
  text_.erase(text_.find_last_not_of(" \t\r\n") + 1);
  text_ += '\n';
}

CsvText::CsvText(const std::filesystem::path& path) : CsvText(path, ',') {
  separator_ = likely_separator(text_);
}

bool CsvText::next(CsvLine& line) {
  if (at_.at >= text_.size()) return false;
  const std::size_t end = text_.find('\n', at_.at);  // the text ends in a newline
  std::string_view text = std::string_view(text_).substr(at_.at, end - at_.at);
  at_ = {end + 1, at_.lines + 1};
  line.where = name_ + ":" + std::to_string(at_.lines);
  line.fields.clear();
  if (unended_ && end + 1 == text_.size())
    fail(line, "the last line has no line end; the file may be truncated within a number");
  const bool blanks = separator_ == ' ';  // consecutive blanks are one separator
  if (blanks) text = trimmed(text);
  for (std::size_t cut = text.find(separator_); cut != std::string_view::npos; cut = text.find(separator_)) {
    if (!blanks || cut > 0) line.fields.push_back(trimmed(text.substr(0, cut)));
    text.remove_prefix(cut + 1);
  }
  line.fields.push_back(trimmed(text));
  return true;
}

bool is_comment(std::string_view line) {
  return line.starts_with('#') || line.starts_with('%') || line.starts_with("//");
}

void fail(const CsvLine& line, const std::string& what) {
  throw BadInput(line.where + ": " + what);
}

double csv_number(const CsvLine& line, std::size_t index, const std::string& column) {
  const std::string_view text = line.fields[index];
  double value = 0.0;
  const std::string place = line.where + ": column " + column;
  if (!parse_number(text, value)) {
    const bool comma = text.find(',') != std::string_view::npos;
    throw BadInput(fmt::format("{} must contain a number, but contains '{}'{}", place, text,
                               comma ? " (use a decimal point)" : ""));
  }
  if (!std::isfinite(value)) throw BadInput(place + " is not finite");
  return value;
}

bool is_number(std::string_view field) {
  double value = 0.0;
  return parse_number(field, value);
}

namespace {

bool is_blank(const CsvLine& line) {
  return line.fields.size() == 1 && line.fields.front().empty();
}

std::size_t numbers_in(const CsvLine& line) {
  return static_cast<std::size_t>(std::count_if(line.fields.begin(), line.fields.end(), is_number));
}

bool is_sample(const CsvLine& line) {
  return 2 * numbers_in(line) >= line.fields.size();
}

void drop_open_end(CsvLine& line) {
  if (line.fields.size() > 1 && line.fields.back().empty()) line.fields.pop_back();
}

void uncomment(CsvLine& line) {
  std::string_view& first = line.fields.front();
  first.remove_prefix(std::min(first.find_first_not_of("#%/ \t"), first.size()));
  if (first.empty() && line.fields.size() > 1) line.fields.erase(line.fields.begin());  // "# time x y"
}

}  // namespace

LoggedTable::LoggedTable(const std::filesystem::path& path) : text_(path) {
  CsvLine line;
  std::optional<CsvLine> comment;
  CsvText::Place before = text_.place();
  bool found = false;
  while (!found && text_.next(line)) {
    found = !is_blank(line) && !is_comment(line.fields.front());
    if (found) break;
    if (!is_blank(line)) comment = line;
    before = text_.place();
  }
  drop_open_end(line);
  samples_ = text_.place();
  header_ = line;
  if (!found) return;  // the file contains only comments
  if (is_sample(line)) {
    samples_ = before;
    has_header_ = false;
    if (comment) {
      drop_open_end(*comment);
      uncomment(*comment);
      if (comment->fields.size() == line.fields.size() && !is_sample(*comment)) {
        header_ = *comment;
        has_header_ = true;
      }
    }
  } else {
    CsvLine units;
    const bool more = text_.next(units);
    drop_open_end(units);
    if (more && units.fields.size() == header_.fields.size() && !is_comment(units.fields.front()) &&
        numbers_in(units) == 0 && units.fields.size() > 1)
      add_units(units);
  }
  restart();
}

void LoggedTable::add_units(const CsvLine& units) {
  samples_ = text_.place();
  for (std::size_t i = 0; i < header_.fields.size(); ++i) {
    const std::string name(header_.fields[i]), unit(units.fields[i]);
    const bool stated = name.find_first_of("[(") != std::string::npos;
    names_.push_back(unit.empty() || stated ? name : name + " [" + unit + "]");
  }
  header_.fields.assign(names_.begin(), names_.end());
}

bool LoggedTable::next(CsvLine& line) {
  const std::size_t columns = header_.fields.size();
  while (text_.next(line)) {
    if (is_blank(line) || is_comment(line.fields.front())) continue;
    if (line.fields.size() == columns + 1 && line.fields.back().empty()) line.fields.pop_back();
    if (line.fields.size() != columns)
      fail(line, fmt::format("this line has {} columns, but the first line has {}; the numbers must be equal",
                             line.fields.size(), columns));
    if (!kept_ || line.fields[kept_->column] == kept_->value) return true;
  }
  return false;
}

bool LoggedTable::next_sound(CsvLine& line) {
  for (;;) {
    try {
      return next(line);
    } catch (const BadInput&) {
      continue;
    }
  }
}

}  // namespace tumble::scenarios
