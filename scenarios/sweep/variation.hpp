// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>
#include <vector>

#include "scenarios/draw/scenario.hpp"
#include "scenarios/estimates/method.hpp"
#include "scenarios/sweep/evaluate.hpp"
#include "scenarios/sweep/outcome.hpp"

namespace tumble::scenarios {

/// Variation describes one curve of a suite: the values of one parameter, or of several parameters that change
/// together.
///
/// - A key such as `world.rock_count` names a parameter of the scenario; each value needs a new simulation.
/// - A key such as `given.lever_arm_error_m` names an error in the methods' input; one simulation serves all values.
/// - A key such as `rate/saave.jerk_psd_rad2_s5` names a parameter of one method; only this method is repeated.
struct Variation {
  std::vector<std::string> keys;  ///< all of one sort
  std::vector<double> values;     ///< as written, each once
  std::string key() const;
  std::vector<Setting> settings() const;
};

enum class Reach { nothing, simulation, input, method };
Reach reach(const Setting& setting);

bool needs_lidar(const Setting& setting);

/// Throws BadInput if a key is unknown or does not apply to a scenario, or if the keys of one variation belong to
/// different kinds.
void check(const Variation& variation, const DataRoot& data, std::span<const std::string> scenarios,
           std::uint64_t seed);

Scenario with_setting(Scenario scenario, const Setting& setting);

SimulatedDraw with_setting(const SimulatedDraw& draw, const Setting& setting);

Method with_setting(const Method& method, const Setting& setting);

bool concerns(const Setting& setting, const MethodInfo& method);

/// GivenError is an error of chosen size in the sensor data or the calibration that methods receive.
struct GivenError {
  sim::Parameter parameter;  ///< size; the default means no error
  bool needs_lidar = false;
  /// Adds the error to the sensor data or calibration. If the error has a random direction, the direction depends on
  /// the seed of the simulated run, but not on the size of the error.
  void (*put_in)(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation,
                 double size) = nullptr;
  void (*tune)(std::span<const sim::Parameter> known, double size, sim::Values& given) = nullptr;
};

std::span<const GivenError> given_errors();

const GivenError* find_given_error(const std::string& name);

}  // namespace tumble::scenarios
