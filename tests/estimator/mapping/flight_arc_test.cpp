// SPDX-License-Identifier: BSD-3-Clause
#include "tumble/mapping/detail/flight_arc.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tumble/common/so3.hpp"

namespace tumble {
namespace {

constexpr double kFall_m_s2 = 9.80665;
constexpr TimeNs kFlight_ns = 600'000'000;

MotionState thrown() {
  MotionState start;
  start.time_ns = 1'000'000'000;
  start.p_WI_m = Eigen::Vector3d(1.0, 2.0, 5.0);
  start.q_WI = so3::exp({0.4, -0.3, 1.2});
  start.v_WI_m_s = Eigen::Vector3d(2.0, -1.0, 3.0);
  return start;
}

/// Returns the motion of the IMU at the end of a ballistic flight.
MotionState fly(const FlyingBody& body, const Eigen::Vector3d& w, TimeNs step_ns, double gravity = kFall_m_s2) {
  const MotionState start = thrown();
  std::vector<MotionSample> samples;
  EXPECT_TRUE(flight_arc(body, w, start.time_ns, start.time_ns + kFlight_ns, step_ns, samples).ok());
  SweepTrajectory trajectory;
  EXPECT_TRUE(trajectory.build(start, samples, start.time_ns + kFlight_ns, gravity).ok());
  return trajectory.state(trajectory.duration_s());
}

// equal moments: the rate is constant, the centre of mass follows a parabola; all in closed form
TEST(FlightArc, OfEqualMomentsIsTheClosedForm) {
  FlyingBody body;
  body.p_IB_I_m = Eigen::Vector3d(0.022, 0.085, -0.055);
  const Eigen::Vector3d w(9.0, -4.0, 6.0);
  const MotionState start = thrown();
  const MotionState end = fly(body, w, 5'000'000);
  const double t = seconds(kFlight_ns);
  const Eigen::Quaterniond q = start.q_WI * so3::exp(w * t);
  const Eigen::Vector3d v_WB = start.v_WI_m_s + start.q_WI * w.cross(body.p_IB_I_m);
  const Eigen::Vector3d fall(0.0, 0.0, -kFall_m_s2);
  const Eigen::Vector3d p_WI =
      start.p_WI_m + start.q_WI * body.p_IB_I_m + t * v_WB + 0.5 * t * t * fall - q * body.p_IB_I_m;
  const Eigen::Vector3d v_WI = v_WB + t * fall - q * w.cross(body.p_IB_I_m);
  EXPECT_LT(so3::log(end.q_WI * q.conjugate()).norm(), 1e-12);
  EXPECT_LT((end.v_WI_m_s - v_WI).norm(), 1e-12);
  // the force is constant over a step in the body: third order in the step
  EXPECT_LT((end.p_WI_m - p_WI).norm(), 1e-4);
  // negative control: a body with another centre of mass
  body.p_IB_I_m.setZero();
  EXPECT_GT((fly(body, w, 5'000'000).p_WI_m - p_WI).norm(), 0.01);
}

// unequal moments: without torque, the angular momentum in the world and the energy are constant
TEST(FlightArc, KeepsAngularMomentumAndEnergy) {
  FlyingBody body;
  body.inertia_I_kg_m2 = so3::exp({0.2, 0.5, -0.3}).toRotationMatrix() *
                         Eigen::Vector3d(0.10, 0.13, 0.16).asDiagonal() *
                         so3::exp({0.2, 0.5, -0.3}).toRotationMatrix().transpose();
  const Eigen::Vector3d w(3.0, 14.0, -5.0);
  std::vector<MotionSample> samples;
  ASSERT_TRUE(flight_arc(body, w, 0, kFlight_ns, 2'000'000, samples).ok());
  ASSERT_EQ(samples.size(), 300u);
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  const Eigen::Vector3d momentum = body.inertia_I_kg_m2 * w;
  double turned_most = 0.0;
  for (const MotionSample& sample : samples) {
    const double dt = seconds(sample.time_ns - sample.from_ns);
    // the mean rate of a step belongs to its middle
    const Eigen::Quaterniond middle = q * so3::exp(0.5 * dt * sample.w_WI_I_rad_s);
    const Eigen::Vector3d now = middle * (body.inertia_I_kg_m2 * sample.w_WI_I_rad_s);
    EXPECT_LT((now - momentum).norm(), 1e-4 * momentum.norm());
    EXPECT_NEAR(sample.w_WI_I_rad_s.dot(body.inertia_I_kg_m2 * sample.w_WI_I_rad_s), w.dot(momentum),
                1e-4 * w.dot(momentum));
    turned_most = std::max(turned_most, (sample.w_WI_I_rad_s - w).norm());
    q = q * so3::exp(dt * sample.w_WI_I_rad_s);
  }
  EXPECT_GT(turned_most, 1.0);  // the body wobbles, so a constant rate would be wrong
}

TEST(FlightArc, IsWhatAnAccelerometerOffTheCentreReads) {
  FlyingBody body;
  body.p_IB_I_m = Eigen::Vector3d(0.1, 0.0, 0.0);
  // spinning about z, the IMU is pulled towards the centre, which is ahead along x
  EXPECT_LT((flight_force(body, {0, 0, 10}, Eigen::Vector3d::Zero()) - Eigen::Vector3d(10, 0, 0)).norm(), 1e-12);
  EXPECT_LT((flight_force(body, Eigen::Vector3d::Zero(), {0, 0, 10}) - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
}

TEST(FlightArc, RefusesWhatItCannotFly) {
  std::vector<MotionSample> samples;
  FlyingBody body;
  EXPECT_EQ(flight_arc(body, {0, 0, 1}, 10, 10, 1, samples).error_code, ErrorCode::time_order);
  EXPECT_EQ(flight_arc(body, {0, 0, 1}, 0, 10, 0, samples).error_code, ErrorCode::time_order);
  EXPECT_EQ(flight_arc(body, {0, 0, std::numeric_limits<double>::quiet_NaN()}, 0, 10, 1, samples).error_code,
            ErrorCode::non_finite);
  body.inertia_I_kg_m2.setZero();
  EXPECT_EQ(flight_arc(body, {0, 0, 1}, 0, 10, 1, samples).error_code, ErrorCode::degenerate);
  EXPECT_TRUE(samples.empty());
}

}  // namespace
}  // namespace tumble
