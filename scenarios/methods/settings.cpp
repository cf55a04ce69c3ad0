// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/settings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

namespace tumble::scenarios {

namespace {

std::string suffix_of(std::string_view unit) {
  std::string out = "_";
  for (const char c : unit) {
    if (c == '/' || c == ' ') {
      out += '_';
    } else if (c != '^') {
      out += c;
    }
  }
  return out;
}

bool matches_any_pattern(const std::string& name, const std::vector<std::string>& patterns) {
  return tumble::matches_any_pattern<std::string>(name, patterns);
}

}  // namespace

std::array<std::string, 3> detail::coordinate_names(const std::string& name, const ParameterInfo& field) {
  const std::string suffix = suffix_of(field.unit);
  const bool ends = name.ends_with(suffix);
  const std::string stem = ends ? name.substr(0, name.size() - suffix.size()) : name;
  std::array<std::string, 3> out;
  for (std::size_t j = 0; j < 3; ++j) out[j] = stem + "_" + "xyz"[j] + (ends ? suffix : "");
  return out;
}

SettingsTable::SettingsTable(SettingsOptions options) : options_(std::move(options)) {}

std::string SettingsTable::name_of(const std::string& field_name) const {
  const auto is_occupied = [&](const sim::Parameter& other) { return other.name == field_name; };
  const bool taken = std::any_of(options_.beside.begin(), options_.beside.end(), is_occupied);
  return taken ? options_.prefix + field_name : field_name;
}

void SettingsTable::add(const std::string& field_name, double value, const ParameterInfo& field, bool whole) {
  if (matches_any_pattern(field_name, options_.fixed)) return;
  sim::Parameter row{
      texts_.emplace_back(name_of(field_name)), value, field.low, field.high, field.unit, field.description};
  const bool stated = matches_any_pattern(field_name, options_.stated);
  if (stated) {
    row.doc = texts_.emplace_back(fmt::format("{}; default: the value in the recording, if any", field.description));
    stated_.insert(row.name);
  }
  if (whole) whole_.insert(row.name);
  if (!stated && (field.audience == ParameterAudience::common_use || matches_any_pattern(field_name, options_.first)))
    first_.insert(row.name);
  rows_.push_back(row);
}

void SettingsTable::sort_rows() {
  std::stable_partition(rows_.begin(), rows_.end(),
                        [&](const sim::Parameter& row) { return first_.contains(row.name); });
  first_rows_ = first_.size();
}

bool SettingsTable::applies(const std::string& field_name, const sim::Values& values, std::string& name) const {
  if (matches_any_pattern(field_name, options_.fixed)) return false;
  name = name_of(field_name);
  return !stated_.contains(name) || values.has(name);
}

std::vector<sim::Parameter> joined_rows(std::span<const SettingsTable* const> stages, std::size_t& first) {
  std::vector<sim::Parameter> rows, further;
  for (const SettingsTable* stage : stages) {
    const auto middle = stage->rows().begin() + static_cast<std::ptrdiff_t>(stage->first_rows());
    rows.insert(rows.end(), stage->rows().begin(), middle);
    further.insert(further.end(), middle, stage->rows().end());
  }
  first = rows.size();
  rows.insert(rows.end(), further.begin(), further.end());
  return rows;
}

sim::Values resolve_settings(const std::string& place, const sim::Values& given,
                             std::span<const SettingsTable* const> stages) {
  std::size_t first = 0;
  const sim::Values all = sim::resolve(place, given, joined_rows(stages, first));
  sim::Values out;
  for (const auto& [name, value] : all.all()) {
    const auto any = [&, &name = name](bool (SettingsTable::*is)(std::string_view) const) {
      return std::any_of(stages.begin(), stages.end(), [&](const SettingsTable* each) { return (each->*is)(name); });
    };
    if (any(&SettingsTable::is_stated) && !given.has(name)) continue;
    if (any(&SettingsTable::is_whole) && value != std::floor(value)) {
      throw sim::InvalidSituation(
          fmt::format("the parameter {}.{} is {:g}; it must be a whole number", place, name, value));
    }
    out.set(name, value);
  }
  return out;
}

}  // namespace tumble::scenarios
