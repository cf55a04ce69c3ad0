// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "sim/lidar/lidar_simulation.hpp"
#include "sim/lidar/test_worlds.hpp"
#include "tests/testing.hpp"

/// This namespace has a lidar, a motion and a closed room whose ranges are known in closed form.
namespace tumble::sim::testing {

inline constexpr std::int64_t kPeriod_ns = 500000;

struct Motion {
  std::vector<Vector3d> p_WB_m;
  std::vector<Quaterniond> q_WB;
  MotionTrack track() const { return {kPeriod_ns, p_WB_m, q_WB}; }
};

/// Returns a motion with constant velocity and constant rate about a fixed axis, which the interpolation follows
/// exactly.
inline Motion moving(double duration_s, const Vector3d& start_m, const Vector3d& velocity_m_s,
                     const Vector3d& rate_rad_s) {
  Motion motion;
  const auto samples = static_cast<int>(std::lround(duration_s * 1e9 / kPeriod_ns)) + 1;
  for (int i = 0; i < samples; ++i) {
    const double t = i * kPeriod_ns * 1e-9;
    const double angle = rate_rad_s.norm() * t;
    motion.p_WB_m.push_back(start_m + t * velocity_m_s);
    motion.q_WB.push_back(angle > 0.0 ? Quaterniond(Eigen::AngleAxisd(angle, rate_rad_s.normalized()))
                                      : Eigen::Quaterniond::Identity());
  }
  return motion;
}

inline Motion resting(double duration_s, const Vector3d& at_m = Eigen::Vector3d::Zero()) {
  return moving(duration_s, at_m, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero());
}

struct Cast {
  LidarRecord record;
  LidarTruth truth;
};

inline Cast cast(const engine::World& world, const SensorSpec& sensor, const Motion& motion, int threads = 1,
                 const Isometry3d& T_BL = Eigen::Isometry3d::Identity(), std::uint64_t seed = 1) {
  Cast out;
  simulate_lidar(world, sensor, T_BL, motion.track(), seed, threads, out.record, out.truth);
  return out;
}

/// kRoom is half the size of a closed room of 6 m x 10 m x 4 m, seen from inside.
inline const Vector3d kRoom(3.0, 5.0, 2.0);
inline engine::World room() {
  return world_of("<mujoco><worldbody><geom name='room' type='box' size='3 5 2'/></worldbody></mujoco>");
}

/// Returns the closed form of the range inside the room.
inline double room_range(const Vector3d& origin, const Vector3d& direction) {
  double range = 1e9;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] != 0.0) {
      range = std::min(range, (std::copysign(kRoom[axis], direction[axis]) - origin[axis]) / direction[axis]);
    }
  }
  return range;
}

inline double distance_to_walls(const Vector3d& p) {
  return std::abs((p.cwiseAbs() - kRoom).maxCoeff());
}

inline Isometry3d mounting() {
  Isometry3d T_BL = Eigen::Isometry3d::Identity();
  T_BL.linear() = Eigen::AngleAxisd(-1.2, Vector3d(0.1, 0.2, 1.0).normalized()).toRotationMatrix();
  T_BL.translation() = Vector3d(0.05, -0.1, 0.09);
  return T_BL;
}

inline void expect_same(const Cast& a, const Cast& b) {
  EXPECT_EQ(a.record.sweep_start_ns, b.record.sweep_start_ns);
  EXPECT_EQ(a.record.sweep_first, b.record.sweep_first);
  EXPECT_EQ(a.record.position_L_m, b.record.position_L_m);
  EXPECT_EQ(a.record.range_m, b.record.range_m);
  EXPECT_EQ(a.record.intensity, b.record.intensity);
  EXPECT_EQ(a.record.offset_ns, b.record.offset_ns);
  EXPECT_EQ(a.record.ring, b.record.ring);
  EXPECT_EQ(a.truth.hit_W_m, b.truth.hit_W_m);
  EXPECT_EQ(a.truth.surface_id, b.truth.surface_id);
}

}  // namespace tumble::sim::testing
