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

/// A sensor of the robot: where it is mounted, which device it is, and how far the estimator's calibration is off.
struct SensorSpec {
  std::string name;    ///< unique in the situation: "imu", "imu_reference", "lidar"
  std::string kind;    ///< registry entry: "imu", "spinning_lidar", "barometer"
  std::string device;  ///< data sheet that the values came from: "mti30"; kept for the record
  std::string site;    ///< site of the robot's MJCF that carries it
  Values values;       ///< numbers of the device (data sheet, then the scenario's changes)
  /// Calibration minus design: x_m y_m z_m (B axes), roll_rad pitch_rad yaw_rad (small angles, I axes). A centre of
  /// mass off its nominal place adds to it what nobody calibrates.
  Values mount_error;
  bool operator==(const SensorSpec&) const = default;
};

/// A draw: one situation with every number fixed. Equal situations give equal recordings, bit for bit. As written it
/// may leave out what is default; `resolve` completes and checks it.
struct Situation {
  std::string scenario;  ///< name of the scenario that it was drawn from
  std::uint64_t seed = 0;
  double duration_s = 10.0;
  Component world;
  Component robot;
  Component motion;
  std::vector<SensorSpec> sensors;
  bool operator==(const Situation&) const = default;
};

/// Registries, in the order of registration.
std::span<const ComponentType> world_types();
std::span<const ComponentType> robot_types();
std::span<const ComponentType> motion_types();
std::span<const ComponentType> sensor_types();
/// Parameters of SensorSpec::mount_error.
std::span<const Parameter> mount_error_parameters();

/// A situation that is complete and checked. Only `resolve` makes one, so that whoever is given one need not ask again.
/// It reads as a Situation; to change a number take a copy, change that and resolve it.
class ResolvedSituation {
 public:
  const Situation* operator->() const { return &situation_; }
  operator const Situation&() const& { return situation_; }
  operator Situation() && { return std::move(situation_); }

  /// The same without the sensors that `left_out` names: what is left is as complete as it was.
  ResolvedSituation without_sensors(const std::function<bool(const SensorSpec&)>& left_out) const;

  bool operator==(const ResolvedSituation&) const = default;

 private:
  friend ResolvedSituation resolve(const Situation& situation);
  explicit ResolvedSituation(Situation situation) : situation_(std::move(situation)) {}

  Situation situation_;
};

/// Completes every component with its defaults and checks it; throws InvalidSituation with the place.
ResolvedSituation resolve(const Situation& situation);

}  // namespace tumble::sim
