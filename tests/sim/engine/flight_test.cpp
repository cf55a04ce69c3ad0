// SPDX-License-Identifier: BSD-3-Clause
#include "sim/compose.hpp"
#include "sim/engine/physics.hpp"
#include "sim/truth/record_truth.hpp"
#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

/// Flight has the rig, spun near its unstable axis at 18 rad/s and thrown 100 m above the hill.
class Flight : public ::testing::Test {
 protected:
  Flight() : world_(engine::compose(resolve(tumble_down(1.0, 100.0)), models_folder())), physics_(world_) {
    start_.p_WB_m = {0, 0, 100};
    start_.v_WB_m_s = {1.5, -0.5, 20.0};
    start_.w_WB_B_rad_s = {0.3, 0.2, 18.0};  // z: the middle moment of inertia of the defaults
    physics_.set_state(start_);
  }

  double energy_j(const BodyState& s) const {
    const Vector3d J = Eigen::Map<const Vector3d>(world_.model->body_inertia + 3 * world_.robot_body);
    return 0.5 * J.dot(s.w_WB_B_rad_s.cwiseAbs2());
  }
  Vector3d momentum_W(const BodyState& s) const {
    const Vector3d J = Eigen::Map<const Vector3d>(world_.model->body_inertia + 3 * world_.robot_body);
    return s.q_WB * J.cwiseProduct(s.w_WB_B_rad_s);
  }
  BodyState fly(double duration_s) {
    for (int k = 0; k < std::lround(duration_s / physics_.step_s()); ++k) physics_.step({});
    return physics_.state();
  }

  engine::World world_;
  engine::Physics physics_;
  BodyState start_;
};

TEST_F(Flight, KeepsEnergyAndMomentumForFiveSeconds) {
  const BodyState end = fly(5.0);
  EXPECT_GT(std::abs(end.w_WB_B_rad_s.x()) + std::abs(end.w_WB_B_rad_s.y()), 0.0);
  EXPECT_NEAR(energy_j(end) / energy_j(start_), 1.0, 1e-8);                                           // measured 1e-15
  EXPECT_NEAR((momentum_W(end) - momentum_W(start_)).norm() / momentum_W(start_).norm(), 0.0, 1e-5);  // measured 2.2e-7
}

TEST_F(Flight, EulerIntegrationWouldNotKeepThem) {
  world_.model->opt.integrator = mjINT_EULER;
  const BodyState end = fly(5.0);
  EXPECT_GT(std::abs(energy_j(end) / energy_j(start_) - 1.0), 1e-3);  // 3 % in the reference study
}

TEST_F(Flight, FallsAsGalileoSays) {
  const BodyState end = fly(5.0);
  const Vector3d g(0, 0, -9.80665);
  EXPECT_NEAR((end.p_WB_m - (start_.p_WB_m + 5.0 * start_.v_WB_m_s + 12.5 * g)).norm(), 0.0, 1e-9);
  EXPECT_NEAR((end.v_WB_m_s - (start_.v_WB_m_s + 5.0 * g)).norm(), 0.0, 1e-9);
}

TEST_F(Flight, CentreOfMassFeelsNothing) {
  double largest = 0.0, largest_beside = 0.0;
  BodyState before = physics_.state();
  for (int k = 0; k < 4000; ++k) {
    physics_.step({});
    const BodyState after = physics_.state();
    largest = std::max(largest, specific_force_B(before, after, Vector3d::Zero(), 9.80665).norm());
    largest_beside = std::max(largest_beside, specific_force_B(before, after, {0.01, 0, 0}, 9.80665).norm());
    before = after;
  }
  EXPECT_LT(largest, 1e-6);        // measured 3e-12
  EXPECT_GT(largest_beside, 1.0);  // 1 cm off: w^2 r = 3.2 m/s^2
}

TEST_F(Flight, WrenchActsAtTheCentreOfMassInWorldAxes) {
  start_.w_WB_B_rad_s.setZero();
  start_.q_WB = Eigen::AngleAxisd(1.0, Vector3d(1, 2, 3).normalized());
  physics_.set_state(start_);
  for (int k = 0; k < 200; ++k) physics_.step({{8.0, 0, 0}, {0, 0, 0}});
  BodyState s = physics_.state();
  EXPECT_NEAR(s.v_WB_m_s.x() - 1.5, 8.0 / 8.0 * 0.1, 1e-9);
  EXPECT_NEAR(s.w_WB_B_rad_s.norm(), 0.0, 1e-12);
  for (int k = 0; k < 200; ++k) physics_.step({{0, 0, 0}, {0, 0.4, 0}});
  EXPECT_NEAR((momentum_W(physics_.state()) - Vector3d(0, 0.04, 0)).norm(), 0.0, 1e-9);
}

}  // namespace
}  // namespace tumble::sim
