// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "tests/testing.hpp"
#include "tumble/angular_velocity/types.hpp"
#include "tumble/common/types.hpp"
#include "tumble/mapping/detail/sweep_trajectory.hpp"
#include "tumble/mapping/types.hpp"

/// synthetic_room.hpp provides an analytic world, motion and sensors, independent of the mapping code.
namespace tumble::test {

inline constexpr double kRoomGravity_m_s2 = 9.80665;
inline constexpr int kSamplesPerSweep = 10;
inline constexpr int kHalfColumns = 450;  ///< columns of a sweep, for tests with half of them
inline constexpr double kRoomNoise_m = 0.01;

/// Room consists of planes (point, normal towards the free side) and vertical round pillars.
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

  /// Returns a box room of 24 m x 18 m x 8 m about the origin, floor at z = -1.5 m.
  static Room box();
  /// Returns the box room with six pillars of various radii.
  static Room box_with_pillars();
  static Room floor_only();
  /// Returns two walls along x and a floor.
  static Room corridor();
  /// Returns a floor and two walls that meet.
  static Room corner();

  /// Returns the distance along a unit ray to the first surface; negative if there is none within 100 m.
  double cast(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) const;
  /// Returns the distance of a point to the nearest surface (planes unbounded).
  double distance(const Eigen::Vector3d& point) const;
};

/// Motion of the IMU: rest until `rest_s`, then a spin that rises within half a second about rotating axes, while the
/// position swings through metres. The motion is smooth, with the position in closed form.
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

/// Returns samples at 100 Hz, or another whole divisor of a second, up to `duration_s`: the rate is the exact increment
/// of attitude over each window, the specific force the mean over the window in the rotating axes.
std::vector<ImuSample> make_imu(const Motion& motion, double duration_s, double rate_hz = 100.0);
std::vector<MotionSample> motion_samples(const std::vector<ImuSample>& imu);
/// Returns the rate of a method that accepts the gyro's reading.
AngularRateState believe(const ImuSample& sample);

/// Returns sixteen rings by `columns` in 0.1 s, each ray from the pose at its own time, with uniform range noise of
/// standard deviation `noise_m`, drawn from (sweep, point) alone.
std::vector<LidarPoint> make_sweep(const Room& room, const Motion& motion, const Eigen::Isometry3d& T_IL, int sweep,
                                   double noise_m = 0.0, int columns = 900);
constexpr std::int64_t kSweep_ns = 100'000'000;

/// Returns a number in [0, 1) from a 64-bit counter.
double uniform(std::uint64_t counter);

}  // namespace tumble::test
