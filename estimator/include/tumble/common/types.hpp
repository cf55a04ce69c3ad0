// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "tumble/common/status.hpp"

namespace tumble {

/// Largest magnitude of a time stamp that the odometry classes accept: 97 years. A sum or difference of up to three
/// accepted time stamps fits into TimeNs.
inline constexpr TimeNs kStampMax_ns = 3'070'000'000'000'000'000;

/// Converts nanoseconds to seconds, with a relative error of at most 2^-52 for durations below 104 days.
constexpr double seconds(TimeNs span_ns) {
  return static_cast<double>(span_ns) * 1e-9;
}

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
  bool operator==(const ImuSample&) const = default;
};

inline bool is_finite(const ImuSample& sample) {
  return sample.angular_velocity_rad_s.allFinite() && sample.specific_force_m_s2.allFinite();
}

/// Returns `non_finite` if a component is NaN or infinite, `out_of_range` if the magnitude of a component exceeds 1e6,
/// and otherwise `ok`.
Status check_sample(const ImuSample& sample);

/// Returns `time_order` if `time_ns` is not later than `previous_ns`. Returns `gap` if `time_ns` is more than
/// `gap_max_s` after `previous_ns`; Status::value is the time difference in seconds.
Status check_stamp_order(TimeNs time_ns, TimeNs previous_ns, double gap_max_s);

/// Attitude of a sensor or body A in the world frame W at one time. The quaternion `orientation_W` is q_WA, which
/// rotates vectors from the axes of A to the axes of W.
struct AttitudeState {
  TimeNs time_ns = 0;
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  /// Covariance of the attitude error phi in world axes, with q_true = Exp(phi) * q_WA. A zero matrix means that the
  /// covariance is not estimated.
  Eigen::Matrix3d covariance_rad2 = Eigen::Matrix3d::Zero();
};

/// Pose and velocity of a frame A in the world frame W at one time. The quaternion `orientation_W` is q_WA, which
/// rotates vectors from the axes of A to the axes of W.
struct PoseState {
  TimeNs time_ns = 0;
  Eigen::Vector3d position_W_m = Eigen::Vector3d::Zero();
  Eigen::Quaterniond orientation_W = Eigen::Quaterniond::Identity();
  Eigen::Vector3d velocity_W_m_s = Eigen::Vector3d::Zero();
  /// Covariance of position error [m] and attitude error phi [rad], in this order, both in world axes. The attitude
  /// error is defined by q_true = Exp(phi) * q_WA. A zero matrix means that the covariance is not estimated.
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();

  /// Returns pose, velocity and covariance of a frame B that is rigidly attached to A, for example `base_link`.
  /// @param T_AB           pose of B in axes of A
  /// @param w_WA_A_rad_s   angular velocity of A in axes of A, which determines the velocity of B's origin
  PoseState transformed_to(const Eigen::Isometry3d& T_AB, const Eigen::Vector3d& w_WA_A_rad_s) const;
};

/// Mode of contact between the rolling sphere and the floor.
enum class ContactMode : std::uint8_t {
  grip,            ///< the contact point is at rest; the floor is level
  slip,            ///< the contact point moves along the floor: the sphere spins too fast or slides
  bump_or_flight,  ///< the contact point also rises or falls over an obstacle, or the sphere flies
  incline,         ///< the contact point is at rest; the floor has an estimated slope
  rough,           ///< the contact point is at rest; the floor rises and falls about the level
};

}  // namespace tumble

namespace tumble::so3 {

/// Returns the skew-symmetric matrix [v]x with [v]x w = v x w.
Eigen::Matrix3d hat(const Eigen::Vector3d& v);

/// Returns the unit quaternion of a rotation by |phi| radians about the vector phi.
Eigen::Quaterniond exp(const Eigen::Vector3d& phi);

/// Returns the shortest rotation vector (length at most pi) of a unit quaternion. For a half turn, the first non-zero
/// component of the rotation vector is positive.
Eigen::Vector3d logarithm(const Eigen::Quaterniond& q);

/// Returns the left Jacobian J_l(phi) of SO(3), defined by Exp(phi + d) = Exp(J_l d) Exp(phi) to first order in d.
Eigen::Matrix3d left_jacobian(const Eigen::Vector3d& phi);

/// Returns the inverse of the left Jacobian of SO(3), which is finite for |phi| < 2 pi.
Eigen::Matrix3d left_jacobian_inverse(const Eigen::Vector3d& phi);

/// Returns the rotation by the smallest angle that turns the unit vector `from` into the unit vector `to`.
Eigen::Quaterniond shortest_arc(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace tumble::so3

/// A program and the compiled library must use the same memory layout for Eigen's matrices and the standard library's
/// containers. If the layouts differ, for example because of EIGEN_MAX_STATIC_ALIGN_BYTES or _GLIBCXX_DEBUG, the linker
/// reports that CompilerSettingsCheck<...>::link_time_check is undefined.
namespace tumble::detail {

#ifdef _GLIBCXX_DEBUG
inline constexpr bool kCheckedContainers = true;
#else
inline constexpr bool kCheckedContainers = false;
#endif

#ifdef EIGEN_DEFAULT_TO_ROW_MAJOR
inline constexpr bool kRowMajor = true;
#else
inline constexpr bool kRowMajor = false;
#endif

template <int eigen_static_alignment, bool eigen_malloc_is_aligned, bool eigen_row_major, std::size_t eigen_index_bytes,
          bool checked_containers>
struct CompilerSettingsCheck {
  static const char link_time_check;
};

using CurrentCompilerSettings = CompilerSettingsCheck<EIGEN_MAX_STATIC_ALIGN_BYTES, EIGEN_MALLOC_ALREADY_ALIGNED != 0,
                                                      kRowMajor, sizeof(Eigen::Index), kCheckedContainers>;

template <>
const char CurrentCompilerSettings::link_time_check;  // a declaration; src/common/types.cpp has the definition

/// Each source file references `link_time_check`, so the linker compares the memory layouts of program and library.
[[gnu::used]] static const char* const kLinkTimeCheckReference = &CurrentCompilerSettings::link_time_check;

}  // namespace tumble::detail
