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
      return "the IMU's readings contradict each other or gravity; do not use the estimate";
    case About::flights:
      return "the specific force in flight does not fit the rotation; axes may be flipped or swapped, or the gyro may "
             "have a wrong scale";
    case About::stamps:
      return "time stamps are rounded to this value, which is coarser than the IMU's period; import again to smooth "
             "them";
    case About::rate_unit:
      return "the gyro's readings seem to have another unit";
    case About::force_unit:
      return "the accelerometer's readings seem to have another unit";
    case About::attitude:
      return "the vertical is unknown for this many seconds, for example after a gap of the IMU; the covariance "
             "includes this uncertainty";
    case About::place:
      return "the position on the map is unknown; do not use the estimate";
    case About::lidar_scale:
      return "the scale of the lidar's ranges contradicts the motion measured by the IMU";
    case About::beyond_range:
      return "readings beyond the range of the device are left out";
    case About::digest:
      return "the recording contains no digest of its data, so damage cannot be detected";
    case About::learnt_rig:
      return "deviations between the lever arm or inertia in the --learnt file and the values estimated in this run; "
             "the file may belong to another rig. Rates beyond saturation depend on these values; the file is "
             "unchanged";
    case About::unit_frozen:
      return "repeats one reading from this time on";
    case About::unit_disagrees:
      return "disagrees with the other IMUs from this time on and is left out";
    case About::unit_silent:
      return "delivers no readings from this time on, for at least half a second";
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
