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

/// A curve of a suite: one number, or several that move together, set to one value after the other. A key is
///
/// | key | is | for each value |
/// | --- | --- | --- |
/// | `world.rock_count`, `sensors.imu.output_rate_hz` | a number of the scenario (fixed_number.hpp) | simulated anew |
/// | `given.lever_arm_error_m` | an error in what methods are given (given_errors.hpp) | the draw's one simulation |
/// | `rate/saave.jerk_psd_rad2_s5` | a parameter of one method | the same, for that method alone |
struct Variation {
  std::vector<std::string> keys;  ///< all of one sort
  std::vector<double> values;     ///< as written, none twice
  /// As outcomes carry it: the keys joined by "+".
  std::string key() const;
  std::vector<Setting> settings() const;
};

/// Where a setting acts, and so what is done again for it.
enum class Reach { nothing, simulation, input, method };
Reach reach(const Setting& setting);

/// Whether the setting is an error of a lidar in what methods are given.
bool needs_lidar(const Setting& setting);

/// Throws BadInput when a key is unknown (the nearest named), is not of one sort with the others, or does not apply to
/// one of the scenarios, or when no situation with seed `seed` can be drawn with one of the values.
void check(const Variation& variation, const DataRoot& data, std::span<const std::string> scenarios,
           std::uint64_t seed);

/// The scenario with the setting's numbers fixed; as it is when the setting does not reach the simulation.
Scenario with_setting(Scenario scenario, const Setting& setting);

/// The draw with the setting's errors put into its sensors. Throws BadInput when it lacks the sensor
/// or is a recording: the error's direction and the device's own numbers are its situation's.
SimulatedDraw with_setting(const SimulatedDraw& draw, const Setting& setting);

/// The method with what the setting makes of its parameters.
Method with_setting(const Method& method, const Setting& setting);

/// Whether the setting concerns the method: a parameter of another method does not.
bool concerns(const Setting& setting, const MethodInfo& method);

}  // namespace tumble::scenarios
