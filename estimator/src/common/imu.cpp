// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/common/imu.hpp"

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "tumble/common/detail/sample_check.hpp"

namespace tumble {

namespace {

Status check_reading(const Eigen::Vector3d& reading, const char* field) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!std::isfinite(reading[axis])) return {ErrorCode::non_finite, field, reading[axis], kReadingMax};
    if (std::abs(reading[axis]) > kReadingMax) return {ErrorCode::out_of_range, field, reading[axis], kReadingMax};
  }
  return {};
}

}  // namespace

Status check_sample(const ImuSample& sample) {
  const Status rate = check_reading(sample.angular_velocity_rad_s, "angular_velocity_rad_s");
  return rate.ok() ? check_reading(sample.specific_force_m_s2, "specific_force_m_s2") : rate;
}

Status check_stamp_order(TimeNs time_ns, TimeNs previous_ns, double gap_max_s) {
  if (time_ns <= previous_ns) {
    return {ErrorCode::time_order, "time_ns", static_cast<double>(time_ns), static_cast<double>(previous_ns)};
  }
  // The difference of two signed 64-bit time stamps may overflow.
  const std::uint64_t gap_ns = static_cast<std::uint64_t>(time_ns) - static_cast<std::uint64_t>(previous_ns);
  const double gap_s = static_cast<double>(gap_ns) * 1e-9;
  if (gap_s > gap_max_s) return {ErrorCode::gap, "time_s since the last sample", gap_s, gap_max_s};
  return {};
}

Status check_stamp(TimeNs stamp_ns, const char* field) {
  if (stamp_ns >= -kStampMax_ns && stamp_ns <= kStampMax_ns) return {};
  return {ErrorCode::out_of_range, field, static_cast<double>(stamp_ns), static_cast<double>(kStampMax_ns)};
}

Status check_samples(std::span<const ImuSample> samples, double gap_max_s) {
  for (std::size_t k = 0; k < samples.size(); ++k) {
    if (const Status status = check_sample(samples[k]); !status.ok()) return status;
    if (k == 0) continue;
    const Status status = check_stamp_order(samples[k].time_ns, samples[k - 1].time_ns, gap_max_s);
    if (!status.ok()) return status;
  }
  return {};
}

}  // namespace tumble
