// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "tumble/angular_velocity/rate_state.hpp"
#include "tumble/common/imu.hpp"
#include "tumble/mapping/lidar.hpp"
#include "tumble/mapping/sweep_trajectory.hpp"

/// An analytic world, motion and sensors. The mapping code is tested with this world, which does not use the mapping
/// code.
namespace tumble::test {

inline constexpr double kRoomGravity_m_s2 = 9.80665;
inline constexpr int kSamplesPerSweep = 10;
inline constexpr int kHalfColumns = 450;  ///< columns of a sweep, for tests with half of them
inline constexpr double kRoomNoise_m = 0.01;

/// Planes (point, normal towards the free side) and vertical round pillars.
struct Room {
  struct Plane {
    Eigen::Vector3d point_m, normal;
  };
  struct Pillar {
    Eigen::Vector2d centre_m;
    double radius_m;
  };
  std::vector<Plane> planes;
  std::vector<Pillar> pillars;

  /// Box room of 24 m x 18 m x 8 m about the origin, floor at z = -1.5 m.
  static Room box();
  /// The same room with six pillars of different radii.
  static Room box_with_pillars();
  static Room floor_only();
  /// Two walls along x and a floor.
  static Room corridor();
  /// A floor and two walls that meet.
  static Room corner();

  /// Returns the distance along a unit ray to the first surface; negative if there is none within 100 m.
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// Returns the distance of a point to the nearest surface (planes are unbounded).
  double distance(const Eigen::Vector3d& point) const;
};

/// Smooth motion of the IMU: rest until `rest_s`, then a spin that grows within half a second about changing axes,
/// while the position oscillates by metres. The position is a closed form.
struct Motion {
  double rest_s = 0.3;
  double spin_rad_s = 15.0;
  double second_spin_rad_s = 4.0;
  double swing = 1.0;  ///< scale of the translation

  Eigen::Vector3d p_m(double t) const;
  Eigen::Vector3d v_m_s(double t) const;
  Eigen::Vector3d a_m_s2(double t) const;
  Eigen::Quaterniond q(double t) const;
  Eigen::Isometry3d pose(double t) const;
};

/// Returns samples up to `duration_s` at 100 Hz, or at another integer divisor of a second. The rate is the exact
/// increment of attitude over each window; the specific force is the mean over the window in the rotating axes.
std::vector<ImuSample> make_imu(const Motion& motion, double duration_s, double rate_hz = 100.0);
std::vector<MotionSample> motion_samples(const std::vector<ImuSample>& imu);
/// Returns the rate of a method that ignores saturation.
RateState believe(const ImuSample& sample);

/// Returns a sweep with sixteen rings of `columns` in 0.1 s, each ray from the pose at its time. The range noise is
/// uniform with standard deviation `noise_m`, and depends only on (sweep, point).
std::vector<LidarPoint> make_sweep(const Room& room, const Motion& motion, const Eigen::Isometry3d& T_IL, int sweep,
                                   double noise_m = 0.0, int columns = 900);
constexpr std::int64_t kSweep_ns = 100'000'000;

/// Converts a 64-bit counter to a number in [0, 1).
double uniform(std::uint64_t counter);

}  // namespace tumble::test
