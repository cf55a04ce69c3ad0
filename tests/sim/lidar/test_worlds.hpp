// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "sim/engine/model.hpp"
#include "sim/lidar/lidar_parameters.hpp"
#include "sim/random/stream.hpp"
#include "sim/situation.hpp"

namespace tumble::sim::testing {

/// Compiles MJCF and makes every geom of the world body a surface, in order; a body named "robot" is the robot.
inline engine::World world_of(const std::string& mjcf) {
  char error[1000] = "";
  mjSpec* spec = mj_parseXMLString(mjcf.c_str(), nullptr, error, sizeof error);
  if (spec == nullptr) throw std::runtime_error(error);
  engine::World world;
  world.model.reset(mj_compile(spec, nullptr));
  if (!world.model) {
    const std::string message = mjs_getError(spec);
    mj_deleteSpec(spec);
    throw std::runtime_error(message);
  }
  mj_deleteSpec(spec);
  for (int geom = 0; geom < world.model->ngeom; ++geom) {
    if (world.model->geom_bodyid[geom] != 0) continue;
    const char* name = mj_id2name(world.model.get(), mjOBJ_GEOM, geom);
    world.surfaces.emplace_back(name != nullptr ? name : "");
    world.surface_geom.push_back(geom);
  }
  world.robot_body = mj_name2id(world.model.get(), mjOBJ_BODY, "robot");
  return world;
}

/// Returns a height field of `cells` + 1 nodes per side over 40 m x 40 m with 2 m of rough relief, and `primitives` of
/// all kinds.
inline engine::World rough_world(int cells, int primitives) {
  static constexpr const char* kKinds[] = {"sphere", "capsule", "ellipsoid", "cylinder", "box"};
  Stream chance(11, "test.world");
  const std::string nodes = std::to_string(cells + 1);
  std::string mjcf = "<mujoco><asset><hfield name='relief' nrow='" + nodes + "' ncol='" + nodes +
                     "' size='20 20 2 0.5'/>"
                     "<mesh name='wedge' vertex='0 0 0  2 0 0  0 2 0  2 2 0  0 0 1.5  0.4 1.7 1'/></asset><worldbody>"
                     "<geom name='relief' type='hfield' hfield='relief' pos='0.3 -0.2 -1' euler='3 -5 20'/>"
                     "<geom name='wedge' type='mesh' mesh='wedge' pos='3 4 0.5' euler='20 10 60'/>"
                     "<geom name='wall' type='plane' size='4 3 0.1' pos='0 12 2' euler='90 0 0'/>";
  for (int i = 0; i < primitives; ++i) {
    const auto number = [&](double low, double high) { return " " + std::to_string(chance.uniform(low, high)); };
    mjcf += std::string("<geom type='") + kKinds[i % 5] + "' pos='" + number(-15, 15) + number(-15, 15) +
            number(-1, 4) + "' euler='" + number(-180, 180) + number(-180, 180) + number(-180, 180) + "' size='" +
            number(0.1, 0.8) + number(0.1, 0.8) + number(0.1, 0.8) + "'/>";
  }
  engine::World world = world_of(mjcf + "</worldbody></mujoco>");
  for (int i = 0; i < world.model->nhfielddata; ++i) {
    world.model->hfield_data[i] = static_cast<float>(chance.uniform(0.0, 1.0));
  }
  return world;
}

/// Returns a lidar of a kind with its default numbers.
inline SensorSpec lidar_of(const std::string& kind) {
  SensorSpec sensor;
  sensor.name = "lidar";
  sensor.kind = kind;
  sensor.device = kind == "spinning_lidar" ? "rs16" : kind == "column_lidar" ? "os1_64" : "mid100";
  sensor.values = resolve(kind, {},
                          kind == "spinning_lidar" ? spinning_lidar_parameters()
                          : kind == "column_lidar" ? column_lidar_parameters()
                                                   : rosette_lidar_parameters());
  return sensor;
}

/// Returns the same lidar with every error off and a range of 1000 m, except that `numbers` differ.
inline SensorSpec exact_lidar_of(const std::string& kind,
                                 std::initializer_list<std::pair<const char*, double>> numbers = {}) {
  SensorSpec sensor = lidar_of(kind);
  for (const char* error :
       {"range_noise_m", "range_quantum_m", "intensity_quantum", "detection_range_m", "range_min_m"})
    sensor.values.set(error, 0.0);
  sensor.values.set("range_max_m", 1000.0);
  for (const auto& [name, value] : numbers) sensor.values.set(name, value);
  return sensor;
}

}  // namespace tumble::sim::testing
