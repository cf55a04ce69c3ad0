// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/table_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <istream>
#include <optional>
#include <span>
#include <string>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/regular_file.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

constexpr std::size_t kBlock = 1 << 16;

bool is_separator(char c) {
  return c == '\t' || c == ',' || c == ';';
}

std::vector<std::string> split(const std::string& line, char separator) {
  std::vector<std::string> cells;
  std::size_t begin = 0;
  while (begin <= line.size()) {
    std::size_t end = line.find(separator, begin);
    if (end == std::string::npos) end = line.size();
    if (separator != ' ' || end > begin) cells.push_back(line.substr(begin, end - begin));
    begin = end + 1;
  }
  return cells;
}

/// Largest length of a line [bytes], so that a file without line ends cannot exhaust the memory. A line with a pose and
/// its covariance has less than 1000 bytes.
constexpr std::size_t kLineMax = 1 << 20;

bool read_line(std::istream& file, const std::filesystem::path& path, int number, std::string& line) {
  line.clear();
  auto& bytes = *file.rdbuf();
  for (int c = bytes.sbumpc(); c != std::istream::traits_type::eof(); c = bytes.sbumpc()) {
    if (c == '\n') return true;
    line += static_cast<char>(c);
    if (line.size() > kLineMax)
      throw BadInput(fmt::format("{}:{}: the line has more than {} bytes, so the file is not a table of numbers",
                                 path.string(), number, kLineMax));
  }
  return !line.empty();
}

}  // namespace

TableWriter::TableWriter(const std::filesystem::path& path, char separator, const std::string& header)
    : file_(path), separator_(separator) {
  if (!header.empty()) text_ = header + '\n';
}

void TableWriter::flush() {
  file_.write(std::as_bytes(std::span(text_)));
  text_.clear();
}

void TableWriter::cell(const std::string& text) {
  if (!row_empty_) text_ += separator_;
  text_ += text;
  row_empty_ = false;
}

void TableWriter::integer(std::int64_t value) {
  cell(std::to_string(value));
}

void TableWriter::number(double value) {
  std::string text;
  append_number(text, value);
  cell(text);
}

void TableWriter::time_s(std::int64_t time_ns) {
  std::string text;
  append_seconds(text, time_ns);
  cell(text);
}

void TableWriter::end_row() {
  text_ += '\n';
  row_empty_ = true;
  if (text_.size() > kBlock) flush();
}

void TableWriter::close() {
  flush();
  file_.move_into_place();
}

Table Table::read(const std::filesystem::path& path, char separator, const std::string& header, std::size_t columns) {
  require_file(path);
  std::ifstream file(path);
  if (!file) throw BadInput(path.string() + ": cannot be read");
  Table table{path, {}};
  std::string line;
  int number = 0;
  bool header_due = !header.empty();
  while (read_line(file, path, number + 1, line)) {
    ++number;
    if (number == 1 && line.starts_with("\xef\xbb\xbf")) line.erase(0, 3);  // byte order mark of editors on Windows
    if (!line.empty() && line.back() == '\r') line.pop_back();
    if (separator == ' ') std::replace_if(line.begin(), line.end(), is_separator, ' ');
    if (header_due) {
      if (line != header)
        throw BadInput(
            fmt::format("{}:1: the header line is '{}'; it must be '{}'", path.string(), shortened(line), header));
      header_due = false;
      continue;
    }
    if (line.empty() || line.front() == '#') continue;
    Row row{number, split(line, separator)};
    if (row.cells.size() != columns) {
      throw BadInput(path.string() + ":" + std::to_string(number) + ": the row has " +
                     std::to_string(row.cells.size()) + " columns; it must have " + std::to_string(columns));
    }
    table.rows.push_back(std::move(row));
  }
  if (header_due) throw BadInput(fmt::format("{}: the file is empty; it must begin with '{}'", path.string(), header));
  return table;
}

void Table::fail(const Row& row, std::size_t column, const std::string& what) const {
  throw BadInput(path.string() + ":" + std::to_string(row.line) + ": '" + shortened(row.cells[column]) + "' is not " +
                 what);
}

double Table::number(const Row& row, std::size_t column) const {
  double value = 0.0;
  if (!parse_number(row.cells[column], value)) fail(row, column, "a number");
  return value;
}

std::int64_t Table::integer(const Row& row, std::size_t column) const {
  std::int64_t value = 0;
  if (!read_number(row.cells[column], value)) fail(row, column, "an integer");
  return value;
}

std::int64_t Table::time_ns(const Row& row, std::size_t column) const {
  // The time is parsed without conversion to double, because a double cannot represent seconds since 1970 with nine
  // decimals.
  const std::optional<std::int64_t> time_ns = parse_time_ns(row.cells[column], 9);
  if (!time_ns) fail(row, column, "a time in seconds");
  return *time_ns;
}

}  // namespace tumble::scenarios
