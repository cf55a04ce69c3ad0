// SPDX-License-Identifier: BSD-3-Clause
#include "sim/situation.hpp"

#include <array>
#include <set>
#include <sstream>

#include "sim/motion/motion_type.hpp"
#include "sim/registry.hpp"
#include "sim/robot/robot_type.hpp"
#include "sim/sensor_type.hpp"
#include "sim/world/world_type.hpp"

namespace tumble::sim {

namespace {

constexpr std::array kMountError = {
    Parameter{"x_m", 0.0, -1.0, 1.0, "m", "position error of the calibration, B axes"},
    Parameter{"y_m", 0.0, -1.0, 1.0, "m", "the same along y"},
    Parameter{"z_m", 0.0, -1.0, 1.0, "m", "the same along z"},
    Parameter{"roll_rad", 0.0, -0.5, 0.5, "rad",
              "rotation error of the calibration, small angle about the sensor's x axis"},
    Parameter{"pitch_rad", 0.0, -0.5, 0.5, "rad", "the same about y"},
    Parameter{"yaw_rad", 0.0, -0.5, 0.5, "rad", "the same about z"},
};

constexpr double kDurationMax_s = 3600.0;

template <typename Type>
Component resolve_component(const std::string& what, const Component& component,
                            std::span<const Type* const> registry) {
  const Type& type = find_entry(registry, component.type, what);
  return {component.type, resolve(what + "." + component.type, component.values, type.component.parameters)};
}

SensorSpec resolve_sensor(const SensorSpec& sensor) {
  if (sensor.name.empty()) throw InvalidSituation("sensors: a sensor has no name; give each sensor a name");
  const std::string place = "sensors." + sensor.name;
  if (sensor.site.empty()) throw InvalidSituation(place + ": no site given");
  SensorSpec out = sensor;
  const SensorType& type = find_entry(all_sensor_types(), sensor.kind, place + ".kind");
  out.values = resolve(place, sensor.values, type.component.parameters);
  if (type.check != nullptr) type.check(out.values, place);
  out.mount_error = resolve(place + ".mount_error", sensor.mount_error, kMountError);
  return out;
}

}  // namespace

std::span<const ComponentType> world_types() {
  static const auto kList = components(all_world_types());
  return kList;
}

std::span<const ComponentType> robot_types() {
  static const auto kList = components(all_robot_types());
  return kList;
}

std::span<const ComponentType> motion_types() {
  static const auto kList = components(all_motion_types());
  return kList;
}

std::span<const ComponentType> sensor_types() {
  static const auto kList = components(all_sensor_types());
  return kList;
}

std::span<const Parameter> mount_error_parameters() {
  return kMountError;
}

ResolvedSituation ResolvedSituation::without_sensors(const std::function<bool(const SensorSpec&)>& left_out) const {
  ResolvedSituation out = *this;
  std::erase_if(out.situation_.sensors, left_out);
  return out;
}

ResolvedSituation resolve(const Situation& situation) {
  if (!(situation.duration_s > 0.0 && situation.duration_s <= kDurationMax_s)) {
    std::ostringstream text;
    text << "duration_s is " << situation.duration_s << " s; it must be within (0, " << kDurationMax_s << "]";
    throw InvalidSituation(text.str());
  }
  Situation out = situation;
  out.world = resolve_component("world", situation.world, all_world_types());
  out.robot = resolve_component("robot", situation.robot, all_robot_types());
  out.motion = resolve_component("motion", situation.motion, all_motion_types());
  out.sensors.clear();
  std::set<std::string> names;
  for (const SensorSpec& sensor : situation.sensors) {
    out.sensors.push_back(resolve_sensor(sensor));
    if (!names.insert(sensor.name).second)
      throw InvalidSituation("sensors: two sensors have the same name '" + sensor.name + "'");
  }
  return ResolvedSituation(std::move(out));
}

}  // namespace tumble::sim
