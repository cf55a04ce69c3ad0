// SPDX-License-Identifier: BSD-3-Clause
// The test compares contacts of a strut with rough ground with the engine's own search, which a margin of a picometre
// forces, whatever its table contains.
#include "sim/engine/field_contact.hpp"

#include "sim/random/stream.hpp"
#include "tests/sim/lidar/test_worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim::engine {
namespace {

using Contacts = std::array<mjPreContact, mjMAXCONPAIR>;

/// Ground has a strut above 6 m x 4 m of ground that is rough to 0.2 m over cells of 0.2 m by 0.16 m.
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

  void put(const Vector3d& at_m, const Quaterniond& turn) {
    Vector3d::Map(data_->qpos) = at_m;
    data_->qpos[3] = turn.w();
    Vector3d::Map(data_->qpos + 4) = turn.vec();
    mj_kinematics(world_.model.get(), data_.get());
    mj_comPos(world_.model.get(), data_.get());
  }
  std::optional<int> ours(Contacts& contacts) const {
    return field_contacts(*world_.model, *data_, 0, 1, contacts.data());
  }
  /// `data` contains the engine's contacts until the next call.
  const mjData& engines() {
    mj_collision(world_.model.get(), data_.get());
    return *data_;
  }

 private:
  World world_;
  DataPtr data_;
};

Quaterniond any_attitude(Stream& chance) {
  Quaterniond turn(chance.normal(), chance.normal(), chance.normal(), chance.normal());
  return turn.normalized();
}

/// Returns the largest difference of position, depth and normal, contact by contact; it is infinite when the numbers of
/// contacts differ.
double difference(const Contacts& ours, int count, const mjData& engine) {
  if (count != engine.ncon) return std::numeric_limits<double>::infinity();
  double worst = 0.0;
  for (int k = 0; k < count; ++k) {
    const mjContact& theirs = engine.contact[k];
    worst = std::max({worst, std::abs(ours[k].dist - theirs.dist),
                      (Vector3d::Map(ours[k].pos) - Vector3d::Map(theirs.pos)).norm(),
                      (Vector3d::Map(ours[k].normal) - Vector3d::Map(theirs.frame)).norm()});
  }
  return worst;
}

TEST(FieldContact, ContactsAreTheEngines) {
  Ground ground;
  Stream chance(4, "test.struts");
  Contacts contacts;
  int touching = 0, clear = 0, several = 0, deep = 0;
  for (int i = 0; i < 20000; ++i) {
    // the positions include those over the edge, and from within the ground to above its tops
    ground.put({chance.uniform(-3.2, 3.8), chance.uniform(-2.6, 2.2), chance.uniform(0.15, 0.5)}, any_attitude(chance));
    const std::optional<int> count = ground.ours(contacts);
    const mjData& engine = ground.engines();
    if (!count) {
      ++deep;
      continue;
    }
    ++(*count > 0 ? touching : clear);
    several += *count > 1;
    ASSERT_LT(difference(contacts, *count, engine), 1e-9) << "strut " << i;  // 5e-11 for the normal is the largest
  }
  EXPECT_GT(clear, 4000);  // all cases must occur
  EXPECT_GT(touching, 1000);
  EXPECT_GT(several, 700);
  EXPECT_GT(deep, 4000);
}

TEST(FieldContact, TheComparisonSeesAMicrometre) {
  Ground ground;
  Contacts contacts;
  const Quaterniond level(Eigen::AngleAxisd(1.5, Vector3d::UnitY()));
  Vector3d at_m(0.0, 0.0, 0.5);
  std::optional<int> count = 0;
  for (; count && *count == 0; at_m.z() -= 0.002) {  // down to the first contact
    ground.put(at_m, level);
    count = ground.ours(contacts);
  }
  ASSERT_TRUE(count);
  ASSERT_LT(difference(contacts, *count, ground.engines()), 1e-9);
  ground.put(at_m + Vector3d(0.0, 0.0, 0.002 + 1e-6), level);
  EXPECT_GT(difference(contacts, *count, ground.engines()), 1e-7);
}

TEST(FieldContact, LeavesToTheEngineWhatItCannotDecide) {
  Ground level, turned("0 5 0");
  Contacts contacts;
  const Quaterniond upright = Eigen::Quaterniond::Identity();
  level.put({0, 0, 2}, upright);
  turned.put({0, 0, 2}, upright);
  EXPECT_EQ(level.ours(contacts), 0);
  EXPECT_EQ(turned.ours(contacts), std::nullopt);
  level.put({std::numeric_limits<double>::quiet_NaN(), 0, 2}, upright);
  EXPECT_EQ(level.ours(contacts), std::nullopt);
  level.put({0, 0, -1}, upright);  // below the base
  EXPECT_EQ(level.ours(contacts), std::nullopt);
  level.put({0, 0, 0.25}, upright);  // its lower end is in the ground
  EXPECT_EQ(level.ours(contacts), std::nullopt);
}

}  // namespace
}  // namespace tumble::sim::engine
