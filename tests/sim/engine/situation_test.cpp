// SPDX-License-Identifier: BSD-3-Clause
#include "sim/situation.hpp"

#include "tests/sim/engine/worlds.hpp"
#include "tests/testing.hpp"

namespace tumble::sim {
namespace {

std::vector<std::string> names(std::span<const ComponentType> types) {
  std::vector<std::string> list;
  for (const ComponentType& type : types) list.push_back(type.name);
  return list;
}

TEST(Registries, HoldTheKindsOfThisVersion) {
  EXPECT_THAT(names(world_types()), ::testing::IsSupersetOf({"hill", "floor"}));
  EXPECT_THAT(names(robot_types()), ::testing::IsSupersetOf({"rig", "sphere"}));
  EXPECT_THAT(names(motion_types()), ::testing::IsSupersetOf({"push", "hand_roll"}));
  EXPECT_THAT(names(sensor_types()), ::testing::IsSupersetOf({"imu", "spinning_lidar", "rosette_lidar"}));
}

TEST(Registries, EveryParameterIsDocumentedAndItsDefaultWithinItsBounds) {
  std::vector<std::span<const Parameter>> lists = {mount_error_parameters()};
  for (const auto& types : {world_types(), robot_types(), motion_types(), sensor_types()}) {
    for (const ComponentType& type : types) {
      EXPECT_FALSE(type.doc.empty()) << type.name;
      lists.push_back(type.parameters);
    }
  }
  for (const auto& list : lists) {
    std::set<std::string_view> seen;
    EXPECT_FALSE(list.empty());
    for (const Parameter& parameter : list) {
      EXPECT_TRUE(seen.insert(parameter.name).second) << parameter.name << " twice";
      EXPECT_FALSE(parameter.unit.empty()) << parameter.name;
      EXPECT_FALSE(parameter.doc.empty()) << parameter.name;
      EXPECT_LE(parameter.low, parameter.default_value) << parameter.name;
      EXPECT_GE(parameter.high, parameter.default_value) << parameter.name;
    }
  }
}

TEST(Resolve, FillsDefaultsAndKeepsWhatIsGiven) {
  const ResolvedSituation resolved = resolve(tumble_down(2.0, 200.0));
  const Situation& out = resolved;
  EXPECT_EQ(out.robot.values.at("mass_kg"), 8.0);
  EXPECT_EQ(out.motion.values.at("velocity_m_s"), 3.0);
  EXPECT_EQ(out.sensors[0].values.at("output_rate_hz"), 200.0);
  EXPECT_EQ(out.sensors[0].mount_error.at("yaw_rad"), 0.0);
  EXPECT_EQ(resolve(out), resolved);
}

/// Returns the complaint of resolve about the test tumble after a change.
std::string complaint(const std::function<void(Situation&)>& change) {
  Situation situation = tumble_down(2.0, 100.0);
  change(situation);
  try {
    resolve(situation);
  } catch (const InvalidSituation& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Resolve, SaysWhatIsWrongAndWhere) {
  using ::testing::AllOf;
  using ::testing::HasSubstr;
  EXPECT_THAT(complaint([](Situation& s) { s.world.type = "hil"; }), AllOf(HasSubstr("world"), HasSubstr("'hill'")));
  EXPECT_THAT(complaint([](Situation& s) { s.robot.type = "spere"; }),
              AllOf(HasSubstr("robot"), HasSubstr("'sphere'")));
  EXPECT_THAT(complaint([](Situation& s) { s.motion.type = "pus"; }), AllOf(HasSubstr("motion"), HasSubstr("'push'")));
  EXPECT_THAT(complaint([](Situation& s) { s.world.values.set("rock_count", 4.5); }),
              HasSubstr("rock_count is 4.5; it must be a whole number"));
  EXPECT_EQ(complaint([](Situation& s) { s.world.values.set("rock_count", 4.0); }), "accepted");
  const auto shape = [](double value) {
    return [value](Situation& s) { s.motion = {"hand_path", {}}, s.motion.values.set("shape", value); };
  };
  EXPECT_THAT(complaint(shape(1.5)), HasSubstr("motion.hand_path.shape is 1.5; it must be a whole number"));
  EXPECT_EQ(complaint(shape(2.0)), "accepted");
  for (const std::string name : {"gyro_update_hz", "accel_update_hz"}) {
    EXPECT_THAT(complaint([&](Situation& s) { s.sensors[0].values.set(name, 1e-6); }),
                HasSubstr(name + " is 1e-06 Hz; it must be 0 (off) or at least 0.1"));
    EXPECT_EQ(complaint([&](Situation& s) { s.sensors[0].values.set(name, 0.1); }), "accepted");
  }
  EXPECT_THAT(complaint([](Situation& s) { s.world.values.set("slope_rd", 0.5); }),
              AllOf(HasSubstr("world.hill"), HasSubstr("'slope_rad'")));
  EXPECT_THAT(complaint([](Situation& s) { s.world.values.set("slope_rad", 5); }),
              AllOf(HasSubstr("world.hill.slope_rad is 5 rad"), HasSubstr("1.2")));
  EXPECT_THAT(complaint([](Situation& s) { s.robot.values.set("mass_kg", std::nan("")); }),
              HasSubstr("robot.rig.mass_kg is nan"));
  EXPECT_THAT(complaint([](Situation& s) { s.sensors[0].kind = "lidr"; }), HasSubstr("sensors.imu.kind"));
  EXPECT_THAT(complaint([](Situation& s) { s.sensors[0].values.set("gyro_rail_rads", 1); }),
              AllOf(HasSubstr("sensors.imu"), HasSubstr("'gyro_rail_rad_s'")));
  EXPECT_THAT(complaint([](Situation& s) { s.sensors[0].mount_error.set("x", 0); }),
              HasSubstr("sensors.imu.mount_error"));
  EXPECT_THAT(complaint([](Situation& s) { s.sensors.push_back(s.sensors[0]); }),
              HasSubstr("two sensors have the same name 'imu'"));
  EXPECT_THAT(complaint([](Situation& s) { s.sensors[0].site = ""; }), HasSubstr("no site"));
  EXPECT_THAT(complaint([](Situation& s) { s.duration_s = 0; }), HasSubstr("duration_s is 0"));
  EXPECT_THAT(complaint([](Situation& s) { s.duration_s = std::numeric_limits<double>::infinity(); }),
              HasSubstr("duration_s is inf"));
  EXPECT_EQ(complaint([](Situation&) {}), "accepted");
}

}  // namespace
}  // namespace tumble::sim
