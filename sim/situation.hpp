// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/parameters.hpp"

namespace tumble::sim {

/// SensorSpec describes a sensor of the robot: its mounting, its device, and the error of the estimator's calibration.
struct SensorSpec {
  std::string name;    ///< unique in the situation: "imu", "imu_reference", "lidar"
  std::string kind;    ///< registry entry: "imu", "spinning_lidar", "barometer"
  std::string device;  ///< data sheet from which the values come ("mti30"); for information
  std::string site;    ///< site of the robot's MJCF at which the sensor is mounted
  Values values;       ///< numbers of the device (data sheet with the scenario's changes)
  /// Error of the sensor's mounting in the calibration that an estimator receives: x_m y_m z_m (B axes), roll_rad
  /// pitch_rad yaw_rad (small angles, I axes). An offset of the centre of mass adds to the error.
  Values mount_error;
  bool operator==(const SensorSpec&) const = default;
};

/// Situation is one simulated case with every number fixed. Equal situations give bit-identical recordings. Values with
/// defaults may be omitted; resolve() adds them and checks the Situation.
struct Situation {
  std::string scenario;  ///< name of the scenario from which it was drawn
  std::uint64_t seed = 0;
  double duration_s = 10.0;
  Component world;
  Component robot;
  Component motion;
  std::vector<SensorSpec> sensors;
  bool operator==(const Situation&) const = default;
};

/// Return all types of worlds, robots, motions and sensors, in the order of registration.
std::span<const ComponentType> world_types();
std::span<const ComponentType> robot_types();
std::span<const ComponentType> motion_types();
std::span<const ComponentType> sensor_types();
/// Returns the parameters of SensorSpec::mount_error.
std::span<const Parameter> mount_error_parameters();

/// ResolvedSituation is a complete and checked situation. Only resolve() creates a ResolvedSituation, so users need no
/// further checks. To change a number, copy the Situation, change the copy and call resolve().
class ResolvedSituation {
 public:
  const Situation* operator->() const { return &situation_; }
  operator const Situation&() const& { return situation_; }
  operator Situation() && { return std::move(situation_); }

  /// Returns the situation without the sensors for which `left_out` is true.
  ResolvedSituation without_sensors(const std::function<bool(const SensorSpec&)>& left_out) const;

  bool operator==(const ResolvedSituation&) const = default;

 private:
  friend ResolvedSituation resolve(const Situation& situation);
  explicit ResolvedSituation(Situation situation) : situation_(std::move(situation)) {}

  Situation situation_;
};

/// Adds the defaults of every component, and checks all values. Throws InvalidSituation with the location of the error.
ResolvedSituation resolve(const Situation& situation);

}  // namespace tumble::sim
