// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/methods/method.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// A curve of a suite: one number, or several numbers that change together, set to a list of values. A key is
///
/// | key | is | for each value |
/// | --- | --- | --- |
/// | `world.rock_count`, `sensors.imu.output_rate_hz` | a number of the scenario (fixed_number.hpp) | new simulation |
/// | `given.lever_arm_error_m` | an error in the methods' input (given_errors.hpp) | one simulation for all values |
/// | `rate/saave.jerk_psd_rad2_s5` | a parameter of one method | one simulation for all values, only this method |
struct Variation {
  std::vector<std::string> keys;  ///< all of one sort
  std::vector<double> values;     ///< as written, each once
  /// Returns the keys joined by "+", as the results store them.
  std::string key() const;
  std::vector<Setting> settings() const;
};

/// States which part of a run a setting affects, and hence which part must be repeated.
enum class Reach { nothing, simulation, input, method };
Reach reach(const Setting& setting);

/// Returns true if the setting is an input error of a lidar.
bool needs_lidar(const Setting& setting);

/// Throws BadInput in these cases: a key is unknown (suggests the nearest name), is of another sort than the other
/// keys, or does not apply to one of the scenarios; or no situation with seed `seed` can be drawn with one of the
/// values.
void check(const Variation& variation, const DataRoot& data, std::span<const std::string> scenarios,
           std::uint64_t seed);

/// Returns the scenario with the setting's numbers fixed; unchanged if the setting does not affect the simulation.
Scenario with_setting(Scenario scenario, const Setting& setting);

/// Returns the simulated run with the setting's errors applied to its sensor data. Throws BadInput if the sensor is
/// missing, or for a recording, because a recording lacks the situation that determines the error.
SimulatedDraw with_setting(const SimulatedDraw& draw, const Setting& setting);

/// Returns the method with the setting's parameters.
Method with_setting(const Method& method, const Setting& setting);

/// Returns true unless the setting is a parameter of another method.
bool concerns(const Setting& setting, const MethodInfo& method);

}  // namespace tumble::scenarios
