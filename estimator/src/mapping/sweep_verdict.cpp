// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/lidar_inertial_odometry.hpp"

namespace tumble {

const char* to_string(SweepVerdict verdict) {
  switch (verdict) {
    case SweepVerdict::first:
      return "first";
    case SweepVerdict::registered:
      return "registered";
    case SweepVerdict::degenerate:
      return "degenerate";
    case SweepVerdict::rejected:
      return "rejected";
  }
  return "unknown";
}

}  // namespace tumble
