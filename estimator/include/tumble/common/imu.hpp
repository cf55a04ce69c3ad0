// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "tumble/common/status.hpp"
#include "tumble/common/time.hpp"

namespace tumble {

/// Bits of ImuSample::device_clip_flags, which devices that report clipping set.
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

/// One reading of an inertial measurement unit (IMU), in the axes I of the IMU. The rate and the force of a sample are
/// means over the sample's window, which ends at `time_ns`.
struct ImuSample {
  TimeNs time_ns = 0;
  Eigen::Vector3d angular_velocity_rad_s = Eigen::Vector3d::Zero();  ///< measured w_WI_I
  Eigen::Vector3d specific_force_m_s2 =
      Eigen::Vector3d::Zero();         ///< measured f_I: acceleration minus gravity, +9.8 upwards at rest
  std::uint8_t device_clip_flags = 0;  ///< ClipFlag bits; 0 if the device reports none
};

/// Returns whether all rates and forces of a sample are finite.
inline bool is_finite(const ImuSample& sample) {
  return sample.angular_velocity_rad_s.allFinite() && sample.specific_force_m_s2.allFinite();
}

/// Checks one reading for invalid components. Returns `non_finite` or `out_of_range` for the first invalid component. A
/// magnitude above 1e6 is out of range, because no sensor reports such a value. Returns `ok` if all components are
/// valid.
Status check_sample(const ImuSample& sample);

/// Checks the time stamps of two consecutive samples. Returns `time_order` unless time_ns > previous_ns, with the value
/// time_ns and the bound previous_ns. Returns `gap` if the stamps are more than gap_max_s apart, with the gap in
/// seconds as value. Returns `ok` for valid stamps.
Status check_stamp_order(TimeNs time_ns, TimeNs previous_ns, double gap_max_s);

}  // namespace tumble
