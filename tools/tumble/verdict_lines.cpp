// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verdict_lines.hpp"

#include <fmt/format.h>

#include <string_view>

namespace tumble::tools {

namespace {

struct Verdict {
  std::string_view row;  ///< of the health; one that begins with '_' is what a row ends in
  bool when_zero;        ///< said where it is 0, else where it is not
  const char* meaning;
};

constexpr Verdict kVerdicts[] = {
    {"imu_implausible", false,
     "the IMU's readings contradict each other or gravity; the estimate is not to be trusted"},
    {"imu_flight_against_s", false,
     "in flight the force is not what the turning makes: an accelerometer that is flipped, or a gyro that reads half"},
    {"imu_stamps_rounded_s", false,
     "stamps are rounded to this, more coarsely than the IMU beats; import evens them out"},
    {"rate_unit_suspect", false, "the gyro's readings look as if they were of another unit"},
    {"force_unit_suspect", false, "the accelerometer's readings look as if they were of another unit"},
    {"localised", true, "where it is on its map is not known; the estimate is not to be trusted"},
    {"lidar_scale_implausible", false, "the lidar's ranges are of another scale than the motion that the IMU felt"},
    {"imu_readings_beyond_range", false, "readings that the device cannot have measured are left out"},
    {"recording_without_digest", false, "the recording states no digest of its data, so that damage would not show"},
    {"_frozen_since_s", false, "repeats one reading from then on"},
    {"_disagrees_since_s", false, "is off from the others from then on, and left out"},
    {"_silent_since_s", false, "without readings from then on, for half a second at least"},
};

bool is_of(const Verdict& verdict, std::string_view name) {
  return verdict.row.starts_with('_') ? name.ends_with(verdict.row) : name == verdict.row;
}

}  // namespace

std::vector<std::string> verdict_lines(const scenarios::Estimate& estimate) {
  std::vector<std::string> out;
  for (const auto& [name, value] : estimate.health) {
    for (const Verdict& verdict : kVerdicts) {
      const bool since = verdict.row.starts_with('_');  // 0 is a time as well
      if (!is_of(verdict, name) || (!since && (value == 0.0) != verdict.when_zero)) continue;
      out.push_back(fmt::format("{} {:.6g}: {}", name, value, verdict.meaning));
    }
  }
  return out;
}

}  // namespace tumble::tools
