// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

enum ClipFlag : std::uint8_t {
  kClipGyroX = 1,
  kClipGyroY = 2,
  kClipGyroZ = 4,
  kClipAccelX = 8,
  kClipAccelY = 16,
  kClipAccelZ = 32,
};
inline constexpr std::uint8_t kClipGyro = kClipGyroX | kClipGyroY | kClipGyroZ;
inline constexpr std::uint8_t kClipAccel = kClipAccelX | kClipAccelY | kClipAccelZ;

/// One reading of an inertial measurement unit (IMU), in the IMU's own axes I. The angular rate and the specific force
/// are means over a time window that ends at `time_ns`.
struct ImuSample {
  TimeNs time_ns = 0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< measured angular velocity w_WI_I
  Eigen::Vector3d specific_force_m_s2 =
      Eigen::Vector3d::Zero();         ///< measured f_I: acceleration minus gravity; +9.8 upwards at rest
  std::uint8_t device_clip_flags = 0;  ///< ClipFlag bits; 0 if the device reports no clipping
};

inline bool is_finite(const ImuSample& sample) {
  return sample.angular_velocity_rad_s.allFinite() && sample.specific_force_m_s2.allFinite();
}

/// Returns `non_finite` for NaN and infinity, `out_of_range` for a magnitude above 1e6, and otherwise `ok`.
Status check_sample(const ImuSample& sample);

/// Returns `time_order` if `time_ns` is not later than `previous_ns`. Returns `gap`, with the gap in seconds, if the
/// time stamps are more than `gap_max_s` apart.
Status check_stamp_order(TimeNs time_ns, TimeNs previous_ns, double gap_max_s);

}  // namespace tumble
