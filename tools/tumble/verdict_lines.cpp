// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verdict_lines.hpp"

#include <fmt/format.h>

namespace tumble::tools {

namespace {

/// Returns null for findings that the line of another finding covers.
const char* meaning(scenarios::Doubt::About about) {
  using About = scenarios::Doubt::About;
  switch (about) {
    case About::readings:
      return "the IMU's readings contradict each other or gravity; the estimate is not to be trusted";
    case About::flights:
      return "in flight the force is not what the turning makes: axes that are flipped or swapped, or a gyro of "
             "another scale";
    case About::stamps:
      return "stamps are rounded to this, more coarsely than the IMU beats; import evens them out";
    case About::rate_unit:
      return "the gyro's readings look as if they were of another unit";
    case About::force_unit:
      return "the accelerometer's readings look as if they were of another unit";
    case About::attitude:
      return "for so many seconds which way is up is not known, as after a gap of the IMU; the covariance says so";
    case About::place:
      return "where it is on its map is not known; the estimate is not to be trusted";
    case About::lidar_scale:
      return "the lidar's ranges are of another scale than the motion that the IMU felt";
    case About::beyond_range:
      return "readings that the device cannot have measured are left out";
    case About::digest:
      return "the recording states no digest of its data, so that damage would not show";
    case About::learnt_rig:
      return "deviations between the lever arm or inertia that --learnt brought and what this run tells by itself: "
             "learnt of another rig? Rates beyond a rail rest on it; the file stays as it is";
    case About::unit_frozen:
      return "repeats one reading from then on";
    case About::unit_disagrees:
      return "is off from the others from then on, and left out";
    case About::unit_silent:
      return "without readings from then on, for half a second at least";
    case About::rates:
      break;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> verdict_lines(const scenarios::Estimate& estimate) {
  std::vector<std::string> out;
  for (const scenarios::Doubt& doubt : estimate.doubts) {
    const char* const said = meaning(doubt.about);
    if (said != nullptr) out.push_back(fmt::format("{} {:.6g}: {}", row_of(doubt), doubt.value, said));
  }
  return out;
}

}  // namespace tumble::tools
