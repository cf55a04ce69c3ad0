// SPDX-License-Identifier: BSD-3-Clause
#include "sim/parameters.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <numeric>
#include <sstream>
#include <utility>
#include <vector>

namespace tumble::sim {

namespace {

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t substituted = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, substituted});
    }
  }
  return row[b.size()];
}

std::string lower_case(std::string_view text) {
  std::string out(text);
  std::ranges::transform(out, out.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return out;
}

bool is_whole(std::string_view name) {
  return name.ends_with("_count") || name == "shape";
}

}  // namespace

double Values::at(std::string_view name) const {
  const auto found = numbers_.find(std::string(name));
  if (found == numbers_.end()) throw InvalidSituation("no value named '" + std::string(name) + "'");
  return found->second;
}

std::string did_you_mean(std::string_view name, std::span<const std::string> known) {
  constexpr std::size_t kMost = 3;
  const std::string given = lower_case(name);
  std::vector<std::string> longer;
  std::string best;
  std::size_t best_distance = std::max<std::size_t>(2, given.size() / 2) + 1;
  for (const std::string& candidate : known) {
    const std::string lower = lower_case(candidate);
    if (given.size() > 1 && lower.starts_with(given)) longer.push_back(candidate);
    const std::size_t distance = edit_distance(given, lower);
    if (distance < best_distance && distance < std::max(given.size(), lower.size())) {
      best_distance = distance;
      best = candidate;
    }
  }
  std::ranges::sort(longer, {}, [](const std::string& each) { return std::pair(each.size(), each); });
  const bool one_letter_missing = best_distance <= 1;
  if (longer.empty() || one_letter_missing) longer = {best};
  longer.resize(std::min(longer.size(), kMost));
  std::string out;
  for (const std::string& each : longer) out += (out.empty() ? "did you mean '" : " or '") + each + "'";
  return longer.front().empty() ? "" : out + "?";
}

Values resolve(const std::string& place, const Values& given, std::span<const Parameter> known) {
  Values out;
  for (const Parameter& parameter : known) out.set(std::string(parameter.name), parameter.default_value);
  for (const auto& entry : given.all()) {
    const auto& name = entry.first;
    const double value = entry.second;
    const auto parameter = std::find_if(known.begin(), known.end(), [&](const Parameter& p) { return p.name == name; });
    if (parameter == known.end()) {
      std::vector<std::string> names;
      for (const Parameter& p : known) names.emplace_back(p.name);
      const std::string near = did_you_mean(name, names);
      throw InvalidSituation(place + ": unknown key '" + name + "'" + (near.empty() ? "" : "; " + near));
    }
    if (!(value >= parameter->low && value <= parameter->high)) {
      std::ostringstream text;
      text << place << "." << name << " is " << value << " " << parameter->unit << "; it must be within ["
           << parameter->low << ", " << parameter->high << "]";
      throw InvalidSituation(text.str());
    }
    if (is_whole(name) && value != std::floor(value)) {
      std::ostringstream text;
      text << place << "." << name << " is " << value << "; it must be a whole number";
      throw InvalidSituation(text.str());
    }
    out.set(name, value);
  }
  return out;
}

}  // namespace tumble::sim
