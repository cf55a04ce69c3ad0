// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/recordings/clouds/import_sweeps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <string_view>

#include "scenarios/errors.hpp"
#include "scenarios/recordings/import.hpp"
#include "scenarios/recordings/lower_extension.hpp"
#include "scenarios/recordings/number_text.hpp"
#include "scenarios/recordings/recording_clock.hpp"
#include "scenarios/recordings/table_file.hpp"
#include "scenarios/recordings/upper_median.hpp"
#include "scenarios/text.hpp"

namespace tumble::scenarios {

namespace {

using std::filesystem::path;

std::string ending_of(const std::string& format) {
  if (format == "ply" || format == "pcd" || format == "vtk") return "." + format;
  if (format == "kitti") return ".bin";
  throw BadInput(fmt::format("the sweep format '{}' is not supported; supported: ply, pcd, vtk and kitti", format));
}

path times_file(const SweepSource& source, const std::vector<path>& files) {
  if (!source.times.empty()) return source.times;
  for (const std::string& name : {stem_of(files.front()) + "_times.txt", std::string("times.txt")}) {
    if (std::filesystem::is_regular_file(source.folder / name)) return source.folder / name;
  }
  return {};
}

std::vector<std::int64_t> stamps_of(const SweepSource& source, const std::vector<path>& files,
                                    std::vector<std::string>& disorder) {
  const path file = times_file(source, files);
  if (file.empty()) return stamps_in_names(files);
  std::vector<std::int64_t> stamps = read_stamps(file, &disorder);
  if (stamps.size() != files.size()) {
    throw BadInput(
        fmt::format("{}: the file contains {} time stamps, but there are {} sweeps in {}; the numbers must be equal",
                    file.string(), stamps.size(), files.size(), source.folder.string()));
  }
  return stamps;
}

std::vector<std::int64_t> steady_stamps(std::size_t count, std::int64_t step_ns) {
  std::vector<std::int64_t> stamps;
  for (std::size_t k = 0; k < count; ++k) stamps.push_back(static_cast<std::int64_t>(k) * step_ns);
  return stamps;
}

}  // namespace

Imported import_sweeps(const SweepSource& source) {
  const std::vector<path> files = sweep_files(source.folder, ending_of(source.format), source.stem);
  std::vector<std::string> disorder;
  std::vector<std::int64_t> stamps = stamps_of(source, files, disorder);
  SweepReading reading = source.reading;
  Imported out;
  if (stamps.empty() && source.steady_ns > 0) {
    stamps = steady_stamps(files.size(), source.steady_ns);
    reading.assumed = true;
    out.notes.push_back("the sweeps have no time stamps; the import computes the times from the stated period");
  }
  const std::vector<bool> in_order = stamps_in_order(stamps);
  std::vector<std::int64_t> kept = stamps;
  keep_rows(in_order, kept);
  LeftOut left_out("clouds");
  for (std::size_t k = 0; k < stamps.size(); ++k) {
    if (in_order[k]) continue;
    const bool decreases = k < disorder.size() && !disorder[k].empty();
    left_out.add(
        "a wrong time stamp",
        decreases ? disorder[k] : fmt::format("{}: the time stamp of the sweep is out of order", files[k].string()));
  }
  left_out.require_few(kept.size());
  const std::int64_t given_ns = reading.device.sweep_period_ns;
  SweepBuilder builder(std::move(reading), given_ns > 0 ? given_ns : median_step_ns(kept), std::move(left_out));
  for (std::size_t k = 0; k < files.size(); ++k) {
    if (!stamps.empty() && !in_order[k]) continue;
    const std::optional<std::int64_t> stamp = stamps.empty() ? std::nullopt : std::optional(stamps[k]);
    std::optional<Cloud> cloud;
    builder.left_out().guard([&] { cloud = read_cloud(files[k], source.bin_columns); });
    if (cloud) builder.add(stamp, std::move(*cloud), files[k].string());
  }
  add_lidar(out, builder.finish(source.folder.string(), out.notes));
  out.info.attribution = fmt::format("imported from {}: {} sweeps in format {}", source.folder.filename().string(),
                                     files.size(), source.format);
  start_clock(out);
  return out;
}

namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}

bool natural_less(const std::filesystem::path& left, const std::filesystem::path& right) {
  const std::string a = left.filename().string(), b = right.filename().string();
  std::size_t i = 0, j = 0;
  while (i < a.size() && j < b.size()) {
    if (!is_digit(a[i]) || !is_digit(b[j])) {
      if (a[i] != b[j]) return a[i] < b[j];
      ++i, ++j;
      continue;
    }
    while (i < a.size() && a[i] == '0') ++i;
    while (j < b.size() && b[j] == '0') ++j;
    const std::size_t from_i = i, from_j = j;
    while (i < a.size() && is_digit(a[i])) ++i;
    while (j < b.size() && is_digit(b[j])) ++j;
    if (i - from_i != j - from_j) return i - from_i < j - from_j;
    const int order = a.compare(from_i, i - from_i, b, from_j, j - from_j);
    if (order != 0) return order < 0;
  }
  if (a.size() - i != b.size() - j) return a.size() - i < b.size() - j;
  return a < b;  // names that differ in leading zeros
}

std::string_view take_digits(std::string_view& text) {
  std::size_t begin = text.size();
  while (begin > 0 && is_digit(text[begin - 1])) --begin;
  const std::string_view digits = text.substr(begin);
  text = text.substr(0, begin);
  return digits;
}

std::optional<std::int64_t> stamp_in_name(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  std::string_view rest = stem;
  const std::string_view last = take_digits(rest);
  if (last.empty()) return std::nullopt;
  if (rest.ends_with('.') || rest.ends_with('_')) {
    const bool decimals = rest.ends_with('.');
    rest.remove_suffix(1);
    const std::string_view seconds = take_digits(rest);
    const bool whole = !seconds.empty() && seconds.size() <= 10;
    if (whole && (decimals ? last.size() <= 9 : last.size() == 9 && seconds.size() >= 9)) {
      return parse_time_ns(std::string(seconds) + "." + std::string(last), 9);
    }
  }
  const bool epoch = last.size() == 13 || last.size() == 16 || last.size() == 19;
  return epoch ? parse_stamp_ns(last) : std::nullopt;
}

}  // namespace

std::string stem_of(const std::filesystem::path& file) {
  std::string stem = file.stem().string();
  while (!stem.empty() &&
         (is_digit(stem.back()) || std::string_view("._-").find(stem.back()) != std::string_view::npos))
    stem.pop_back();
  return stem;
}

std::vector<std::filesystem::path> sweep_files(const std::filesystem::path& folder, const std::string& ending,
                                               const std::string& stem) {
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error))
    throw BadInput(fmt::format("{}: the path of the sweeps is not a folder", folder.string()));
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::filesystem::path& path = entry.path();
    const bool fits = lower_extension(path) == ending && !path.filename().string().starts_with('.');
    if (fits && (stem.empty() || stem_of(path) == stem)) files.push_back(path);
  }
  if (files.empty()) {
    throw BadInput(fmt::format("{}: the folder contains no file that ends in {}{}", folder.string(), ending,
                               (stem.empty() ? "" : " and begins with '" + stem + "'")));
  }
  std::sort(files.begin(), files.end(), natural_less);
  if (stem_of(files.front()) != stem_of(files.back())) {
    throw BadInput(fmt::format(
        "{}: the folder contains files of several lidars, '{}' and '{}'; select one lidar by its file name prefix",
        folder.string(), stem_of(files.front()), stem_of(files.back())));
  }
  return files;
}

std::vector<std::int64_t> stamps_in_names(const std::vector<std::filesystem::path>& files) {
  std::vector<std::int64_t> stamps;
  const std::filesystem::path* without = nullptr;
  for (const std::filesystem::path& file : files) {
    const std::optional<std::int64_t> stamp = stamp_in_name(file);
    if (stamp)
      stamps.push_back(*stamp);
    else
      without = &file;
  }
  if (stamps.empty() || without == nullptr) return stamps;
  throw BadInput(fmt::format("{}: the file name contains no time stamp, but the names of {} other files contain one",
                             without->string(), stamps.size()));
}

std::vector<std::int64_t> read_stamps(const std::filesystem::path& file, std::vector<std::string>* disorder) {
  const Table table = Table::read(file, '\n', "", 1);  // one cell, because dates contain blanks
  std::vector<std::int64_t> stamps;
  for (const Table::Row& row : table.rows) {
    const std::optional<std::int64_t> found = parse_stamp_ns(row.cells[0]);
    if (!found)
      throw BadInput(
          fmt::format("{}:{}: the time stamp '{}' must be in seconds, an integer in ms, us or ns, or a date in UTC",
                      file.string(), row.line, shortened(row.cells[0])));
    const std::int64_t stamp = *found;
    std::string wrong;
    if (!stamps.empty() && stamp <= stamps.back()) {
      wrong = fmt::format("{}:{}: the time stamp {} ns must be larger than the previous time stamp, {} ns",
                          file.string(), row.line, stamp, stamps.back());
    }
    if (disorder == nullptr && !wrong.empty()) throw BadInput(wrong);
    if (disorder != nullptr) disorder->push_back(std::move(wrong));
    stamps.push_back(stamp);
  }
  return stamps;
}

std::int64_t median_step_ns(const std::vector<std::int64_t>& times_ns) {
  if (times_ns.size() < 2) return 0;
  std::vector<std::int64_t> steps;
  for (std::size_t i = 1; i < times_ns.size(); ++i) steps.push_back(times_ns[i] - times_ns[i - 1]);
  return upper_median(std::move(steps));
}

}  // namespace tumble::scenarios
