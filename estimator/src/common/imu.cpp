// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/imu.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

namespace tumble {

namespace {

double first_non_finite(const Eigen::Vector3d& v) {
  for (int j = 0; j < 2; ++j) {
    if (!std::isfinite(v[j])) return v[j];
  }
  return v[2];
}

}  // namespace

Status check_sample(const ImuSample& sample) {
  constexpr double kLargest = std::numeric_limits<double>::max();
  if (!sample.angular_velocity_rad_s.allFinite()) {
    return {Trouble::non_finite, "angular_velocity_rad_s", first_non_finite(sample.angular_velocity_rad_s), kLargest};
  }
  if (!sample.specific_force_m_s2.allFinite()) {
    return {Trouble::non_finite, "specific_force_m_s2", first_non_finite(sample.specific_force_m_s2), kLargest};
  }
  return {};
}

Status check_follows(TimeNs time_ns, TimeNs previous_ns, double gap_max_s) {
  if (time_ns <= previous_ns) {
    return {Trouble::time_order, "time_ns", static_cast<double>(time_ns), static_cast<double>(previous_ns)};
  }
  // unsigned: the difference of two 64-bit stamps may not fit into a signed one
  const std::uint64_t gap_ns = static_cast<std::uint64_t>(time_ns) - static_cast<std::uint64_t>(previous_ns);
  const double gap_s = static_cast<double>(gap_ns) * 1e-9;
  if (gap_s > gap_max_s) return {Trouble::gap, "time_s since the last sample", gap_s, gap_max_s};
  return {};
}

}  // namespace tumble
