// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "sim/engine/model.hpp"
#include "sim/recording.hpp"

namespace tumble::sim {

struct SensorContext {
  const engine::World& world;
  const SensorSpec& sensor;
  const Eigen::Isometry3d& T_BX;        ///< true pose of the sensor
  const Eigen::Isometry3d& given_T_BX;  ///< pose that an estimator receives
  double gravity_m_s2;
  std::uint64_t seed;
  int threads;
};

struct SensorType {
  ComponentType component;
  void (*simulate)(const SensorContext& context, Recording& recording);
  void (*check)(const Values& values, const std::string& place) = nullptr;
};

std::span<const SensorType* const> all_sensor_types();
const SensorType& find_sensor_type(std::string_view kind);

}  // namespace tumble::sim
