// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/sweep/evaluate.hpp"

namespace tumble::scenarios {

/// GivenError is an error of chosen size in the sensor data or the calibration that methods receive. A GivenError is
/// added after the simulation, so one simulation serves all sizes of the error.
struct GivenError {
  sim::Parameter parameter;  ///< size; the default means no error
  bool needs_lidar = false;
  /// A random direction of the error depends on the seed of the simulated run and not on the size of the error.
  void (*put_in)(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation,
                 double size) = nullptr;
  void (*tune)(std::span<const sim::Parameter> known, double size, sim::Values& given) = nullptr;
};

std::span<const GivenError> given_errors();

const GivenError* find_given_error(const std::string& name);

}  // namespace tumble::scenarios
