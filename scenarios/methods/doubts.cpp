// SPDX-License-Identifier: BSD-3-Clause
#include "scenarios/methods/doubts.hpp"

#include <algorithm>
#include <string_view>

#include "scenarios/methods/method.hpp"

namespace tumble::scenarios {

static_assert(kAllDoubts.size() == static_cast<std::size_t>(Doubt::About::unit_silent) + 1);

namespace {

/// Returns the health key of a check. For a check of an IMU, returns the suffix of the key.
const char* row_name(Doubt::About about) {
  switch (about) {
    case Doubt::About::readings:
      return "imu_implausible";
    case Doubt::About::rates:
      return "imu_rates_doubted";
    case Doubt::About::flights:
      return "imu_flight_against_s";
    case Doubt::About::stamps:
      return "imu_stamps_rounded_s";
    case Doubt::About::rate_unit:
      return "rate_unit_suspect";
    case Doubt::About::force_unit:
      return "force_unit_suspect";
    case Doubt::About::attitude:
      return "attitude_unknown_s";
    case Doubt::About::place:
      return "localised";
    case Doubt::About::lidar_scale:
      return "lidar_scale_implausible";
    case Doubt::About::beyond_range:
      return "imu_readings_beyond_range";
    case Doubt::About::digest:
      return "recording_without_digest";
    case Doubt::About::learnt_rig:
      return "learnt_rig_contradicted";
    case Doubt::About::unit_frozen:
      return "_frozen_since_s";
    case Doubt::About::unit_disagrees:
      return "_disagrees_since_s";
    case Doubt::About::unit_silent:
      break;
  }
  return "_silent_since_s";
}

/// Returns true if a health entry with this value reports a failed check; another value reports a passed check. For a
/// check of an IMU, 0 is a valid start time.
bool is_said(Doubt::About about, double value) {
  if (row_name(about)[0] == '_') return true;
  return (value == 0.0) == (about == Doubt::About::place);
}

auto place_of(const std::string& row, std::vector<Doubt>& doubts) {
  return std::lower_bound(doubts.begin(), doubts.end(), row,
                          [](const Doubt& doubt, const std::string& name) { return row_of(doubt) < name; });
}

}  // namespace

std::string row_of(const Doubt& doubt) {
  return doubt.unit + row_name(doubt.about);
}

void add_doubt(const Doubt& doubt, Estimate& estimate) {
  const std::string row = row_of(doubt);
  const auto at = place_of(row, estimate.doubts);
  if (at != estimate.doubts.end() && row_of(*at) == row) {
    *at = doubt;
  } else {
    estimate.doubts.insert(at, doubt);
  }
  estimate.health[row] = doubt.value;
}

bool has_doubt(const Doubt& doubt, const Estimate& estimate) {
  return std::any_of(estimate.doubts.begin(), estimate.doubts.end(),
                     [&](const Doubt& known) { return known.about == doubt.about && known.unit == doubt.unit; });
}

void report_no_doubt(Doubt::About about, Estimate& estimate) {
  estimate.health[row_name(about)] = about == Doubt::About::place ? 1.0 : 0.0;
}

std::vector<Doubt> doubts_in(const std::map<std::string, double>& health) {
  std::vector<Doubt> out;
  for (const auto& [row, value] : health) {
    for (const Doubt::About about : kAllDoubts) {
      const std::string_view name = row_name(about);
      const bool is_its = name.starts_with('_') ? row.ends_with(name) : row == name;
      if (is_its && is_said(about, value)) out.push_back({about, value, row.substr(0, row.size() - name.size())});
    }
  }
  return out;
}

}  // namespace tumble::scenarios
