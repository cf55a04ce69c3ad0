// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/detail/timing.hpp"

#include <cmath>

namespace tumble {

namespace {

constexpr double kLargest = 1e6;

Status check_vector(const Eigen::Vector3d& value, const char* field) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(value[axis])) return {Trouble::non_finite, field, value[axis], kLargest};
    if (std::abs(value[axis]) > kLargest) return {Trouble::out_of_range, field, value[axis], kLargest};
  }
  return {};
}

}  // namespace

Status elapsed(TimeNs time_ns, TimeNs last_time_ns, double gap_max_s, double& dt_s) {
  if (const Status bad = check_follows(time_ns, last_time_ns, gap_max_s); !bad.ok()) return bad;
  dt_s = seconds(time_ns - last_time_ns);  // fits: gap_max_s is some hours at the most
  return {};
}

Status check(const ImuSample& sample) {
  const Status rate = check_vector(sample.angular_velocity_rad_s, "angular_velocity_rad_s");
  return rate.ok() ? check_vector(sample.specific_force_m_s2, "specific_force_m_s2") : rate;
}

}  // namespace tumble
