// SPDX-License-Identifier: BSD-3-Clause
#include "tests/estimator/mapping/room_tumble.hpp"

#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::test {

using Odometry = LidarInertialOdometry;

Odometry::Params rig_params() {
  Odometry::Params params;
  params.T_IL.translation() = Eigen::Vector3d(0.02, 0.087, 0.04);
  params.T_IL.linear() = so3::exp({0.0, 0.0, -1.5707963267948966}).toRotationMatrix();
  return params;
}

const RoomTumble& room_tumble() {
  static const RoomTumble data = [] {
    constexpr int kSweeps = 26;
    RoomTumble out;
    out.imu = make_imu(out.motion, 0.1 * kSweeps);
    for (int i = 0; i < kSweeps; ++i) {
      out.sweeps.push_back(make_sweep(Room::box_with_pillars(), out.motion, rig_params().T_IL, i, kRoomNoise_m));
    }
    return out;
  }();
  return data;
}

AngularRateState clipped_rate(const ImuSample& sample, double rail_rad_s) {
  AngularRateState rate = believe(sample);
  for (int axis = 0; axis < 3; ++axis) {
    double& w = rate.w_WI_I_rad_s[axis];
    if (std::abs(w) < rail_rad_s) continue;
    w = std::copysign(rail_rad_s, w);
    rate.clipped_axes |= static_cast<std::uint8_t>(1 << axis);
  }
  return rate;
}

void feed_imu(Odometry& odometry, int sweep, double rail_rad_s) {
  for (int k = sweep * kSamplesPerSweep; k < (sweep + 1) * kSamplesPerSweep; ++k) {
    const ImuSample& sample = room_tumble().imu[static_cast<std::size_t>(k)];
    ASSERT_TRUE(odometry.add_imu(sample, clipped_rate(sample, rail_rad_s)).ok());
  }
}

Status add_sweep(Odometry& odometry, int sweep, std::span<const LidarPoint> points, Odometry::SweepResult& report) {
  return odometry.add_sweep(sweep * kSweep_ns, (sweep + 1) * kSweep_ns, points, report);
}

PoseError error_of(const PoseState& pose) {
  const double t = 1e-9 * static_cast<double>(pose.time_ns);
  const Motion& motion = room_tumble().motion;
  return {(pose.position_W_m - motion.p_m(t)).norm(),
          so3::logarithm(pose.orientation_W * motion.q(t).conjugate()).norm(),
          (pose.velocity_W_m_s - motion.v_m_s(t)).norm()};
}

std::vector<Odometry::SweepResult> run(Odometry& odometry, int from, int to, double rail_rad_s) {
  std::vector<Odometry::SweepResult> reports;
  for (int i = from; i < to; ++i) {
    feed_imu(odometry, i, rail_rad_s);
    const Status status =
        add_sweep(odometry, i, room_tumble().sweeps[static_cast<std::size_t>(i)], reports.emplace_back());
    EXPECT_TRUE(status.ok()) << status.message();
  }
  return reports;
}

bool same(const Odometry::SweepResult& a, const Odometry::SweepResult& b) {
  if (a.verdict != b.verdict || a.trajectory.size() != b.trajectory.size() || a.iterations != b.iterations)
    return false;
  for (std::size_t i = 0; i < a.trajectory.size(); ++i) {
    const PoseState &p = a.trajectory[i], &q = b.trajectory[i];
    if (p.time_ns != q.time_ns || p.position_W_m != q.position_W_m ||
        p.orientation_W.coeffs() != q.orientation_W.coeffs() || p.velocity_W_m_s != q.velocity_W_m_s ||
        p.covariance != q.covariance) {
      return false;
    }
  }
  return a.inlier_ratio == b.inlier_ratio && a.eigenvalue_ratio == b.eigenvalue_ratio &&
         a.map_points_added == b.map_points_added;
}

}  // namespace tumble::test
