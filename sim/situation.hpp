// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "sim/parameters.hpp"

namespace tumble::sim {

struct SensorSpec {
  std::string name;    ///< unique: "imu", "imu_reference", "lidar"
  std::string kind;    ///< type of sensor: "imu", "spinning_lidar", "barometer"
  std::string device;  ///< source of the values ("mti30")
  std::string site;    ///< site of the robot's MJCF file that carries the sensor
  Values values;       ///< data sheet with the changes of the scenario
  /// error of the sensor pose that an estimator receives: x_m, y_m and z_m in B axes, and the small angles roll_rad,
  /// pitch_rad and yaw_rad in I axes
  Values mount_error;
  bool operator==(const SensorSpec&) const = default;
};

/// Situation describes one simulated run: world, robot, sensors and motion, with a value for each parameter. Equal
/// situations give bit-identical recordings.
struct Situation {
  std::string scenario;
  std::uint64_t seed = 0;
  double duration_s = 10.0;
  Component world;
  Component robot;
  Component motion;
  std::vector<SensorSpec> sensors;
  /// Seeds of single random streams. The stream "world" determines the shape of the world, and a stream with a sensor's
  /// name determines the errors of this sensor. All streams that are not listed use `seed`.
  std::map<std::string, std::uint64_t> streams;
  bool operator==(const Situation&) const = default;

  std::uint64_t seed_of(const std::string& stream) const {
    const auto at = streams.find(stream);
    return at == streams.end() ? seed : at->second;
  }
};

/// name of the world's random stream in Situation::streams
inline constexpr const char* kWorldStream = "world";

std::span<const ComponentType> world_types();
std::span<const ComponentType> robot_types();
std::span<const ComponentType> motion_types();
std::span<const ComponentType> sensor_types();
std::span<const Parameter> mount_error_parameters();

/// ResolvedSituation is a complete situation that resolve() has checked; no other function creates a ResolvedSituation.
class ResolvedSituation {
 public:
  const Situation* operator->() const { return &situation_; }
  operator const Situation&() const& { return situation_; }
  operator Situation() && { return std::move(situation_); }

  ResolvedSituation without_sensors(const std::function<bool(const SensorSpec&)>& left_out) const;

  bool operator==(const ResolvedSituation&) const = default;

 private:
  friend ResolvedSituation resolve(const Situation& situation);
  explicit ResolvedSituation(Situation situation) : situation_(std::move(situation)) {}

  Situation situation_;
};

ResolvedSituation resolve(const Situation& situation);

}  // namespace tumble::sim
