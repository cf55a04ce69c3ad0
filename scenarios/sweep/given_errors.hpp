// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <span>
#include <string>

#include "scenarios/sweep/evaluate.hpp"

namespace tumble::scenarios {

/// GivenError is an error of chosen size in the sensor data or the calibration that methods receive. The simulated
/// motion and measurements are unchanged, so one simulation serves all sizes. The table in given_errors.cpp lists the
/// errors.
struct GivenError {
  sim::Parameter parameter;  ///< size of the error; the default means no error
  bool needs_lidar = false;
  /// Applies the error to `sensors`, which belong to `truth` and `situation`. A random direction of the error depends
  /// on the seed of the situation and not on the size.
  void (*put_in)(sim::Sensors& sensors, const sim::Truth& truth, const sim::Situation& situation,
                 double size) = nullptr;
  /// Applies the error to the parameters of a method; null if the error affects no parameter.
  void (*tune)(std::span<const sim::Parameter> known, double size, sim::Values& given) = nullptr;
};

std::span<const GivenError> given_errors();

/// Returns the error called `name`, or null.
const GivenError* find_given_error(const std::string& name);

}  // namespace tumble::scenarios
