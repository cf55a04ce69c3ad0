// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/attitude/timing.hpp"

#include <cmath>
#include <cstdint>

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
  const double last = static_cast<double>(last_time_ns);
  if (time_ns <= last_time_ns) return {Trouble::time_order, "time_ns", static_cast<double>(time_ns), last};
  // unsigned: the difference of two 64-bit stamps may not fit into a signed one
  const std::uint64_t span_ns = static_cast<std::uint64_t>(time_ns) - static_cast<std::uint64_t>(last_time_ns);
  const double span_s = static_cast<double>(span_ns) * 1e-9;
  if (span_s > gap_max_s) return {Trouble::gap, "time_ns", static_cast<double>(time_ns), last + gap_max_s * 1e9};
  dt_s = span_s;
  return {};
}

Status check(const ImuSample& sample) {
  const Status rate = check_vector(sample.angular_velocity_rad_s, "angular_velocity_rad_s");
  return rate.ok() ? check_vector(sample.specific_force_m_s2, "specific_force_m_s2") : rate;
}

}  // namespace tumble
