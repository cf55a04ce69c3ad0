// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/sweep/evaluate.hpp"

namespace tumble::scenarios {

/// GivenError is an error of chosen size in the sensor data or calibration that methods receive. The simulated motion
/// and measurements are unchanged, so one simulation serves all sizes of the error. Each error has one line in a table
/// of given_errors.cpp.
struct GivenError {
  sim::Parameter parameter;  ///< size of the error; the default is no error
  bool needs_lidar = false;
  /// Applies the error to the sensor data `sensors`, which belong to `truth` and `situation`. If the error has a random
  /// direction, it depends on the seed of the situation, and not on the size of the error.
  void (*put_in)(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation,
                 double size) = nullptr;
  /// Applies the error to the parameters of a method. The function `tune` is null if the error does not affect
  /// parameters of methods.
  void (*tune)(std::span<const sim::Parameter> known, double size, sim::Values& given) = nullptr;
};

std::span<const GivenError> given_errors();

/// Returns the error called `name`, or null.
const GivenError* find_given_error(const std::string& name);

}  // namespace tumble::scenarios
