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

/// Input of a sensor's simulation; all members outlive the call.
struct SensorContext {
  const engine::World& world;
  const SensorSpec& sensor;             ///< resolved
  const Eigen::Isometry3d& T_BX;        ///< true mounting of the sensor's frame X
  const Eigen::Isometry3d& given_T_BX;  ///< calibration that an estimator receives
  double gravity_m_s2;
  std::uint64_t seed;
  int threads;
};

/// A kind of sensor: its parameters, and the function that adds the sensor's readings and truth to a recording with the
/// body's truth. An optional check rejects resolved numbers that contradict each other, with a message that starts with
/// `place`.
struct SensorType {
  ComponentType component;
  void (*simulate)(const SensorContext& context, Recording& recording);
  void (*check)(const Values& values, const std::string& place) = nullptr;
};

/// Returns all kinds of sensor in the order of registration.
std::span<const SensorType* const> all_sensor_types();
/// Returns the kind of sensor with this name. For an unknown name, throws InvalidSituation with the nearest known kind.
const SensorType& find_sensor_type(std::string_view kind);

}  // namespace tumble::sim
