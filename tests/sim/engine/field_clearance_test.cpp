// SPDX-License-Identifier: BSD-3-Clause
// Struts that are called clear of a height field against the engine's own search, which a margin of a picometre makes
// it do whatever is said of clearance.
#include "sim/engine/field_clearance.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>
#include <string>

#include "sim/random/stream.hpp"
#include "tests/sim/lidar/test_worlds.hpp"

namespace tumble::sim::engine {
namespace {

using Eigen::Vector3d;

/// A strut above 6 m x 4 m of ground: rough to 0.2 m over cells of 0.2 m by 0.16 m.
class Ground {
 public:
  explicit Ground(const char* turn = "0 0 0")
      : world_(testing::world_of(std::string("<mujoco><asset><hfield name='ground' nrow='26' ncol='31' size='3 2 0.2 "
                                             "0.3'/></asset><worldbody><geom type='hfield' hfield='ground' pos='0.3 "
                                             "-0.2 0.1' margin='1e-12' euler='") +
                                 turn +
                                 "'/><body name='robot'><freejoint/><geom type='capsule' size='0.025 "
                                 "0.2'/></body></worldbody></mujoco>")),
        data_(mj_makeData(world_.model.get())) {
    Stream chance(3, "test.ground");
    for (int i = 0; i < world_.model->nhfielddata; ++i) {
      world_.model->hfield_data[i] = static_cast<float>(chance.uniform(0.0, 1.0));
    }
  }

  void put(const Vector3d& at_m, const Eigen::Quaterniond& turn) {
    Vector3d::Map(data_->qpos) = at_m;
    data_->qpos[3] = turn.w();
    Vector3d::Map(data_->qpos + 4) = turn.vec();
    mj_kinematics(world_.model.get(), data_.get());
    mj_comPos(world_.model.get(), data_.get());
  }
  bool clear() const { return clear_of_field(*world_.model, *data_, 0, 1); }
  /// Whether the engine finds a contact.
  bool touches() {
    mj_collision(world_.model.get(), data_.get());
    return data_->ncon > 0;
  }

 private:
  World world_;
  DataPtr data_;
};

Eigen::Quaterniond any_attitude(Stream& chance) {
  Eigen::Quaterniond turn(chance.normal(), chance.normal(), chance.normal(), chance.normal());
  return turn.normalized();
}

TEST(FieldClearance, WhatIsCalledClearTheEngineFindsNoContactOf) {
  Ground ground;
  Stream chance(4, "test.struts");
  int clear = 0, touching = 0, in_doubt = 0;
  for (int i = 0; i < 20000; ++i) {
    // also over the rim, and from within the ground to above its tops
    ground.put({chance.uniform(-3.2, 3.8), chance.uniform(-2.6, 2.2), chance.uniform(-0.1, 0.6)}, any_attitude(chance));
    const bool says_clear = ground.clear(), touches = ground.touches();
    ASSERT_FALSE(says_clear && touches) << "strut " << i;
    clear += says_clear;
    touching += touches;
    in_doubt += !says_clear && !touches;
  }
  EXPECT_GT(touching, 4000);  // both kinds were asked for
  EXPECT_GT(clear, 4000);
  EXPECT_LT(in_doubt, 1200);  // and the question is worth asking
}

TEST(FieldClearance, AStrutThatJustTouchesIsNotClear) {
  Ground ground;
  Stream chance(5, "test.struts");
  for (int i = 0; i < 300; ++i) {
    const Eigen::Quaterniond turn = any_attitude(chance);
    Vector3d low(chance.uniform(-2.0, 2.0), chance.uniform(-1.5, 1.5), 0.0), high = low + Vector3d(0, 0, 1.2);
    for (int halving = 0; halving < 40; ++halving) {
      const Vector3d middle = 0.5 * (low + high);
      ground.put(middle, turn);
      (ground.touches() ? low : high) = middle;
    }
    ground.put(low, turn);
    EXPECT_FALSE(ground.clear()) << "strut " << i;
  }
}

TEST(FieldClearance, IsInDoubtWhereItCannotTell) {
  Ground level, turned("0 5 0");
  const Eigen::Quaterniond upright = Eigen::Quaterniond::Identity();
  const Vector3d high(0, 0, 2);
  level.put(high, upright);
  turned.put(high, upright);
  EXPECT_TRUE(level.clear());
  EXPECT_FALSE(turned.clear());
  level.put({std::numeric_limits<double>::quiet_NaN(), 0, 2}, upright);
  EXPECT_FALSE(level.clear());
  level.put({0, 0, -1}, upright);  // below the foot
  EXPECT_FALSE(level.clear());
}

}  // namespace
}  // namespace tumble::sim::engine
