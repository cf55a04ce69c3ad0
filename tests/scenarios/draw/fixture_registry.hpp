// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "scenarios/draw/registry.hpp"
#include "tests/scenarios/testing.hpp"

namespace tumble::scenarios::fixture {

inline constexpr std::array<sim::Parameter, 2> kHill = {
    {{"slope_rad", 0.5, 0.0, 1.2, "rad", "slope"}, {"relief_m", 0.1, 0.0, 1.0, "m", "relief"}}};
inline constexpr std::array<sim::Parameter, 1> kRig = {{{"mass_kg", 8.0, 1.0, 20.0, "kg", "mass"}}};
inline constexpr std::array<sim::Parameter, 1> kPush = {{{"force_n", 300.0, 0.0, 5000.0, "N", "force"}}};
inline constexpr std::array<sim::Parameter, 2> kImu = {
    {{"gyro_range_rad_s", 7.854, 0.1, 100.0, "rad/s", "rail"}, {"output_rate_hz", 100.0, 1.0, 2000.0, "Hz", "rate"}}};
inline constexpr std::array<sim::Parameter, 1> kMount = {{{"x_m", 0.0, -0.1, 0.1, "m", "error along x"}}};

inline const std::array<sim::ComponentType, 2> kWorlds = {{{"hill", "a slope", kHill}, {"bare", "bare slope", kHill}}};
inline const std::array<sim::ComponentType, 1> kRobots = {{{"rig", "a rig", kRig}}};
inline const std::array<sim::ComponentType, 1> kMotions = {{{"push", "a push", kPush}}};
inline const std::array<sim::ComponentType, 1> kSensors = {{{"imu", "an IMU", kImu}}};

/// Returns a small registry that does not change when the simulation's registry does.
inline Registry registry() {
  return {kWorlds, kRobots, kMotions, kSensors, kMount};
}

inline const std::string kScenario = R"(name: hill
doc: a rig is pushed down a hill
duration_s: 11
world: {type: hill, slope_rad: {uniform: [0.5, 0.7]}}
robot: {type: rig, mass_kg: {normal: [8, 0.5, 6, 10]}}
motion:
  type: push
  force_n: 450.5
sensors:
  - {name: imu, kind: imu, device: mti30, site: mti30, output_rate_hz: 100, mount_error: {x_m: {normal: [0, 0.003]}}}
  - {name: imu_reference, kind: imu, device: mti30, site: vn100}
)";

inline const std::string kSheet = R"(device: mti30
title: Xsens MTi-30 AHRS
kind: imu
values:
  gyro_range_rad_s: {value: 7.854, unit: rad/s, source: "450 deg/s, MTi user manual"}
  output_rate_hz: {value: 400, unit: Hz, source: "MTi user manual"}
)";

/// Returns `text` with its only occurrence of `from` replaced; a text without `from` is a mistake in the test.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  if (at == std::string::npos) throw std::logic_error("fixture does not hold '" + from + "'");
  return text.replace(at, from.size(), to);
}

/// A Wrong contains a text with a mistake, and the expected message.
struct Wrong {
  const char* from;
  const char* to;
  const char* where;  ///< start of the message
  const char* what;   ///< part of the message
};

using test::complaint;

}  // namespace tumble::scenarios::fixture
