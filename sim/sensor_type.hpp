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

/// SensorContext is the input of a sensor's simulation. The references in SensorContext are valid during the call.
struct SensorContext {
  const engine::World& world;
  const SensorSpec& sensor;             ///< sensor with resolved parameters
  const Eigen::Isometry3d& T_BX;        ///< true mounting of the sensor's frame X
  const Eigen::Isometry3d& given_T_BX;  ///< calibration that an estimator receives
  double gravity_m_s2;
  std::uint64_t seed;
  int threads;
};

/// SensorType is a kind of sensor: its parameters, and the function that adds its readings and truth to a recording. An
/// optional check throws InvalidSituation for parameters that contradict each other; the message starts with `place`.
struct SensorType {
  ComponentType component;
  void (*simulate)(const SensorContext& context, Recording& recording);
  void (*check)(const Values& values, const std::string& place) = nullptr;
};

/// Returns all sensor types in the order of registration.
std::span<const SensorType* const> all_sensor_types();
/// Returns the sensor type with this name. For an unknown name, throws InvalidSituation with the nearest known type.
const SensorType& find_sensor_type(std::string_view kind);

}  // namespace tumble::sim
