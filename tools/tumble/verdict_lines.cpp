// SPDX-License-Identifier: BSD-3-Clause
#include "tools/tumble/verdict_lines.hpp"

#include <fmt/format.h>

namespace tumble::tools {

namespace {

/// Returns null for findings that the line of another finding covers.
const char* meaning(scenarios::HealthFinding::About about) {
  using About = scenarios::HealthFinding::About;
  switch (about) {
    case About::readings:
      return "the IMU's readings contradict each other or gravity; do not use the estimate";
    case About::flights:
      return "the specific force in free flight contradicts the rotation; axes may be flipped or swapped, or the gyro "
             "may have a wrong scale";
    case About::stamps:
      return "the time stamps are rounded to this value, which is coarser than the IMU's period; import the recording "
             "again to smooth the time stamps";
    case About::rate_unit:
      return "the gyro's readings seem to be in another unit than rad/s; check the unit of the recording";
    case About::force_unit:
      return "the accelerometer's readings seem to be in another unit than m/s^2; check the unit of the recording";
    case About::attitude:
      return "the direction of gravity is unknown for this many seconds, for example after a gap of the IMU; the "
             "covariance includes this uncertainty";
    case About::place:
      return "the position on the map is unknown; do not use the estimate";
    case About::lidar_scale:
      return "the scale of the lidar's ranges contradicts the motion measured by the IMU";
    case About::beyond_range:
      return "the method leaves out readings beyond the range of the device";
    case About::digest:
      return "the recording contains no digest of its data, so the program cannot detect damage";
    case About::learnt_rig:
      return "the lever arm or inertia in the --learnt file differs from the estimate of this run by this number of "
             "standard deviations, so the file may belong to another rig. Estimated rates beyond saturation depend on "
             "these values. The program left the file unchanged";
    case About::unit_frozen:
      return "the readings are constant from this time on; check the sensor";
    case About::unit_disagrees:
      return "the IMU disagrees with the other IMUs from this time on, and the method leaves out its readings";
    case About::unit_silent:
      return "the IMU delivers no readings from this time on, for at least half a second";
    case About::rates:
      break;
  }
  return nullptr;
}

}  // namespace

std::vector<std::string> verdict_lines(const scenarios::Estimate& estimate) {
  std::vector<std::string> out;
  for (const scenarios::HealthFinding& finding : estimate.findings) {
    const char* const said = meaning(finding.about);
    if (said != nullptr) out.push_back(fmt::format("{} {:.6g}: {}", row_of(finding), finding.value, said));
  }
  return out;
}

}  // namespace tumble::tools
