// SPDX-License-Identifier: BSD-3-Clause
// Each factor of the hand-held model is tested against its own cost: its gradient is the numerical one, and its
// curvature is that of the squared residuals.
#include "tumble/attitude/detail/hand_held_model.hpp"

#include "oracles/gaussian.hpp"
#include "tests/testing.hpp"
#include "tumble/common/types.hpp"

namespace tumble::hand_held {
namespace {

constexpr double kStep = 1e-5;

struct Point {
  Node here, next;
  Constants constants;
};

Vector3d draw(oracles::Gaussian& noise, double size) {
  const double z = noise(), y = noise(), x = noise();
  return size * Vector3d(x, y, z);
}

Node random_node(oracles::Gaussian& noise) {
  Node node;
  node.q_WI = so3::exp(draw(noise, 1.0));
  node.w_WI_I_rad_s = draw(noise, 5.0);
  node.angular_acceleration_rad_s2 = draw(noise, 30.0);
  node.a_W_m_s2 = draw(noise, 3.0);
  node.v_W_m_s = draw(noise, 1.0);
  node.p_W_m = draw(noise, 0.5);
  return node;
}

Point random_point(std::uint64_t seed, double step_s) {
  oracles::Gaussian noise(seed);
  Point point;
  point.here = random_node(noise);
  point.next = random_node(noise);
  point.next.q_WI =
      point.here.q_WI * so3::exp(rotation_between_nodes(point.here, point.next, step_s) + draw(noise, 0.05));
  point.constants = {draw(noise, 0.1), draw(noise, 0.3), draw(noise, 0.2)};
  return point;
}

using Factor = std::function<double(const Point&, System::StateBlock&, System::StateBlock&, System::BorderBlock&)>;

/// The gradient of a factor is half the negative derivative of its cost, for every unknown.
void expect_gradient(const Factor& factor, const Point& at) {
  System::StateBlock here, next;
  System::BorderBlock corner;
  const double cost = factor(at, here, next, corner);
  EXPECT_GT(cost, 0.0);
  Eigen::VectorXd gradient(2 * kBlockSize + kBorderSize);
  gradient << here.gradient, next.gradient, corner.gradient;
  EXPECT_GT(gradient.norm(), 0.0);
  for (int i = 0; i < gradient.size(); ++i) {
    double sides[2];
    for (int side = 0; side < 2; ++side) {
      Eigen::VectorXd move = Eigen::VectorXd::Zero(gradient.size());
      move[i] = side == 0 ? -kStep : kStep;
      Point moved = at;
      moved.here.move(move.head<kBlockSize>());
      moved.next.move(move.segment<kBlockSize>(kBlockSize));
      moved.constants.move(move.tail<kBorderSize>());
      System::StateBlock unused, unused_next;
      System::BorderBlock unused_corner;
      sides[side] = factor(moved, unused, unused_next, unused_corner);
    }
    const double numerical = -(sides[1] - sides[0]) / (4.0 * kStep);
    // central differences of a cost lose 1e-16 cost / kStep
    EXPECT_NEAR(gradient[i], numerical, 2e-6 * gradient.cwiseAbs().maxCoeff() + 1e-10 * cost / kStep) << i;
  }
}

NodeReadings random_readings(std::uint64_t seed) {
  oracles::Gaussian noise(seed);
  NodeReadings readings;
  for (SensingAxisSums& e : readings.gyro) {
    for (double t : {-0.004, 0.0, 0.003}) {
      const double z = 5.0 * noise();
      e.count += 1.0, e.time_sum_s += t, e.time_squared_sum_s2 += t * t, e.reading_sum += z,
          e.reading_time_sum += z * t;
    }
  }
  readings.force_m_s2 = draw(noise, 8.0);
  readings.force_reading_count = 3.0;
  readings.mean_force_time_s = 0.002;
  return readings;
}

/// State-dependent weights are omitted, because they are constant within an iteration.
ReadingNoise plain_noise() {
  ReadingNoise noise;
  noise.gyro_rad_s = 0.5;
  noise.saturation_limit_sigma_rad_s = 0.2;
  noise.accel_m_s2 = 0.7;
  noise.stationary_rate_sigma_rad_s = 0.1, noise.stationary_velocity_sigma_m_s = 0.2,
  noise.stationary_acceleration_sigma_m_s2 = 0.3;
  return noise;
}

TEST(HandHeldModel, GyroHasItsGradient) {
  for (std::uint64_t seed : {1u, 2u, 3u}) {
    NodeReadings readings = random_readings(seed);
    readings.gyro[1] = {};
    readings.gyro[1].clipped_reading_count = 2.0, readings.gyro[1].clipped_time_s = 0.001;
    readings.gyro[1].mean_saturation_limit = 1.0, readings.gyro[1].saturated_side = seed == 2 ? -1.0 : 1.0;
    Eigen::Matrix3d rows = Eigen::Matrix3d::Identity();
    rows(0, 1) = 0.03, rows(1, 2) = -0.05, rows(2, 0) = 0.02;
    expect_gradient(
        [&](const Point& p, System::StateBlock& here, System::StateBlock&, System::BorderBlock& corner) {
          return add_gyro(readings, rows, plain_noise(), p.here, p.constants, here, corner);
        },
        random_point(seed, 0.01));
  }
}

TEST(HandHeldModel, ForceHasItsGradient) {
  for (std::uint64_t seed : {1u, 2u, 3u}) {
    NodeReadings readings = random_readings(seed);
    if (seed == 2) readings.force_bound_m_s2.y() = 1.0;
    // the rotation from the node to the mean time of the readings is of first order in the rate's error
    readings.mean_force_time_s = 1e-6;
    expect_gradient(
        [&](const Point& p, System::StateBlock& here, System::StateBlock&, System::BorderBlock& corner) {
          return add_force(readings, {0.0, 0.0, -9.81}, plain_noise(), p.here, p.constants, here, corner);
        },
        random_point(seed, 0.01));
  }
}

TEST(HandHeldModel, RestHasItsGradient) {
  expect_gradient([&](const Point& p, System::StateBlock& here, System::StateBlock&,
                      System::BorderBlock&) { return add_rest(plain_noise(), p.here, here); },
                  random_point(4, 0.01));
}

TEST(HandHeldModel, MotionHasItsGradient) {
  Motion::Params params;
  params.step_s = 0.02;
  params.jerk_rad_s3_sqrts = 100.0;
  params.hand_sigma_m_s2 = 3.0, params.hand_tau_s = 0.15;
  params.velocity_m_s = 1.0, params.velocity_tau_s = 0.3;
  params.position_m = 0.5, params.position_tau_s = 1.0;
  const Motion motion(params);
  for (std::uint64_t seed : {1u, 2u, 3u}) {
    const Point at = random_point(seed, params.step_s);
    expect_gradient([&](const Point& p, System::StateBlock& here, System::StateBlock& next,
                        System::BorderBlock&) { return motion.add_motion_model(p.here, p.next, 0.5, here, next); },
                    at);
    expect_gradient([&](const Point& p, System::StateBlock& here, System::StateBlock&,
                        System::BorderBlock&) { return motion.add_bounds(p.here, here); },
                    at);
  }
}

}  // namespace
}  // namespace tumble::hand_held
