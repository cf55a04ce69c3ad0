// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/tables/logged_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "scenarios/errors.hpp"

namespace tumble::scenarios {

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
