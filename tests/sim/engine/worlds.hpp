// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

#include "sim/built_situation.hpp"
#include "tests/tree.hpp"

namespace tumble::sim {

inline std::filesystem::path models_folder() {
  return test::source_dir() / "models";
}

/// Returns the world of a situation, with the models of this tree; builds a new world in each call.
inline BuiltSituation built(const Situation& situation) {
  return {resolve(situation), models_folder()};
}

inline SensorSpec imu_at(const std::string& name, const std::string& site, double rate_hz) {
  SensorSpec sensor;
  sensor.name = name;
  sensor.kind = "imu";
  sensor.device = "ideal";
  sensor.site = site;
  sensor.values.set("output_rate_hz", rate_hz);
  return sensor;
}

/// A tumble with one ideal IMU.
inline Situation tumble_down(double duration_s, double imu_rate_hz) {
  Situation situation;
  situation.scenario = "test";
  situation.seed = 5;
  situation.duration_s = duration_s;
  situation.world.type = "hill";
  situation.robot.type = "rig";
  situation.motion.type = "push";
  situation.motion.values.set("rest_s", 0.5);
  situation.motion.values.set("velocity_m_s", 3.0);
  situation.motion.values.set("lift_m_s", 2.0);
  situation.motion.values.set("spin_forward_rad_s", 8.0);
  situation.sensors = {imu_at("imu", "mti30", imu_rate_hz)};
  return situation;
}

/// A sphere on a level floor, guided along one metre.
inline Situation roll_along(double duration_s) {
  Situation situation;
  situation.scenario = "test";
  situation.duration_s = duration_s;
  situation.world.type = "floor";
  situation.robot.type = "sphere";
  situation.motion.type = "hand_roll";
  situation.motion.values.set("rest_s", 0.5);
  situation.motion.values.set("leg_2_m", 0.0);
  return situation;
}

}  // namespace tumble::sim
